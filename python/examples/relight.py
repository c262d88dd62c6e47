# SPDX-License-Identifier: Apache-2.0
"""Turns a probe around a scene of arrays, which is loaded once: relight-0.png to relight-7.png.

    python relight.py [PROBE.exr] [--quick]
"""

import sys

import numpy as np

import chromeball as cb


def sphere(rings=32):
    """Positions and triangles of a ball of radius 1."""
    v, u = np.mgrid[0 : rings + 1, 0 : 2 * rings + 1] * np.pi / rings
    positions = np.stack([np.sin(v) * np.sin(u), np.cos(v), np.sin(v) * np.cos(u)], axis=-1)
    at = np.arange(positions.size // 3).reshape(v.shape)
    corners = at[:-1, :-1], at[1:, :-1], at[1:, 1:], at[:-1, 1:]
    triangles = [np.stack([corners[i] for i in three], -1).reshape(-1, 3) for three in ((0, 1, 2), (0, 2, 3))]
    return positions.reshape(-1, 3), np.concatenate(triangles)


def sky(height=64):
    """A blue sky with a sun over a brown ground."""
    map_ = np.zeros((height, 2 * height, 3), np.float32)
    map_[: height // 2] = 0.3, 0.5, 0.9
    map_[height // 2 :] = 0.2, 0.15, 0.1
    map_[height // 4, height // 2] = 900, 800, 600
    return map_


quick = "--quick" in sys.argv
files = [argument for argument in sys.argv[1:] if not argument.startswith("-")]
probe = cb.Probe(files[0]) if files else cb.Probe(sky())

scene = cb.Scene()
positions, triangles = sphere()
scene.add_mesh(positions, triangles, normals=positions, material=cb.Material(base_color=(0.8, 0.6, 0.3), metallic=1,
                                                                              roughness=0.3))
ground = [(-4, -1, 4), (4, -1, 4), (4, -1, -4), (-4, -1, -4)]
scene.add_mesh(ground, [(0, 1, 2), (0, 2, 3)], material=cb.Material(base_color=0.5))

session = cb.Session(scene, probe, cb.Camera.look_at((0, 1.5, 5), (0, -0.2, 0)), denoise=True,
                     size=(80, 60) if quick else (640, 480), samples=16 if quick else 64)
for i in range(2 if quick else 8):
    image = session.update(probe_rotation=45 * i).start().wait()
    image.save(f"relight-{i}.png", exposure=0)
    print(f"{45 * i:3} degrees: noise {100 * image.noise:.1f}%, {image.stats['seconds']['render']:.2f} s", session.work)
