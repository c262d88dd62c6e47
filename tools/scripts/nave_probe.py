#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Captures the probe of scenes/fiat-lux.toml: six views from the middle of the empty nave, stitched.

Writes out/nave-room.glb, nave-things.glb, nave-probe.exr, and the sources nave-windows.json."""
import argparse
import pathlib
import subprocess
import tempfile

ROOT = pathlib.Path(__file__).resolve().parents[2]
CAPTURE = (0, 1.6, 2)  # [surroundings] capture of the scene
SCALE = [26, 24, 21]  # [probe] scale of scenes/nave.toml
# Yaw and pitch of a tile; the direction of the view and what is up in it.
VIEWS = {"front": (0, 0, (0, 0, -1), (0, 1, 0)), "left": (90, 0, (-1, 0, 0), (0, 1, 0)),
         "back": (180, 0, (0, 0, 1), (0, 1, 0)), "right": (270, 0, (1, 0, 0), (0, 1, 0)),
         "up": (0, 90, (0, 1, 0), (0, 0, 1)), "down": (0, -90, (0, -1, 0), (0, 0, -1))}
SCENE = """model = "{model}"
[camera]
position = {position}
look_at = {target}
up = {up}
fov = 94
[probe]
file = "{probe}"
rotation = 8
scale = {scale}
[render]
max_depth = 10
"""


def run(*command):
    subprocess.run([str(ROOT / "build" / command[0]), *map(str, command[1:])], check=True)


def main():
    options = argparse.ArgumentParser(description=__doc__)
    options.add_argument("--width", type=int, default=1536, help="of the probe")
    options.add_argument("--samples", type=int, default=64)
    options = options.parse_args()
    out = ROOT / "out"
    out.mkdir(exist_ok=True)
    for what in ("nave-room", "nave-things"):
        run("make_demo", what, out / f"{what}.glb")
    tiles = ["fov = 94"]
    with tempfile.TemporaryDirectory() as folder:
        folder = pathlib.Path(folder)
        for name, (yaw, pitch, direction, up) in VIEWS.items():
            target = [p + d for p, d in zip(CAPTURE, direction)]
            scene = folder / f"{name}.toml"
            scene.write_text(SCENE.format(model=out / "nave-room.glb", position=list(CAPTURE), target=target,
                                          up=list(up), probe=ROOT / "probes" / "noon.exr", scale=SCALE))
            side = options.width // 4 + 16
            run("chromeball", "render", scene, "--size", f"{side}x{side}", "--samples", options.samples,
                "--denoise", "--quiet", "-o", folder / f"{name}.exr")
            tiles.append(f'[[tile]]\nfile = "{name}.exr"\nyaw = {yaw}\npitch = {pitch}')
        (folder / "tiles.toml").write_text("\n".join(tiles) + "\n")
        run("chromeball", "probe", "stitch", folder / "tiles.toml", "--same-exposure",
            "--size", f"{options.width}x{options.width // 2}", "-o", out / "nave-probe.exr")
    run("chromeball", "lights", out / "nave-probe.exr", "--suggest", 24, "-o", out / "nave-windows.json")


if __name__ == "__main__":
    main()
