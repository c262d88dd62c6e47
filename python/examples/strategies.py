# SPDX-License-Identifier: Apache-2.0
"""The error of strategies against the number of samples, as a table and in strategies.npz.

    python strategies.py [SCENE.toml | MODEL.glb PROBE.exr] [--quick]
"""

import pathlib
import sys

import numpy as np

import chromeball as cb

PROJECT = pathlib.Path(__file__).resolve().parents[2]

quick = "--quick" in sys.argv
files = [argument for argument in sys.argv[1:] if not argument.startswith("-")]
if not files:
    files = [PROJECT / "scenes" / "models" / "still-life.glb", PROJECT / "probes" / "dusk.exr"]
scene = files[0] if str(files[0]).endswith(".toml") else cb.load(files[0])
probe = cb.Probe(files[1]) if len(files) > 1 else None
size = (32, 24) if quick else (320, 240)
counts = (4, 16) if quick else (4, 16, 64, 256)

reference = cb.render(scene, probe, size=size, samples=64 if quick else 4096, seed=1).color
errors = {}
for strategy in ("uniform", "importance", "product", "median-cut:64"):
    errors[strategy] = [
        np.sqrt(np.mean((cb.render(scene, probe, size=size, samples=n, adaptive="off", strategy=strategy).color
                         - reference) ** 2)) / reference.mean()
        for n in counts
    ]
    print(f"{strategy:14}", *(f"{n:4}: {100 * error:6.2f}%" for n, error in zip(counts, errors[strategy])))
np.savez("strategies.npz", counts=counts, **errors)
