# SPDX-License-Identifier: Apache-2.0
"""The scenes of the gallery as in HDRI's figures 9.1, 9.22 to 9.28 and 9.29."""
import subprocess

from page import Row, table
from run import NOON, ROOT, SCENES

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
    common = ["--samples", 64, "--size", "240x150"]
    pictures = []

    def show(name, text, *options, change=lambda text: text):
        image = run.render(scene_of(run, "five-shapes", change), f"five-{name}.exr", *common, *options)
        pictures.append((run.picture(image, f"five-{name}.png", "--tonemap", "neutral"), text))

    show("point", "A point light", "--probe-scale", 0, change=lambda text: text + POINT)
    show("dusk", "The probe dusk")
    show("noon", "The probe noon", "--probe", NOON, "--probe-scale", 0.8)
    overcast = run.scratch / "overcast.exr"
    run("probe", "synth", "overcast", overcast)
    show("overcast", "An overcast sky", "--probe", overcast)
    return [Row(
        "HDRI figure 9.1, with five shapes: a point light, and three probes",
        "The same objects look computed under a point light, and real under captured light.",
        ["chromeball render scenes/five-shapes.toml --probe PROBE"],
        "A point light, and three probes that this project makes.", "", pictures)]


def temple(run):
    scene = scene_of(run, "temple", lambda text: text.replace("denoise = true\n", ""))
    common = ["--samples", 81, "--size", "240x150", "--adaptive", "off", "--guide", "off"]
    reference = run.render(scene, "temple-ref.exr", "--samples", 512, *common[2:])
    white = run.scratch / "white.exr"
    run("probe", "synth", "constant", white)
    rows, pictures = [], []

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
        rows.append([name, f"{run.error(show(name, text, *options), reference)['relmse']:.3g}"])
    show("only-suns", "The sun alone (9.26)", "--light-from", "suns")
    show("only-rest", "The sky alone (9.27)", "--light-from", "rest")
    return [Row(
        "HDRI figures 9.22 and 9.24 to 9.28, with a temple",
        "The Parthenon under a white sky, under a sunny one with 81 rays, and by sun and sky apart.",
        ["chromeball render scenes/temple.toml --samples 81 --strategy STRATEGY"],
        table(["81 samples", "relMSE"], rows),
        "The temple is a model of its own, not the scanned Parthenon; its probe is `probes/noon.exr`.", pictures)]


def nave(run):
    pictures = []
    for name, text, rotation in [("morning", "Sun from the left", 8), ("evening", "Sun high behind the apse", 250)]:
        scene = scene_of(run, "nave", lambda text, r=rotation: text.replace("rotation = 8", f"rotation = {r}"))
        image = run.render(scene, f"nave-{name}.exr", "--samples", 64, "--size", "160x200")
        pictures.append((run.picture(image, f"nave-{name}.png", "--tonemap", "filmic"), text))
    return [Row(
        "HDRI figures 9.29 and 9.30, with a basilica of our own: light that comes through windows",
        "Objects in St Peter's, lit by its windows at their places.",
        ["chromeball render scenes/nave.toml --tonemap filmic"],
        "Monoliths and spheres in a modelled nave, in two lightings. `scenes/fiat-lux.toml` shows them in a probe that "
        "`tools/scripts/nave_probe.py` captures in the empty nave.", "", pictures)]


def rows(run):
    return five_shapes(run) + temple(run) + nave(run)
