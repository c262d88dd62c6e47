# SPDX-License-Identifier: Apache-2.0
"""Replaces a probe by a few lights, and prints how well they light a ball of normals; lights.npz has the best.

    python fit_lights.py [PROBE.exr] [--quick]
"""

import pathlib
import sys

import numpy as np

import chromeball as cb

PROJECT = pathlib.Path(__file__).resolve().parents[2]

quick = "--quick" in sys.argv
files = [argument for argument in sys.argv[1:] if not argument.startswith("-")]
probe = cb.Probe(files[0] if files else PROJECT / "probes" / "dusk.exr")
if quick:
    probe = cb.Probe(probe.to("lat-long", 32))

normals = np.random.default_rng(0).normal(size=(1000, 3))
normals /= np.linalg.norm(normals, axis=1, keepdims=True)
exact = probe.irradiance(normals)

best = None
for method in ("median-cut", "penrose", "irradiance-fit"):
    for count in (4, 8) if quick else (4, 8, 16, 32):
        lights = probe.lights(method, count)
        cosines = np.maximum(normals @ lights.directions.T, 0)
        error = np.abs(cosines @ lights.irradiances - exact).mean() / exact.mean()
        print(f"{method:15} {len(lights.directions):3} lights: {100 * error:5.2f}% of the mean irradiance")
        if best is None or error < best[0]:
            best = error, lights
np.savez("lights.npz", directions=best[1].directions, irradiances=best[1].irradiances)
