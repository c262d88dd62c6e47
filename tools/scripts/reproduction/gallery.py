# SPDX-License-Identifier: Apache-2.0
"""The scenes of the gallery as in HDRI's figures 9.1, 9.22 to 9.28 and 9.29."""
import math
import subprocess

from page import Row, table
from pfm import read_pfm
from run import NOON, ROOT, SCENES, luminance

DUSK = ROOT / "probes" / "dusk.exr"
POINT = '[[light]]\ntype = "point"\nposition = [-2.5, 4, 3]\npower = 900\n'


def scene_of(run, name, change=lambda text: text):
    """A scene of the gallery in the scratch folder, with its model made there."""
    model = run.scratch / f"{name}.glb"
    if not model.exists():
        subprocess.run([ROOT / "build" / "make_demo", name, model], check=True)
    text = (SCENES / f"{name}.toml").read_text().replace(f"../out/{name}.glb", str(model))
    file = run.scratch / f"{name}.toml"
    file.write_text(change(text.replace("../probes/", f"{ROOT}/probes/").replace("../out/", f"{run.scratch}/")))
    return file


def five_shapes(run):
    pictures = []

    def show(name, text, *options, change=lambda text: text):
        image = run.render(scene_of(run, "five-shapes", change), f"five-{name}.pfm", "--samples", 64, "--size",
                           "240x150", *options)
        pixels = [luminance(pixel) for row in read_pfm(image) for pixel in row]
        exposure = math.log2(0.3 * len(pixels) / sum(pixels))
        pictures.append((run.picture(image, f"five-{name}.png", "--tonemap", "neutral", "--exposure",
                                     f"{exposure:.2f}"), text))

    show("point", "A point light", "--probe-scale", 0, change=lambda text: text + POINT)
    show("dusk", "The probe dusk", "--probe", DUSK)
    show("noon", "The probe noon", "--probe", NOON)
    if lobby := run.probe("Lobby"):
        show("lobby", "The probe lobby of Poly Haven", "--probe", lobby)
    return [Row(
        "HDRI figure 9.1: a point light, and three probes",
        "The same objects look computed under a point light, and real under captured light.",
        ["chromeball render scenes/five-shapes.toml --probe PROBE"],
        "Four pictures, each exposed for itself.", "", pictures)]


def temple(run):
    scene = scene_of(run, "temple", lambda text: text.replace("denoise = true\n", ""))
    common = ["--samples", 81, "--size", "240x150", "--adaptive", "off", "--guide", "off"]
    reference = run.reference(scene, "temple-ref.exr", "--samples", 2048, *common[2:])
    white = run.scratch / "white.exr"
    run("probe", "synth", "constant", white)
    errors, pictures = {}, []

    def show(name, text, *options):
        image = run.render(scene, f"temple-{name}.exr", *common, *options)
        pictures.append((run.picture(image, f"temple-{name}.png", "--tonemap", "neutral"), text))
        return image

    show("white", "A white environment (9.22)", "--probe", white, "--probe-scale", 0.8, "--strategy", "uniform",
         "--mis", "off")
    for name, text, options in [
            ("uniform", "81 uniform samples, without MIS (9.24)", ["--strategy", "uniform", "--mis", "off"]),
            ("importance", "81 samples by importance", ["--strategy", "importance"]),
            ("suns", "Sky and sun, each sampled apart (9.28)", ["--strategy", "suns"])]:
        errors[name] = run.error(show(name, text, *options), reference)["relmse"]
    run("image", "develop", "temple-uniform.exr", run.pictures / "temple-blurred.png", "--bloom", "1:6", "--tonemap",
        "neutral")
    pictures.insert(2, ("temple-blurred.png", "The same, blurred: the mean is right (9.25)"))
    bsdf = run.render(scene, "temple-bsdf.exr", *common, "--strategy", "bsdf")
    errors["bsdf"] = run.error(bsdf, reference)["relmse"]
    names = {"uniform": "uniform, without MIS", "bsdf": "BSDF alone", "importance": "importance", "suns": "suns"}
    show("only-suns", "The sun alone (9.26)", "--light-from", "suns")
    show("only-rest", "The sky alone (9.27)", "--light-from", "rest")
    hit = 1 - math.cos(math.radians(0.5323 / 2))  # of a hemisphere
    miss = (1 - hit) ** 81
    return [Row(
        "HDRI figures 9.22 and 9.24 to 9.28: the sampling problem",
        "The Parthenon under a white sky, and under a sunny one: 81 random rays mostly miss the sun, and the image is "
        "speckled. Sun and sky are sampled apart and added.",
        ["chromeball render scenes/temple.toml --samples 81 --strategy STRATEGY --adaptive off "
         "--guide off -o OUT.exr"],
        f"A pixel misses a sun of 0.5323 degrees with all 81 rays with probability {miss:.5f}; those that hit it are "
        f"{1 / (1 - miss):,.0f} times too bright.\n\n"
        + table(["81 samples", "relMSE", "uniform / this"],
                [[text, f"{errors[name]:.3g}", f"{errors['uniform'] / errors[name]:,.0f}"]
                 for name, text in names.items()]),
        "The temple is a model of its own, not the scanned Parthenon; its probe is `probes/noon.exr`. "
        "The scene's `denoise` is taken out first, and the rows without MIS add `--mis off`.", pictures)]


def nave(run):
    pictures = []
    for name, text, rotation in [("morning", "Sun from the left", 8), ("evening", "Sun from the right", 190)]:
        scene = scene_of(run, "nave", lambda text, r=rotation: text.replace("rotation = 8", f"rotation = {r}"))
        image = run.render(scene, f"nave-{name}.exr", "--samples", 64, "--size", "160x200")
        pictures.append((run.picture(image, f"nave-{name}.png", "--tonemap", "filmic"), text))
    return [Row(
        "HDRI figure 9.29: light that comes through windows",
        "Light sources of St Peter's identified in the probe, and objects (9.30) lit by its windows "
        "at their places.",
        ["chromeball render scenes/nave.toml --tonemap filmic"],
        "Monoliths and spheres in a modelled nave, in two lightings. `scenes/fiat-lux.toml` shows them in a probe that "
        "`tools/scripts/nave_probe.py` captures in the empty nave.", "", pictures)]


def rows(run):
    return five_shapes(run) + nave(run)
