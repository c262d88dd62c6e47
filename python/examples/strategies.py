# SPDX-License-Identifier: Apache-2.0
"""The error of strategies against samples: a table, strategies.csv, and strategies.png where matplotlib is installed.

    python strategies.py [SCENE.toml | MODEL.glb PROBE.exr] [--quick]
"""

import pathlib
import sys

import chromeball as cb

PROJECT = pathlib.Path(__file__).resolve().parents[2]
STRATEGIES = ["uniform", "importance", "product", "median-cut:64"]

quick = "--quick" in sys.argv
files = [argument for argument in sys.argv[1:] if not argument.startswith("-")]
if not files:
    files = [PROJECT / "scenes" / "models" / "still-life.glb", PROJECT / "probes" / "dusk.exr"]
scene = files[0] if str(files[0]).endswith(".toml") else cb.load(files[0])
probe = cb.Probe(files[1]) if len(files) > 1 else None
found = cb.compare(scene, probe, STRATEGIES, size=(32, 24) if quick else (160, 120),
                   samples=(1, 4) if quick else (1, 4, 16, 64), repeats=3 if quick else 8)
print(found.table())
found.save("strategies.csv")

try:
    from matplotlib import pyplot
except ImportError:
    sys.exit()
figure, axes = pyplot.subplots(layout="tight")
for strategy in STRATEGIES:
    rows = [row for row in found.rows if row.strategy == strategy]
    axes.loglog([row.samples for row in rows], [row.rmse for row in rows], "o-", label=strategy)
axes.set(xlabel="samples per pixel", ylabel="relative RMSE")
axes.legend()
figure.savefig("strategies.png")
