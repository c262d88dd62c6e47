# SPDX-License-Identifier: Apache-2.0
"""Runs the program in a scratch folder, and keeps what was run and what it said."""
import json
import pathlib
import shlex
import subprocess

import jpeg
import pixels

ROOT = pathlib.Path(__file__).resolve().parents[3]
CHROMEBALL = ROOT / "build" / "chromeball"
NOON = ROOT / "probes" / "noon.exr"


class Run:
    def __init__(self, scratch, pictures):
        self.scratch, self.pictures = pathlib.Path(scratch), pathlib.Path(pictures)

    def __call__(self, *arguments, fails=False):
        """(What it prints, its warnings and notes) of a command."""
        done = subprocess.run([str(CHROMEBALL), *map(str, arguments)], cwd=self.scratch, text=True,
                              capture_output=True)
        if (done.returncode != 0) != fails:
            raise SystemExit(f"chromeball {shlex.join(map(str, arguments))}: {done.stdout}{done.stderr}")
        return done.stdout, done.stderr.replace(str(self.scratch) + "/", "")

    def json(self, *arguments):
        return json.loads(self(*arguments, "--json")[0])

    def said(self, *arguments, fails=False):
        """All that it says, as the page shows it."""
        out, error = self(*arguments, fails=fails)
        return (error + out).replace(str(ROOT) + "/", "").strip()

    def render(self, scene, out, *options):
        self("render", scene, "-o", out, "--quiet", *options)
        return self.scratch / out

    def picture(self, image, name, *options):
        """An image of the program as a picture of the page, a .jpg; radiance 1 is white."""
        exposure = () if "--exposure" in options else ("--exposure", 0)
        self("image", "view", image, "picture.png", *exposure, *options)
        jpeg.write(self.pictures / name, pixels.read_png(self.scratch / "picture.png"))
        return name
