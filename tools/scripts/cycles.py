# SPDX-License-Identifier: Apache-2.0
"""Runs Cycles (Blender 3.4) on a glTF model and a probe."""
import dataclasses
import json
import pathlib
import re
import subprocess

SCRIPT = pathlib.Path(__file__).with_name("cycles_render.py")


@dataclasses.dataclass
class Settings:
    model: str
    probe: str  # a lat-long map
    output: str  # .exr
    size: tuple  # width, height
    samples: int
    seed: int
    threads: int
    depth: int  # scattering events: 1 for direct light
    seconds: float = 0  # of rendering; 0: no limit
    defaults: bool = False  # clamp indirect light to 10, Filter Glossy 1; else unbiased
    plain_materials: bool = True  # of make_demo's models
    scale: float = 1  # of the probe
    camera: dict = None  # position, look_at (glTF's axes), fov (degrees, vertical); or the model's


def run(*command):
    done = subprocess.run([str(word) for word in command], capture_output=True, text=True)
    if done.returncode != 0:
        raise SystemExit(f"{command[0]} failed:\n{done.stdout}{done.stderr}")
    return done.stdout


def render(settings):
    """Returns the seconds of rendering, and the samples, from Cycles' own progress lines."""
    log = run("blender", "--background", "--factory-startup", "--python-exit-code", 1, "--python",
              SCRIPT, "--", json.dumps(dataclasses.asdict(settings)))
    clock = re.compile(r"Time:(?:(\d+):)?(\d+):([\d.]+) .*\| (Sample 0/|Finished)")
    times = {}
    for hours, minutes, seconds, event in clock.findall(log):
        if event != "Sample 0/" or event not in times:  # a time limit prints it again at the end
            times[event] = 3600 * int(hours or 0) + 60 * int(minutes) + float(seconds)
    samples = max(int(count) for count in re.findall(r"\| Sample (\d+)/", log))
    return times["Finished"] - times["Sample 0/"], samples
