# SPDX-License-Identifier: Apache-2.0
"""The two formulas of differential rendering, apart for shadows and for reflections: HDRI 9.7.1."""
import math

from exr import Exr
from gltf import Model
from page import Row, table
from run import NOON, luminance

WIDTH, HEIGHT, SAMPLES = 180, 90, 512
MATTE, GLOSSY = (0.5, 0.5, 0.5), (0.1, 0.1, 0.1)  # of the floor's left and right half
SCENE = """model = "{model}"
[camera]
position = [0, 1.6, 4.2]
look_at = [0, 0.3, 0]
fov = 28
[probe]
file = "{probe}"
scale = {scale}
[render]
size = [{width}, {height}]
samples = {samples}
adaptive = "off"
seed = {seed}
"""
COMPOSITE = """[composite]
plate = "plate.exr"
local_scene = ["matte", "glossy"]
mode = "{mode}"
"""


def write_model(run, name, objects, albedo=1.0):
    """Two halves of a floor, whose colours are those above times `albedo`, and a box on each."""
    model = Model()
    for half, x, color, roughness in (("matte", -3, MATTE, 1), ("glossy", 0, GLOSSY, 0.08)):
        material = model.material([albedo * c for c in color], roughness)
        model.quads(half, material, [((x, 0, 2), (3, 0, 0), (0, 0, -4))])
    if objects:
        for i, x in enumerate((-1.2, 0.9)):
            model.box(f"box{i}", model.material((0.8, 0.8, 0.8)), (x, 0, -0.3), (x + 0.4, 0.6, 0.1), 20)
    model.write(run.scratch / name)
    return name


def render(run, out, model, seed, scale=1.0, mode=""):
    scene = run.scratch / "formulas.toml"
    scene.write_text(SCENE.format(model=model, probe=NOON, scale=scale, width=WIDTH, height=HEIGHT, samples=SAMPLES,
                                  seed=seed) + (COMPOSITE.format(mode=mode) if mode else ""))
    run.render(scene, out, *(["--aov", "alpha"] if mode else []))
    return Exr(run.scratch / out)


def errors(composite, whole, plate):
    """RMS of the relative error in percent: where objects darken the left half, where they brighten the right one."""
    found, alpha = composite.color(), composite.plane("alpha")
    halves = ([], [])
    for y in range(HEIGHT):
        for x in range(WIDTH):
            a, b, before = (luminance(rows[y][x]) for rows in (found, whole, plate))
            right = 2 * x >= WIDTH
            change = b / before - 1
            if alpha[y][x] == 0 and (change > 0.02 if right else change < -0.02):
                halves[right].append((a / b - 1) ** 2)
    return [100 * math.sqrt(sum(squares) / len(squares)) for squares in halves]


def rows(run):
    whole = render(run, "whole.exr", write_model(run, "whole.gltf", True), 1).color()
    plate = render(run, "plate.exr", write_model(run, "empty.gltf", False), 2).color()
    lines = []
    for name, albedo, scale in (("none", 1, 1), ("reflectance 30% too low", 0.7, 1), ("probe 30% too dark", 1, 0.7)):
        model = write_model(run, "model.gltf", True, albedo)
        found = {mode: errors(render(run, "composite.exr", model, 3, scale, mode), whole, plate)
                 for mode in ("difference", "ratio")}
        lines.append([name] + [f"{found[mode][half]:.2g}" for half in (0, 1) for mode in ("difference", "ratio")])
    return [Row(
        "HDRI 9.7.1: the difference for reflections, the ratio for shadows",
        "The difference may serve reflections better, the ratio shadows on matte surfaces.",
        ["chromeball render formulas.toml -o composite.exr"],
        "`[composite] mode = \"difference\"` and `\"ratio\"`. Two boxes on a floor that is matte on one side, dark and glossy on the other. RMS of the relative error in "
        "percent, where the boxes darken the matte side by more than 2%, and where they brighten the glossy one:\n\n"
        + table(["mistake in the local scene", "shadow, difference", "shadow, ratio", "reflection, difference",
                 "reflection, ratio"], lines),
        "The statement holds where the reflectance is wrong: a reflection does not depend on the colour below the "
        "gloss, and a shadow scales with it. Where the probe is too dark all light is, and the ratio is right in "
        "both.")]
