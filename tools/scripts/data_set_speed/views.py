# SPDX-License-Identifier: Apache-2.0
"""The views of a data set, and a clock for the program that renders them."""
import json
import math
import resource
import sys
import time

LAYERS = ("depth", "normal", "albedo", "alpha", "node", "material")


class Settings:
    def __init__(self):
        for name, value in json.loads(sys.argv[1]).items():
            setattr(self, name, value)

    def positions(self):
        """Of cameras on a circle around the target, glTF's axes."""
        elevation = math.radians(15)
        for i in range(self.views):
            azimuth = 2 * math.pi * i / self.views
            yield [t + self.distance * d for t, d in zip(self.target, (math.cos(elevation) * math.sin(azimuth),
                                                                        math.sin(elevation),
                                                                        math.cos(elevation) * math.cos(azimuth)))]


def processor_seconds():
    """Of all threads of this process since it began."""
    used = resource.getrusage(resource.RUSAGE_SELF)
    return used.ru_utime + used.ru_stime


def measure(load, render):
    """load() reads the model and the probe; render(i, position) makes an image of arrays. Prints the processor's seconds
    and those of the clock: until the first image is there, and of each of the others."""
    settings = Settings()
    begin = time.perf_counter()
    scene = load(settings)
    first = None
    for i, position in enumerate(settings.positions()):
        render(scene, i, position)
        if first is None:
            first = processor_seconds(), time.perf_counter() - begin
    others = settings.views - 1
    print(json.dumps({"first": first[0], "other": (processor_seconds() - first[0]) / others,
                      "clock_first": first[1], "clock_other": (time.perf_counter() - begin - first[1]) / others}))
