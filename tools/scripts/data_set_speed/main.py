# SPDX-License-Identifier: Apache-2.0
"""Processor time per image of a data set, by chromeball, Mitsuba 3 and Cycles; see data_set_speed.sh."""
import argparse
import json
import os
import pathlib
import statistics
import subprocess
import tempfile

ROOT = pathlib.Path(__file__).resolve().parents[3]
HERE = pathlib.Path(__file__).parent
RENDERERS = ("chromeball", "mitsuba", "blender")


def arguments():
    parser = argparse.ArgumentParser(prog="data_set_speed.sh", description=__doc__.split(";")[0])
    parser.add_argument("--model", type=pathlib.Path, default=ROOT / "scenes" / "models" / "still-life.glb")
    parser.add_argument("--probe", type=pathlib.Path, default=ROOT / "probes" / "dusk.exr", help="a lat-long map")
    parser.add_argument("--target", type=float, nargs=3, default=(0, 0.4, 0), help="that cameras look at, metres")
    parser.add_argument("--distance", type=float, default=4, help="of cameras from it, metres")
    parser.add_argument("--fov", type=float, default=40, help="degrees")
    parser.add_argument("--views", type=int, default=20)
    parser.add_argument("--size", type=int, default=128)
    parser.add_argument("--samples", type=int, default=16)
    parser.add_argument("--depth", type=int, default=5, help="scattering events")
    parser.add_argument("--threads", type=int, default=0, help="0: all")
    parser.add_argument("--rounds", type=int, default=3, help="of all programs in turn; medians are shown")
    parser.add_argument("--renderers", nargs="+", choices=RENDERERS, default=RENDERERS)
    parser.add_argument("--options", type=json.loads, default={}, help='of chromeball.render(), as \'{"adaptive": "off"}\'')
    parser.add_argument("--pictures", type=pathlib.Path, default=ROOT / "build" / "data-set-speed")
    parser.add_argument("--python", type=pathlib.Path, required=True, help="the interpreter of the other programs")
    return parser.parse_args()


def run(renderer, settings, options):
    environment = dict(os.environ)
    python = options.python
    if renderer == "chromeball":
        python = ROOT / "build" / "venv" / "bin" / "python"
        environment["PYTHONPATH"] = str(ROOT / "build" / "python")
    done = subprocess.run([python, HERE / f"of_{renderer}.py", json.dumps(settings)], env=environment,
                          capture_output=True, text=True)
    if done.returncode != 0:
        raise SystemExit(f"{renderer} failed:\n{done.stdout[-2000:]}{done.stderr[-2000:]}")
    return json.loads(done.stdout.splitlines()[-1])


def main():
    options = arguments()
    options.pictures.mkdir(parents=True, exist_ok=True)
    memory = pathlib.Path("/dev/shm")
    found = {renderer: [] for renderer in options.renderers}
    with tempfile.TemporaryDirectory(dir=memory if memory.is_dir() else None) as scratch:
        for _ in range(options.rounds):
            for renderer in options.renderers:
                settings = {name: getattr(options, name) for name in
                            ("target", "distance", "fov", "views", "size", "samples", "depth", "threads", "options")}
                settings |= {"model": str(options.model.resolve()), "probe": str(options.probe.resolve()),
                             "scratch": scratch, "picture": str(options.pictures / f"{renderer}.png")}
                found[renderer].append(run(renderer, settings, options))
    print(f"{options.model.name}, {options.probe.name}, {options.size}x{options.size}, {options.samples} samples, "
          f"{options.views} views, medians of {options.rounds} rounds:\n")
    print("| program | processor, s an image | until the first image, s | clock, s an image | until the first, s |")
    print("| --- | ---: | ---: | ---: | ---: |")
    for renderer, runs in found.items():
        middle = {key: statistics.median(one[key] for one in runs) for key in runs[0]}
        print(f"| {renderer} | {middle['other']:.3f} | {middle['first']:.2f} | {middle['clock_other']:.3f} | "
              f"{middle['clock_first']:.2f} |")


main()
