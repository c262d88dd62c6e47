# SPDX-License-Identifier: Apache-2.0
"""Puts a golden ball of arrays, with its shadow and reflections, into a photograph of a terrace: composite.png.

    python composite.py [--quick]

The model has the objects, a grey copy of the terrace that takes their shadows, and the photograph's camera.
"""

import pathlib
import sys

import numpy as np

import chromeball as cb

SCENES = pathlib.Path(__file__).resolve().parents[2] / "scenes"

quick = "--quick" in sys.argv
scene = cb.Scene(composite={"plate": SCENES / "plates" / "terrace.png", "reflectance": "plate",
                            "local_scene": ["floor", "wall", "pillar", "vase"]})
scene.add_model(SCENES / "models" / "terrace.glb")

v, u = np.mgrid[0:33, 0:65] * np.pi / 32
ball = np.stack([np.sin(v) * np.sin(u), np.cos(v), np.sin(v) * np.cos(u)], axis=-1)
a, b, c, d = (part.reshape(-1, 3) for part in (ball[:-1, :-1], ball[1:, :-1], ball[1:, 1:], ball[:-1, 1:]))
corners = np.stack([a, b, c, a, c, d], axis=1).reshape(-1, 3)
radius, middle = 0.35, (1.0, 0.35, 1.0)
scene.add_mesh(radius * corners + middle, normals=corners, name="ball",
               material=cb.Material(base_color=(1, 0.77, 0.34), metallic=1, roughness=0.15))

image = cb.render(scene, cb.Probe(SCENES.parent / "probes" / "noon.exr"), cb.Camera(name="View"), strategy="suns", regularize=True,
                  samples=4 if quick else 64, layers=["alpha", "difference"])
image.save("composite.png")
print(f"objects and their shadows change {100 * (np.abs(image.layers['difference']).max(2) > 0.01).mean():.0f}% of the photograph")
