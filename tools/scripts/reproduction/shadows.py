# SPDX-License-Identifier: Apache-2.0
"""Shadows of probes and of lights in their place: HDRI's figures 9.31 and 9.34."""
from page import Row, table
from run import SCENES

PILLARS = SCENES / "models" / "pillars.gltf"
COMMON = ["--size", "240x160", "--adaptive", "off"]


def rows(run):
    rows, pictures = [], []
    for name in ("St Peter's", "Lobby"):
        if not (file := run.probe(name)):
            continue
        common = [*COMMON, "--guide", "off", "--probe", file]
        reference = run.reference(PILLARS, "shadows-ref.exr", *common, "--samples", 2048)
        methods = ["cube-grid:10", "lightgen:6", "lightgen:40", "lightgen:100", "median-cut:64"]
        for method in methods:
            image = run.render(PILLARS, "shadows.exr", *common, "--samples", 64, "--strategy", method)
            error = run.error(image, reference, "--flip")
            rows.append([f"{name}, `{method}`", f"{error['flip']:.3f}", f"{error['relmse']:.3g}"])
            if name == "Lobby" and method in ("cube-grid:10", "lightgen:6"):
                pictures.append((run.picture(image, f"shadows-{method.replace(':', '-')}.png"), f"`{method}`"))
        if name == "Lobby":
            pictures.append((run.picture(reference, "shadows-importance.png"), "2048 samples of the probe"))
    if not rows:
        return []
    return [Row(
        "HDRI figures 9.31 and 9.34: the shadows of few lights",
        "The picture under the 600 lights of a cube's grid is \"free of noise and artifacts\", though "
        "shadows and highlights are not exactly in place; a finite number of lights may show as "
        "stair-stepped shadows. LightGen puts its lights where the light is, and a window of a few "
        "of them casts as many distinct shadows.",
        ["chromeball render scenes/models/pillars.gltf --probe PROBE --strategy METHOD:N --adaptive off "
         "--guide off -o OUT.exr"],
        table(["probe and lights", "FLIP", "relMSE"], rows),
        "Each light has a sharp shadow: six of them can be counted, 600 blend. In the lobby the grid's 600 are "
        "as good as 100 of LightGen; in St Peter's, where most light comes from a few windows, 40 of these are better.", pictures)]
