# SPDX-License-Identifier: Apache-2.0
"""The orientation of Blender's environment textures and of chromeball's probes, compared by renders
of the same probe through the same glTF camera; see blender_orientation.sh."""
import argparse
import json
import pathlib
import struct

from cycles import run

ROOT = pathlib.Path(__file__).resolve().parents[2]
WORK = ROOT / "build" / "orientation"
CHROMEBALL = ROOT / "build" / "chromeball"
SIZE = "320x240"
# Rotations of the Mapping node, degrees: none, a yaw, and tilted ones.
ROTATIONS = ((0, 0, 0), (0, 0, 50), (25, 0, 0), (0, -35, 0), (20, -40, 130))
AGREES = 1e-3  # relMSE; a picture of another yaw differs by more than 0.1


def write_model(path):
    """A camera that looks along (-1, 0.2, -1), and a triangle behind it: a model is needed."""
    points = struct.pack("<9f", 5, 0, 5, 5.1, 0, 5, 5, 0.1, 5)
    half, tilt = 0.38268343, 0.06975647  # sine of half the yaw of 45 degrees and the pitch of 8
    cos_half, cos_tilt = 0.92387953, 0.99756405
    quaternion = [cos_half * tilt, half * cos_tilt, -half * tilt, cos_half * cos_tilt]
    gltf = {
        "asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0, 1]}],
        "nodes": [{"camera": 0, "rotation": quaternion}, {"mesh": 0}],
        "cameras": [{"type": "perspective",
                     "perspective": {"yfov": 1.2, "aspectRatio": 4 / 3, "znear": 0.1}}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}],
        "accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3",
                       "min": [5, 0, 5], "max": [5.1, 0.1, 5]}],
        "bufferViews": [{"buffer": 0, "byteLength": 36}],
        "buffers": [{"byteLength": 36, "uri": "triangle.bin"}]}
    path.with_name("triangle.bin").write_bytes(points)
    path.write_text(json.dumps(gltf))


def difference(a, b):
    return json.loads(run(CHROMEBALL, "image", "error", a, b, "--json"))["relmse"]


def main():
    parser = argparse.ArgumentParser(prog="blender_orientation.sh")
    parser.add_argument("--probe", type=pathlib.Path, default=ROOT / "probes" / "noon.exr",
                        help="a lat-long map without a symmetry")
    options = parser.parse_args()
    WORK.mkdir(parents=True, exist_ok=True)
    model = WORK / "camera.gltf"
    write_model(model)

    def render(rotation, output):
        run(CHROMEBALL, "render", model, "--probe", options.probe, "--probe-rotation", rotation,
            "--max-depth", 0, "--samples", 16, "--size", SIZE, "--quiet", "-o", output)
        return output

    worst = 0
    print(f"{'Mapping node, degrees':<24} {'--probe-rotation':<46} relMSE")
    for rotation in ROTATIONS:
        name = "_".join(str(angle) for angle in rotation)
        blender, own = WORK / f"blender_{name}.exr", WORK / f"chromeball_{name}.exr"
        log = run("blender", "--background", "--factory-startup", "--python-exit-code", 1,
                  "--python", ROOT / "tools" / "scripts" / "blender_world.py", "--",
                  json.dumps({"model": str(model), "probe": str(options.probe.resolve()),
                              "output": str(blender), "size": SIZE, "rotation": rotation}))
        found = next(line.split()[1] for line in log.splitlines() if line.startswith("rotation "))
        error = difference(render(found, own), blender)
        worst = max(worst, error)
        print(f"{', '.join(str(angle) for angle in rotation):<24} {found:<46} {error:.5f}")
    wrong = WORK / "wrong.exr"
    for yaw in (0, 90, 180):
        error = difference(render(yaw, wrong), WORK / "blender_0_0_0.exr")
        print(f"{'0, 0, 0; a wrong one':<24} {yaw:<46} {error:.5f}")
    raise SystemExit(worst > AGREES)


main()
