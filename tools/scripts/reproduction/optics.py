# SPDX-License-Identifier: Apache-2.0
"""The optics of a camera on images of high dynamic range: HDRI's 9.2.5 and figures 9.5 to 9.8."""
import base64
import json
import math
import struct

from page import Row, table
from run import ROOT, SCENES

STILL_LIFE = SCENES / "models" / "still-life.glb"
DUSK = ROOT / "probes" / "dusk.exr"
TURN = 12  # degrees, of figure 9.6's camera on its tripod
SIZE = (360, 240)


def write_pfm(path, rows):
    """Grey rows, from the top."""
    height, width = len(rows), len(rows[0])
    texels = [value for row in reversed(rows) for value in row]
    path.write_bytes(f"Pf\n{width} {height}\n-1.0\n".encode() + struct.pack(f"<{len(texels)}f", *texels))


def read_pfm(path):
    kind, size, _, data = path.read_bytes().split(b"\n", 3)
    channels = 3 if kind == b"PF" else 1
    width, height = map(int, size.split())
    texels = struct.unpack(f"<{channels * width * height}f", data)
    rows = [texels[y * width * channels:(y + 1) * width * channels:channels] for y in range(height)]
    return rows[::-1]


def squares(run):
    side, sigma, values = 40, 20, (1.5, 6)
    image = [[0.05] * 240 for _ in range(120)]
    for value, left in zip(values, (40, 160)):
        for y in range(40, 40 + side):
            image[y][left:left + side] = [value] * side
    write_pfm(run.scratch / "squares.pfm", image)
    rows, pictures = [], [(run.picture("squares.pfm", "squares.png"), "Values of 1.5 and 6, white is 1")]
    for name, options in [("HDR, blurred", []), ("clipped at white, then blurred", ["--clip", 1])]:
        run("image", "develop", "squares.pfm", "blurred.pfm", "--bloom", f"1:{sigma}", "--exact", *options)
        blurred = read_pfm(run.scratch / "blurred.pfm")
        rows.append([name, *(f"{blurred[60][left + side // 2]:.3f}" for left in (40, 160))])
        file = f"squares-{'clipped' if options else 'blurred'}.png"
        pictures.append((run.picture("blurred.pfm", file), name[0].upper() + name[1:]))
    share = math.erf(side / (2 * math.sqrt(2) * sigma)) ** 2
    return Row(
        "HDRI figure 9.5: two squares brighter than white",
        "Squares of 1.5 and 6 look alike on a display whose white is 1. Blurred by a Gaussian, the dim one falls below "
        "white, the bright one does not.",
        ["chromeball image develop squares.exr squares.png --bloom 1:20"],
        "The centres of squares of side 2 sigma:\n\n" + table(["image", "1.5", "6"], rows),
        f"In closed form a centre is V erf(1 / sqrt2)^2 = {share:.4f} V, {1.5 * share:.3f} and {6 * share:.2f} over "
        "black; the ground here is 0.05. Clipped first, both squares are the same grey.", pictures)


def turning_camera(run, seconds):
    """A model that is a camera on a tripod, which pans by TURN degrees within `seconds`."""
    def quaternion(degrees):
        return [0, math.sin(math.radians(degrees) / 2), 0, math.cos(math.radians(degrees) / 2)]

    data = struct.pack("<2f", 0, seconds) + struct.pack("<8f", *quaternion(-TURN / 2), *quaternion(TURN / 2))
    views = [{"buffer": 0, "byteOffset": 0, "byteLength": 8}, {"buffer": 0, "byteOffset": 8, "byteLength": 32}]
    model = {
        "asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}],
        "nodes": [{"translation": [0, 1.3, 5], "children": [1]}, {"camera": 0, "rotation": quaternion(-TURN / 2)}],
        "cameras": [{"name": "Tripod", "type": "perspective", "perspective": {"yfov": 0.7, "znear": 0.1}}],
        "buffers": [{"byteLength": 40, "uri": "data:application/octet-stream;base64,"
                     + base64.b64encode(data).decode()}],
        "bufferViews": views,
        "accessors": [{"bufferView": 0, "componentType": 5126, "count": 2, "type": "SCALAR", "min": [0],
                       "max": [seconds]},
                      {"bufferView": 1, "componentType": 5126, "count": 2, "type": "VEC4"}],
        "animations": [{"samplers": [{"input": 0, "output": 1}],
                        "channels": [{"sampler": 0, "target": {"node": 1, "path": "rotation"}}]}]}
    (run.scratch / "tripod.gltf").write_text(json.dumps(model))


def scene_at(run, time):
    """The still life, seen by the camera at a time."""
    scene = run.scratch / f"tripod-{time}.toml"
    scene.write_text(f'[[model]]\nfile = "{STILL_LIFE}"\n[[model]]\nfile = "tripod.gltf"\ntime = {time}\n'
                     f'[camera]\nname = "Tripod"\n[probe]\nfile = "{DUSK}"\n')
    return scene


def streaks(run):
    turning_camera(run, 1)
    common = ["--size", f"{SIZE[0]}x{SIZE[1]}", "--samples", 256, "--denoise"]
    # The still is of the middle of the pan; the middle of the image moves by f times the angle.
    still = run.render(scene_at(run, 0.5), "still.exr", *common)
    moved = run.render(scene_at(run, 0), "moved.exr", *common, "--fps", 1, "--shutter", 1)
    focal = 0.5 * SIZE[1] / math.tan(0.35)
    length = round(2 * focal * math.tan(math.radians(TURN / 2)))
    rows = []
    images = {"high dynamic range, blurred": [], "clipped, then blurred": ["--clip", 1]}
    pictures = [(run.picture(still, "streaks-still.png"), "The still")]
    for name, options in images.items():
        run("image", "develop", still, "blurred.exr", "--motion", f"{length}@0", *options)
        error = run.error(run.scratch / "blurred.exr", moved, "--flip")
        rows.append([name, f"{100 * error['bias']:+.1f}%", f"{error['relmse']:.3g}", f"{error['flip']:.3f}"])
        file = f"streaks-{'clipped' if options else 'blurred'}.png"
        pictures.append((run.picture("blurred.exr", file), name[0].upper() + name[1:]))
    pictures.append((run.picture(moved, "streaks-moved.png"), f"A camera that pans by {TURN} degrees"))
    return Row(
        "HDRI figure 9.6: streaks of bright windows",
        "Blurring a clipped image darkens its bright windows; blurring the image of high dynamic range gives bright "
        "streaks, like those of a photograph for which the camera was rotated.",
        ["chromeball render tripod.toml --fps 1 --shutter 1 -o moved.exr",
         f"chromeball image develop still.exr blurred.exr --motion {length}@0"],
        "Against the render with an open shutter:\n\n" + table(["image", "bias", "relMSE", "FLIP"], rows),
        "The camera that turns sees what is left and right of the still, and parts near the border move further than "
        "those in the middle: a blur of the image knows neither.", pictures)


def bloom(run):
    image = run.render(STILL_LIFE, "bloom.exr", "--probe", DUSK, "--size", f"{SIZE[0]}x{SIZE[1]}", "--samples", 256,
                       "--denoise")
    mix = ".75:0.5,.15:4,.07:16,.03:64"
    vignette = "0.8"
    pictures = [(run.picture(image, "bloom-none.png"), "As rendered")]
    for file, text, options in [
            ("bloom-hdr.png", "Bloom", ["--bloom", mix]),
            ("bloom-ldr.png", "Bloom of the clipped image", ["--bloom", mix, "--clip", 1]),
            ("bloom-vignette.png", "Bloom and vignette", ["--bloom", mix, "--vignette", vignette])]:
        run("image", "develop", image, run.pictures / file, *options)
        pictures.append((file, text))
    return Row(
        "HDRI figures 9.7 and 9.8: a mix of blurs, and vignetting",
        "The frames of the film are a weighted sum of Gaussian blurs, 75% of it nearly sharp, darkened towards the "
        "corners, before tone mapping.",
        [f"chromeball image develop IN.exr OUT.png --bloom {mix} --vignette {vignette}"],
        "The mix below: the sharp part has the text's 75%.",
        "The weights and widths of the other parts are in a figure that is not in the text; those here are chosen. The "
        "sum of the image is kept to 1e-5, the fast kernels are within 1e-4 of the exact ones' peak (tests).", pictures)


def rows(run):
    return [squares(run), streaks(run), bloom(run)]
