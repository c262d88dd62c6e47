# SPDX-License-Identifier: Apache-2.0
"""Renders by each way of sampling: HDRI's figures 9.32, 9.33, 9.36 and 9.37."""
from page import Row, table
from run import NOON, SCENES

PILLARS = SCENES / "models" / "pillars.gltf"
SMALL = ["--size", "240x180", "--adaptive", "off", "--guide", "off"]


def grace_by_lights(run):
    grace = run.probe("Grace Cathedral")
    if not grace:
        return []
    common = ["--size", "160x120", "--adaptive", "off", "--guide", "off", "--probe", grace]
    reference = run.reference(PILLARS, "ref.exr", *common, "--samples", 4096)
    rows = []
    for name, samples in [("median-cut:16", 64), ("median-cut:64", 64), ("median-cut:256", 64),
                          ("median-cut-area:64", 64), ("bsdf", 4096)]:
        image = run.render(PILLARS, "g.exr", *common, "--samples", samples, "--strategy", name)
        error = run.error(image, reference, "--flip")
        rows.append([f"`{name}`", samples, f"{error['flip']:.3f}", f"{error['relmse']:.3g}"])
    return [Row(
        "HDRI figures 9.32 and 9.33: Grace with 16, 64 and 256 lights against 4096 random rays",
        "64 lights are close, 256 nearly indistinguishable from the truth, and free of noise.",
        ["chromeball render scenes/models/pillars.gltf --probe grace_probe.hdr --strategy "
         "median-cut:N --adaptive off --guide off -o OUT.exr"],
        table(["strategy", "samples", "FLIP", "relMSE"], rows),
        "A FLIP below 0.05 is hard to see. With 64 samples a pixel of 256 lights the noise of choosing among them is "
        "part of the error.")]


def st_peters(run):
    file = run.probe("St Peter's")
    if not file:
        return []
    common = [*SMALL, "--probe", file]
    reference = run.reference(PILLARS, "ref.exr", *common, "--samples", 4096)
    errors = {}
    for name in ("uniform", "importance", "bsdf"):
        image = run.render(PILLARS, "p.exr", *common, "--samples", 64, "--strategy", name, "--mis",
                           "balance" if name == "bsdf" else "off")
        errors[name] = run.error(image, reference)["relmse"]
    run("probe", "plot", NOON, run.pictures / "noon-row.svg", "--samples", 16)
    return [Row(
        "HDRI figures 9.36 and 9.37: 64 samples by importance",
        "Importance sampling of St Peter's has far less noise than random directions.",
        ["chromeball render scenes/models/pillars.gltf --probe stpeters_cross.hdr --samples 64 "
         "--strategy STRATEGY --mis HEURISTIC --adaptive off --guide off -o OUT.exr",
         "chromeball probe plot probes/noon.exr row.svg"],
        table(["samples of 64, heuristic", "relMSE", "times that of importance"],
              [[f"{name}, {'balance' if name == 'bsdf' else 'off'}", f"{error:.3g}", f"{error / errors['importance']:.0f}"] for name, error in errors.items()]), "",
        [("noon-row.svg", "Samples of a row of the project's noon: luminance, cumulative distribution, texels")])]


def rows(run):
    return grace_by_lights(run) + st_peters(run)
