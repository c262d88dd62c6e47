# SPDX-License-Identifier: Apache-2.0
"""Runs the program; finds probes; reads what the program writes."""
import csv
import json
import os
import pathlib
import subprocess

ROOT = pathlib.Path(__file__).resolve().parents[3]
CHROMEBALL = ROOT / "build" / "chromeball"
SCENES = ROOT / "scenes"
NOON = ROOT / "probes" / "noon.exr"

PROBES = {
    "Galileo's Tomb": "debevec/galileo_probe.hdr",
    "St Peter's": "debevec/stpeters_cross.hdr",
    "Grace Cathedral": "debevec/grace_probe.hdr",
    "Beach": "debevec/beach_cross.hdr",
    "Uffizi": "probulator/uffizi_latlong_small.hdr",
    "Ennis": "probulator/ennis_latlong_small.hdr",
    "Lobby": "polyhaven/pmndrs_lobby.hdr",
    "Studio": "polyhaven/studio_small_05_1k.hdr",
    "Qwantani": "polyhaven/qwantani_afternoon_puresky_1k.hdr",
    "Kloppenheim": "polyhaven/kloppenheim_05_1k.hdr",
    "Hilly terrain": "polyhaven/hilly_terrain_01_1k.hdr",
}


class Run:
    """The program with a scratch folder and a folder of pictures."""

    def __init__(self, scratch, pictures):
        self.scratch, self.pictures = pathlib.Path(scratch), pathlib.Path(pictures)
        self.missing = set()

    def probe(self, name):
        """The file of a probe; None, and noted, if it is missing."""
        return self.data(f"probes/{PROBES[name]}", name)

    def data(self, path, name):
        """A file or folder of $CHROMEBALL_DATA; None, and noted, if it is missing."""
        file = pathlib.Path(os.environ.get("CHROMEBALL_DATA", "")) / path
        if "CHROMEBALL_DATA" in os.environ and file.exists():
            return file
        self.missing.add(name)
        return None

    def probes(self, names):
        return {name: file for name in names if (file := self.probe(name))}

    def __call__(self, *arguments):
        done = subprocess.run([str(CHROMEBALL), *map(str, arguments)], cwd=self.scratch, text=True,
                              capture_output=True)
        if done.returncode != 0:
            raise SystemExit(f"chromeball {' '.join(map(str, arguments))}: {done.stderr}")
        return done.stdout

    def json(self, *arguments):
        return json.loads(self(*arguments, "--json"))

    def errors(self, probe, methods, counts, *more):
        """(method, count): (mean error, maximum, lights, seconds) of `lights-error`, in percent."""
        file = self.scratch / "errors.csv"
        counts = ["--counts", ",".join(map(str, counts))] if counts else []
        self("lights-error", probe, "--methods", ",".join(methods), *counts, "--csv", file, *more)
        with open(file, newline="") as lines:
            rows = list(csv.reader(lines))
        head = [name.strip().lower() for name in rows[0]]
        column = {key: next(i for i, name in enumerate(head) if name.startswith(key))
                  for key in ("method", "count", "lights", "mean", "max", "seconds")}
        return {(row[column["method"]], int(row[column["count"]])):
                (float(row[column["mean"]]), float(row[column["max"]]),
                 int(row[column["lights"]]), float(row[column["seconds"]])) for row in rows[1:]}

    def render(self, scene, out, *options):
        self("render", scene, "-o", out, "--quiet", *options)
        return self.scratch / out

    def reference(self, scene, out, *options):
        """A render that others are compared with. With their seed it would begin with their samples, and share their noise."""
        return self.render(scene, out, "--seed", 1000, *options)

    def error(self, image, reference, *more):
        return self.json("image", "error", image, reference, *more)

    def picture(self, image, name, *options):
        """An image of the program as a picture of the page; radiance 1 is white."""
        exposure = () if "--exposure" in options else ("--exposure", 0)
        self("image", "view", image, self.pictures / name, *exposure, *options)
        return name


def luminance(color):
    return 0.2126 * color[0] + 0.7152 * color[1] + 0.0722 * color[2]
