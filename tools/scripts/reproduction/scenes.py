# SPDX-License-Identifier: Apache-2.0
"""Composites and rooms: HDRI's 9.2.3, figures 9.21 and 9.38."""
import pixels
from exr import Exr
from page import Row, table
from run import NOON, ROOT, SCENES

PILLARS = SCENES / "models" / "pillars.gltf"
STILL_LIFE = SCENES / "models" / "still-life.glb"
TERRACE = SCENES / "terrace.toml"
DUSK = ROOT / "probes" / "dusk.exr"


def few_rays(run):
    rows = []
    for name, probe in {"Grace Cathedral": run.probe("Grace Cathedral"), "dusk, of this project": DUSK}.items():
        if not probe:
            continue
        common = ["--size", "160x107", "--adaptive", "off", "--guide", "off", "--probe", probe]
        reference = run.reference(STILL_LIFE, "ref.exr", *common, "--samples", 2048)
        for strategy, options in [("uniform", ["--mis", "off"]), ("bsdf", []), ("importance", [])]:
            image = run.render(STILL_LIFE, "pot.exr", *common, "--samples", 75, "--strategy", strategy, *options)
            rows.append([f"{name}, `{' '.join([strategy, *options])}`", f"{run.error(image, reference)['relmse']:.3g}"])
    return [Row(
        "HDRI figure 9.21: a glossy pot, 75 rays per pixel",
        "Rays towards random directions waste most of their samples on a glossy surface; those drawn from the BSDF do "
        "not.",
        ["chromeball render scenes/models/still-life.glb --probe PROBE --samples 75 --strategy "
         "STRATEGY [--mis off] --adaptive off --guide off -o OUT.exr"],
        table(["probe and strategy", "relMSE, 75 samples"], rows),
        "The objects here are a mixture of matte, lacquered, glass and metal ones. `uniform` has random directions alone; "
        "with MIS, the default, it takes samples of the BSDF too and has less noise than `bsdf`. `importance` combines samples "
        "of the light with those of the BSDF.")]


def white_scene(run, image):
    """Figure 9.38 (c): what a white local scene would show: its radiance over its reflectance."""
    layers = Exr(image)
    pixels.write_pfm(run.scratch / "white.pfm",
                     [[tuple(a / max(b, 1e-3) for a, b in zip(p, q)) for p, q in zip(*rows)]
                      for rows in zip(layers.color("l_noobj"), layers.color("reflectance"))])
    return run.scratch / "white.pfm"


def composite(run):
    common = ["--samples", 64, "--size", "360x240"]
    image = run.render(TERRACE, "terrace.exr", *common, "--aov", "l_obj,l_noobj,difference,alpha,reflectance",
                       "--denoise")
    panels = [("composite-white.png", "Figure 9.38 (c): the irradiance of the white local scene, as radiance E / pi",
               white_scene(run, image), []),
              ("composite-reflectance.png", "Figure 9.38 (d): its reflectance, from the plate", image,
               ["--layer", "reflectance"]),
              ("composite-noobj.png", "The local scene without the objects", image, ["--layer", "l_noobj"]),
              ("composite-obj.png", "With the objects", image, ["--layer", "l_obj"]),
              ("composite-difference.png", "What the objects change", image, ["--layer", "difference"]),
              ("composite.png", "The composite", image, [])]
    pictures = [(run.picture(file, name, *options), text) for name, text, file, options in panels]
    modes = {}
    for mode in ("difference", "ratio"):
        scene = run.scratch / f"terrace-{mode}.toml"
        text = TERRACE.read_text().replace('reflectance = "plate"', f'reflectance = "plate"\nmode = "{mode}"')
        scene.write_text(text.replace('"models/', f'"{SCENES}/models/').replace('"plates/', f'"{SCENES}/plates/')
                         .replace('"../probes/', f'"{ROOT}/probes/').replace('"../out/', f'"{run.scratch}/'))
        modes[mode] = run.render(scene, f"{mode}.exr", *common)
    disagreement = run.error(modes["ratio"], modes["difference"])
    return [Row(
        "HDRI 9.7, figure 9.38, and 9.7.1: differential rendering",
        "The figure: the plate L, a white local scene without objects (c), which gives the irradiance E, the reflectance "
        "L / E (d), and the composite (e). Section 9.7.1 composites by the local scene with and without the objects, and "
        "their difference; for shadows it prefers the ratio, for reflections the difference.",
        ["chromeball render scenes/terrace.toml --aov l_obj,l_noobj,difference,alpha,reflectance -o out/terrace.exr"],
        "Between the composites of the two formulas, the relMSE is "
        f"{disagreement['relmse']:.2g}. [Measurements](results.md) have the errors of both where probe "
        "or reflectance are wrong, or interreflection is missing.",
        "The ratio does not depend on the exposure of the probe; the difference keeps reflections on dark surfaces.",
        pictures)]


ROOM = """model = "{model}"
[camera]
position = [0, 1.6, 4.5]
look_at = [{x}, 0.9, 0]
fov = 45
[probe]
file = "{probe}"
[surroundings]
shape = "box"
min = [-6, -0.5, -6]
max = [6, 5, 6]
capture = [0, 1.5, 0]
"""


def rooms(run):
    pictures = []
    for name, probe in {"noon": NOON, "dusk": DUSK}.items():
        for place, x in {"left": -1.5, "right": 1.5}.items():
            scene = run.scratch / "room.toml"
            scene.write_text(ROOM.format(model=PILLARS, probe=probe, x=x))
            image = run.render(scene, "room.exr", "--samples", 64, "--size", "240x160", "--denoise")
            pictures.append((run.picture(image, f"room-{name}-{place}.png", "--tonemap", "neutral"),
                             f"{name}, seen towards the {place}"))
    return [Row(
        "HDRI 9.2.3: a probe on the walls of a box",
        "The probe is on the walls of a large box around the pedestal instead of an infinite sphere. In 9.6.1 it is on "
        "a model of the place, so that its light depends on the position.",
        ["chromeball render room.toml -o room.exr"],
        "`[surroundings] shape = \"box\"`. The pillars in a box of 12 x 5.5 x 12 metres, in two lightings, from two directions of view.", "", pictures)]


def rows(run):
    return few_rays(run) + composite(run) + rooms(run)
