# SPDX-License-Identifier: Apache-2.0
"""Photographs of mirror balls: HDRI's figures 9.2, 9.9 and 9.10."""
import math

from gltf import Model
from lat_long import irradiance, irradiance_error
from page import Row, table
from pfm import read_pfm

CHROME = (0.632, 0.647, 0.653)
SIZE, DISTANCE = 400, 32
SCENE = """model = "ball.gltf"
[camera]
position = [{x}, 0, {z}]
look_at = [0, 0, 0]
fov = {fov}
[probe]
file = "{probe}"
"""


def photograph(run, name, probe, azimuth):
    fov = 2 * math.degrees(math.atan(1.05 / math.sqrt(DISTANCE ** 2 - 1)))
    turn = math.radians(azimuth)
    scene = run.scratch / "photograph.toml"
    scene.write_text(SCENE.format(x=DISTANCE * math.sin(turn), z=DISTANCE * math.cos(turn), fov=fov, probe=probe))
    run.render(scene, name, "--size", f"{SIZE}x{SIZE}", "--samples", 64, "--adaptive", "off")


def closed_loop(run):
    probe = run.probe("Galileo's Tomb")
    if not probe:
        return []
    model = Model()
    model.sphere("ball", model.material(CHROME, 0, 1), (0, 0, 0), 1)
    model.write(run.scratch / "ball.gltf")
    for name, azimuth in (("a.exr", 0), ("b.exr", 90)):
        photograph(run, name, probe, azimuth)
    truth = irradiance(run, probe, "truth.pfm")
    circle = f"{SIZE / 2:g},{SIZE / 2:g},{SIZE / 2 / 1.05:.3f}"
    common = ["--distance", DISTANCE, "--schlick", "--reflectivity", ",".join(map(str, CHROME)), "-o", "made.exr"]
    rows = []
    for text, files, more in [("one", ["a.exr"], ["--circle", circle]),
                              ("two, 90 degrees apart", ["a.exr", "b.exr"],
                               ["--azimuth", "0,90", "--circle", f"{circle};{circle}"])]:
        run("probe", "assemble", *files, *more, *common)
        mean, largest = irradiance_error(irradiance(run, "made.exr", "made.pfm"), truth)
        rows.append([text, f"{mean:.2f}", f"{largest:.1f}"])
    run("probe", "synth", "constant", "white.exr")
    photograph(run, "white-ball.exr", "white.exr", 0)
    middle = f"{SIZE // 2 - 10},{SIZE // 2 - 10},20,20"
    measured = run.json("probe", "reflectivity", "white-ball.exr", "--direct", "2,2,10,10", "--reflected", middle)
    found = ", ".join(f"{value:.3f}" for value in measured["reflectivity"])
    return [Row(
        "HDRI figures 9.2, 9.9 and 9.10: a probe from photographs of a mirror ball",
        "Two photographs of a ball, 90 degrees apart, show all directions well except straight down, "
        "and remove the camera's reflection. The ball's reflectivity is that of a surface in the "
        "ball and beside it.",
        ["chromeball probe reflectivity white-ball.exr --direct 2,2,10,10 --reflected 190,190,20,20",
         "chromeball probe assemble a.exr b.exr --azimuth 0,90 --circle 'X,Y,R;X,Y,R' --distance 32 \\",
         "  --schlick --reflectivity .632,.647,.653 -o made.exr"],
        "Photographs of a chrome ball in Galileo's Tomb, rendered; the irradiance of the probe made from them, with the "
        "true circle, distance, reflectivity and Fresnel formula given:\n\n"
        + table(["photographs", "mean error, %", "largest, %"], rows)
        + f"\n\nThe reflectivity of the ball in a white room is measured as {found}; it is {CHROME[0]}, {CHROME[1]}, "
        f"{CHROME[2]}.",
        "[From camera to probe](../capture.md) has the whole way, from bracketed photographs through response, "
        "reflectivity and sun to the composite, with the error of each step.")]


def real_ball(run):
    folder = run.data("reference/differential_rendering/bbold72_cs445_samples", "the photographed ball of a course")
    if not folder:
        return []
    run("probe", "convert", folder / "equirectangular.hdr", "theirs.pfm", "--from", "lat-long", "--to", "lat-long")
    theirs = read_pfm(run.scratch / "theirs.pfm")
    size = f"{len(theirs[0])}x{len(theirs)}"
    run("probe", "assemble", folder / "calib_hdr.hdr", "-o", "ours.pfm", "--circle", "190.5,190.5,190.5", "--size", size)
    flipped = deviation(read_pfm(run.scratch / "ours.pfm"), theirs)
    run("probe", "convert", folder / "calib_hdr.hdr", "ours.pfm", "--from", "mirror-ball", "--to", "lat-long", "--size",
        size, "--probe-rotation", 180)
    unflipped = deviation(read_pfm(run.scratch / "ours.pfm"), theirs)
    return [Row(
        "HDRI 9.4.1: a photograph of a ball is mirrored",
        "The formulas of the ideal mirror ball, and a photograph of a ball, have left and right exchanged.",
        ["chromeball probe assemble ball.hdr --circle 190.5,190.5,190.5 -o ours.exr"],
        f"The photograph of a student's course work against the map that its author made of it: {flipped:.1f}% RMS; "
        f"read as an ideal mirror ball, without the flip, {unflipped:.0f}%.",
        "The rest is interpolation, and the rim, where the author's map reads pixels beside the ball.")]


def deviation(ours, theirs):
    """RMS in percent of the mean; theirs has its front in the middle, where ours has its back."""
    width = len(theirs[0])
    squares = total = 0
    for a, b in zip(ours, theirs):
        for x, pixel in enumerate(b):
            squares += sum((p - q) ** 2 for p, q in zip(a[(x + width // 2) % width], pixel))
            total += sum(pixel)
    count = 3 * width * len(theirs)
    return 100 * math.sqrt(squares / count) / (total / count)


def rows(run):
    return closed_loop(run) + real_ball(run)
