# SPDX-License-Identifier: Apache-2.0
"""A scene as a light stage shows it: HDRI's 9.9 and figures 9.43 to 9.45."""
import re

from page import Row, table
from run import NOON, ROOT, SCENES

SUBJECT = SCENES / "models" / "still-life.glb"
DUSK = ROOT / "probes" / "dusk.exr"
SIZE, COLUMNS, ROWS = "240x160", 32, 16
SHOWN = [(6, 4), (12, 6), (18, 5), (24, 7)]  # column and row of a few elements
EXPOSURE = 6  # stops: an element alone is dim


def make_stage(run):
    """The file of the stage; made once."""
    file = run.scratch / "stage.exr"
    if not file.exists():
        run("basis", SUBJECT, "--directions", f"lat-long:{COLUMNS}x{ROWS}", "--size", SIZE, "--samples", 1024,
            "--transparent", "--quiet", "-o", file)
    return file


def relit(run, probe, out, *options):
    """What `relight` prints."""
    return run("relight", make_stage(run), "--probe", probe, "-o", out, *options)


def sums(run):
    stage = make_stage(run)
    pictures = []
    for column, row in SHOWN:
        element = row * COLUMNS + column
        pictures.append((run.picture(stage, f"stage-{element}.png", "--layer", f"element.{element:04}", "--exposure",
                                     EXPOSURE), f"Element {element}: light from column {column} of row {row}"))
    rows = []
    probes = {"dusk": DUSK, "noon": NOON, **run.probes(["Grace Cathedral", "Uffizi", "St Peter's"])}
    for name, probe in probes.items():
        relit(run, probe, "sum.exr")
        render = run.reference(SUBJECT, "direct.pfm", "--probe", probe, "--size", SIZE, "--samples", 512, "--transparent")
        error = run.error(run.scratch / "sum.exr", render, "--flip")
        rows.append([name, f"{error['relmse']:.3g}", f"{100 * error['bias']:+.1f}%", f"{error['flip']:.3f}"])
        if name in ("dusk", "noon"):
            pictures += [(run.picture("sum.exr", f"stage-{name}.png", "--tonemap", "neutral"), f"The sum under {name}"),
                         (run.picture(render, f"stage-{name}-render.png", "--tonemap", "neutral"),
                          f"{name.capitalize()}, rendered")]
    return Row(
        "HDRI figures 9.43 and 9.44: a light stage, and its sum under probes",
        "Pictures of a face under light from each direction, each times the colour of a probe from there, add up to the "
        "face under the probe: Grace Cathedral, a grove, Uffizi, St Peter's.",
        [f"chromeball basis scenes/models/still-life.glb --directions lat-long:{COLUMNS}x{ROWS} --transparent -o stage.exr",
         "chromeball relight stage.exr --probe PROBE -o OUT.exr"],
        f"{COLUMNS * ROWS} elements from one pass; the sum against a render under the probe, both without background:\n\n"
        + table(["probe", "relMSE", "bias", "FLIP"], rows),
        "The subject is a still life instead of a face. The mirror ball shows the cells of the lat-long map, and small "
        "suns are spread over a whole cell: most of the difference ([light stage](../light-stage.md) has it by "
        "number of directions). On diffuse subjects it is a few percent.", pictures)


def compressed(run):
    rows = []
    probes = {"dusk": DUSK, **run.probes(["Grace Cathedral", "Uffizi", "St Peter's"])}
    for name, probe in probes.items():
        errors = []
        for domain in ("pixel", "dct"):
            for keep in ("20%", "10%", "5%"):
                printed = relit(run, probe, "kept.exr", "--domain", domain, "--keep", keep)
                errors.append(re.search(r"error ([0-9.e+-]+)%", printed).group(1))
        rows.append([name, *errors])
    run("relight", make_stage(run), "--reflectance-function", "120,60", "-o", run.pictures / "stage-function.png",
        "--exposure", EXPOSURE)
    return Row(
        "HDRI figure 9.45: relighting on the coefficients of cosines",
        "Reflectance functions are products of many values; of their coefficients after a discrete "
        "cosine transform, as in JPEG, up to 90% can be zero.",
        ["chromeball relight stage.exr --probe PROBE --domain dct --keep 10% -o OUT.exr"],
        "The error, in percent, of the largest numbers alone:\n\n"
        + table(["probe", "values, 20%", "10%", "5%", "cosines, 20%", "10%", "5%"], rows),
        "With a fifth of the numbers both are good; with fewer, cosines are 2.5 and more times as "
        "close. Numbers are kept by their size in the whole stage; the text quantises them as JPEG does.",
        [("stage-function.png", "The reflectance function of one pixel, as a lat-long map")])


def rows(run):
    return [sums(run), compressed(run)]
