# SPDX-License-Identifier: Apache-2.0
"""Shadows of a point light, of probes and of lights in their place: HDRI's figures 9.1, 9.31 and 9.34."""
import math

from page import Row, table
from pfm import read_pfm
from run import NOON, SCENES, luminance

PILLARS = SCENES / "models" / "pillars.gltf"
STILL_LIFE = SCENES / "models" / "still-life.glb"
COMMON = ["--size", "240x160", "--adaptive", "off"]
POINT_LIGHT = """model = "{model}"
[[light]]
direction = [0.5, 0.7, 0.5]
angle = 0.01
irradiance = 3
"""


def point_light(run):
    scene = run.scratch / "point.toml"
    scene.write_text(POINT_LIGHT.format(model=STILL_LIFE))
    lights = [("point", "A point light", scene, [])]
    probes = {"noon": NOON} | {name.lower(): file for name, file in run.probes(["Lobby", "Kloppenheim"]).items()}
    lights += [(name, f"The probe {name}", STILL_LIFE, ["--probe", file]) for name, file in probes.items()]
    pictures = []
    for name, text, what, options in lights:
        image = run.render(what, "lit.pfm", *COMMON, "--samples", 128, "--denoise", *options)
        pixels = [luminance(pixel) for row in read_pfm(image) for pixel in row]
        exposure = math.log2(0.25 * len(pixels) / sum(pixels)) if options else 0
        pictures.append((run.picture(image, f"lit-{name}.png", "--tonemap", "neutral", "--exposure", f"{exposure:.2f}"),
                         text))
    return [Row(
        "HDRI figure 9.1: a point light, and three probes",
        "The same objects look computed under a point light, and real under captured light.",
        ["chromeball render scenes/models/still-life.glb --probe PROBE"], "Four pictures, each exposed for itself.", "",
        pictures)]


def constellations(run):
    rows, pictures = [], []
    for name in ("St Peter's", "Lobby"):
        if not (file := run.probe(name)):
            continue
        common = [*COMMON, "--guide", "off", "--probe", file]
        reference = run.render(PILLARS, "shadows-ref.exr", *common, "--samples", 512)
        methods = ["cube-grid:10", "lightgen:6", "lightgen:40", "lightgen:100", "median-cut:64"]
        for method in methods:
            image = run.render(PILLARS, "shadows.exr", *common, "--samples", 64, "--strategy", method)
            error = run.error(image, reference, "--flip")
            rows.append([f"{name}, `{method}`", f"{error['flip']:.3f}", f"{error['relmse']:.3g}"])
            if name == "Lobby" and method in ("cube-grid:10", "lightgen:6"):
                pictures.append((run.picture(image, f"shadows-{method.replace(':', '-')}.png"), f"`{method}`"))
        if name == "Lobby":
            pictures.append((run.picture(reference, "shadows-importance.png"), "512 samples of the probe"))
    if not rows:
        return []
    return [Row(
        "HDRI figures 9.31 and 9.34: the shadows of few lights",
        "Lights on a grid, about 600, cast shadows whose steps show; LightGen puts its lights where the light is, "
        "and the shadow of a pillar consists of those of single lights.",
        ["chromeball render scenes/models/pillars.gltf --probe PROBE --strategy METHOD:N"],
        table(["probe and lights", "FLIP", "relMSE"], rows),
        "Each light has a sharp shadow: six of them can be counted, 600 blend. The grid's 600 are about as good as "
        "LightGen's 40 to 100.", pictures)]


def rows(run):
    return point_light(run) + constellations(run)
