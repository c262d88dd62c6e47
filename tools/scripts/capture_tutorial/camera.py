# SPDX-License-Identifier: Apache-2.0
"""The camera that takes the photographs: its response, noise, falloff and lens."""
import bisect
import math
import random

import pixels

# Exposure times of the bracket, as EXIF has them: uneven steps, which tell more of the response.
TIMES = [(1, 1000), (1, 400), (1, 125), (1, 60), (1, 15), (1, 6), (1, 2)]
EVEN_TIMES = [(1, 1000), (1, 250), (1, 60), (1, 15), (1, 4), (1, 1)]
F_NUMBER = 8
SENSITIVITY = 800  # exposure 1 = white is reached at radiance x time / F_NUMBER^2 x SENSITIVITY = 1
FULL_WELL, READ_NOISE = 15000, 4  # electrons


def response(exposure):
    """The level, 0 to 1: a power with an S-curve, as cameras have."""
    v = min(max(exposure, 0), 1) ** 0.45
    return 0.6 * v + 0.4 * v * v * (3 - 2 * v)


_STEPS = 1 << 14
_ENTRANCES = []  # exposures at which the rounded level becomes 1, 2, ... 255


def exposure_of(level):
    """The inverse of response(), by bisection."""
    low, high = 0.0, 1.0
    for _ in range(60):
        middle = (low + high) / 2
        low, high = (middle, high) if response(middle) < level else (low, middle)
    return (low + high) / 2


def unit():
    """By which a merged image differs from radiance: `solve` gives level 128 the exposure of sRGB."""
    srgb = ((128 / 255 + 0.055) / 1.055) ** 2.4
    return SENSITIVITY * srgb / exposure_of(128 / 255)


def photograph(path, radiance, seconds, noise, falloff=None):
    """Writes an 8-bit photograph of linear rows, with EXIF. `noise`: random.Random."""
    if not _ENTRANCES:
        _ENTRANCES.extend(exposure_of((level + 0.5) / 255) for level in range(255))
    factor = seconds[0] / seconds[1] / F_NUMBER ** 2 * SENSITIVITY
    levels = []
    for y, row in enumerate(radiance):
        line = []
        for x, pixel in enumerate(row):
            scale = factor * (falloff(x + 0.5, y + 0.5) if falloff else 1)
            line.append(tuple(_level(value * scale, noise) for value in pixel))
        levels.append(line)
    pixels.write_png(path, levels, pixels.exif(seconds, F_NUMBER, 100))


def _level(exposure, noise):
    if exposure <= 0:
        return 0
    if exposure < 1.1:
        sigma = math.sqrt(exposure * FULL_WELL + READ_NOISE ** 2) / FULL_WELL
        exposure += sigma * noise.gauss(0, 1)
    return bisect.bisect_right(_ENTRANCES, exposure)


def bracket(folder, name, radiance, seed, times=None, falloff=None):
    """The files of a series of photographs."""
    files = []
    for seconds in times or TIMES:
        files.append(f"{name}-{seconds[0]}-{seconds[1]}.png")
        photograph(folder / files[-1], radiance, seconds, random.Random(f"{seed} {seconds}"), falloff)
    return files


class View:
    """A pinhole with radial distortion k1 that looks from one point to another."""

    def __init__(self, position, target, fov, size, k1=0.0):
        self.position, self.target, self.fov, self.size, self.k1 = position, target, fov, size, k1

    def toml(self):
        text = f"[camera]\nposition = {list(self.position)}\nlook_at = {list(self.target)}\nfov = {self.fov}\n"
        return text + (f"distortion = {self.k1}\n" if self.k1 else "")

    def axes(self):
        back = _unit([p - t for p, t in zip(self.position, self.target)])
        right = _unit([back[2], 0, -back[0]])  # (0, 1, 0) x back
        up = [back[1] * right[2] - back[2] * right[1], back[2] * right[0] - back[0] * right[2],
              back[0] * right[1] - back[1] * right[0]]
        return right, up, back

    def pixel(self, point):
        """Where it appears, in pixels from the top left corner (Brown 1971)."""
        to = [a - b for a, b in zip(point, self.position)]
        right, up, back = (sum(a * b for a, b in zip(to, axis)) for axis in self.axes())
        x, y = right / -back, up / -back
        focal = 0.5 * self.size[1] / math.tan(math.radians(self.fov) / 2)
        scale = focal * (1 + self.k1 * (x * x + y * y))
        return self.size[0] / 2 + scale * x, self.size[1] / 2 - scale * y


def _unit(v):
    length = math.hypot(*v)
    return [c / length for c in v]
