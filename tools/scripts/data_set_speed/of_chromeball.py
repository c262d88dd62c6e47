# SPDX-License-Identifier: Apache-2.0
"""Renders the views with chromeball's Python module."""
import chromeball as cb
from views import LAYERS, measure


class Scene:
    def __init__(self, settings):
        self.settings = settings
        self.model, self.probe = cb.load(settings.model), cb.Probe(settings.probe)

    def render(self, i, position):
        s = self.settings
        camera = cb.Camera.look_at(position, s.target, fov=s.fov)
        image = cb.render(self.model, self.probe, camera, size=(s.size, s.size), samples=s.samples,
                          max_depth=s.depth, layers=list(LAYERS), seed=i, threads=s.threads,
                          exposure=0, **{"denoise": True} | s.options)
        arrays = [image.color] + [image.layers[name] for name in LAYERS]
        assert all(a.shape[:2] == (s.size, s.size) for a in arrays)
        if i == 0:
            image.save(s.picture)


measure(Scene, Scene.render)
