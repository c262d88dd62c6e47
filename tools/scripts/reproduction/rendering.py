# SPDX-License-Identifier: Apache-2.0
"""Renders by each way of sampling: HDRI's figures 9.22 to 9.28, 9.32, 9.33, 9.36 and 9.37."""
import math

from page import Row, table
from run import NOON, SCENES

PILLARS = SCENES / "models" / "pillars.gltf"
STILL_LIFE = SCENES / "models" / "still-life.glb"
SMALL = ["--size", "240x180", "--adaptive", "off", "--guide", "off"]


def sampling_problem(run):
    common = [*SMALL, "--probe", NOON]
    reference = run.render(PILLARS, "ref.exr", *common, "--samples", 1024, "--strategy", "suns")
    whole = {}
    rows = []
    for name, options in [("uniform, no MIS", ["--strategy", "uniform", "--mis", "off"]),
                          ("BSDF only", ["--strategy", "bsdf"]),
                          ("importance", ["--strategy", "importance"]), ("suns", ["--strategy", "suns"])]:
        image = run.render(PILLARS, f"{options[1]}.exr", *common, "--samples", 81, *options)
        whole[options[1]] = run.error(image, reference)["relmse"]
        rows.append([name, f"{whole[options[1]]:.3g}", f"{whole['uniform'] / whole[options[1]]:,.0f}"])
    pictures = [(run.picture("uniform.exr", "problem-uniform.png"), "81 uniform samples per pixel, without MIS"),
                (run.picture("suns.exr", "problem-suns.png"), "81 samples of the strategy `suns`")]
    for part in ("suns", "rest"):
        image = run.render(PILLARS, f"part-{part}.exr", *common, "--samples", 81, "--strategy", "suns",
                           "--light-from", part)
        pictures.append((run.picture(image, f"problem-only-{part}.png"), f"`--light-from {part}`"))
    hit = 1 - math.cos(math.radians(0.5323 / 2))  # of a hemisphere
    miss = (1 - hit) ** 81
    return [Row(
        "HDRI figures 9.22 and 9.25 to 9.28: the sampling problem",
        "81 random rays mostly miss the sun: the image is speckled. Sun and sky are sampled apart and added.",
        ["chromeball render scenes/models/pillars.gltf --probe probes/noon.exr --samples 81 --strategy STRATEGY"],
        f"A pixel misses a sun of 0.5323 degrees with all 81 rays with probability {miss:.5f}; those that hit it are "
        f"{1 / (1 - miss):,.0f} times too bright.\n\n"
        + table(["samples of 81", "relMSE", "uniform / this"], rows), "", pictures)]


def grace_by_lights(run):
    grace = run.probe("Grace Cathedral")
    if not grace:
        return []
    common = ["--size", "160x120", "--adaptive", "off", "--guide", "off", "--probe", grace]
    reference = run.render(STILL_LIFE, "ref.exr", *common, "--samples", 2048)
    rows = []
    for name, samples in [("median-cut:16", 64), ("median-cut:64", 64), ("median-cut:256", 64),
                          ("median-cut-area:64", 64), ("bsdf", 4096)]:
        image = run.render(STILL_LIFE, "g.exr", *common, "--samples", samples, "--strategy", name)
        error = run.error(image, reference, "--flip")
        rows.append([f"`{name}`", samples, f"{error['flip']:.3f}", f"{error['relmse']:.3g}"])
    return [Row(
        "HDRI figures 9.32 and 9.33: Grace with 16, 64 and 256 lights against 4096 random rays",
        "64 lights are close, 256 nearly indistinguishable from the truth, and free of noise.",
        ["chromeball render scenes/models/still-life.glb --probe grace_probe.hdr --strategy median-cut:N"],
        table(["strategy", "samples", "FLIP", "relMSE"], rows),
        "The scene here has metal, glass and lacquer, where lights stand out more than on the book's matte figures; "
        "a FLIP below 0.05 is hard to see.")]


def st_peters(run):
    file = run.probe("St Peter's")
    if not file:
        return []
    common = [*SMALL, "--probe", file]
    reference = run.render(PILLARS, "ref.exr", *common, "--samples", 4096)
    errors = {}
    for name in ("uniform", "importance", "bsdf"):
        image = run.render(PILLARS, "p.exr", *common, "--samples", 64, "--strategy", name, "--mis",
                           "balance" if name == "bsdf" else "off")
        errors[name] = run.error(image, reference)["relmse"]
    run("probe", "plot", NOON, run.pictures / "noon-row.svg", "--samples", 16)
    return [Row(
        "HDRI figures 9.36 and 9.37: 64 samples by importance",
        "Importance sampling of St Peter's has far less noise than random directions.",
        ["chromeball render scenes/models/pillars.gltf --probe stpeters_cross.hdr --samples 64 --mis off",
         "chromeball probe plot probes/noon.exr row.svg"],
        table(["samples of 64", "relMSE", "times that of importance"],
              [[name, f"{error:.3g}", f"{error / errors['importance']:.0f}"] for name, error in errors.items()]), "",
        [("noon-row.svg", "Samples of a row of the project's noon: luminance, cumulative distribution, texels")])]


def rows(run):
    return sampling_problem(run) + grace_by_lights(run) + st_peters(run)
