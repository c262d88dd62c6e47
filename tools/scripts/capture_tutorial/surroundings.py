# SPDX-License-Identifier: Apache-2.0
"""The probe of the place: probes/noon.exr with houses on its horizon and stones on its ground."""
import math
import random

import pixels
from pfm import read_pfm
from run import NOON

WIDTH, HEIGHT = 768, 384
SUN_AZIMUTH = math.atan2(-0.552, 0.497)  # 0 is +Z, 90 degrees +X


def houses():
    """(azimuth, half width, height above the horizon in degrees, windows across, color)"""
    chance = random.Random(7)
    row, azimuth = [], -180.0
    while azimuth < 175:
        half = chance.uniform(4, 13)
        shade = chance.uniform(0.25, 0.9)
        color = tuple(shade * chance.uniform(0.8, 1.1) * c for c in (1.1, 0.95, 0.8))
        row.append((azimuth + half, half, chance.uniform(4, 22), chance.randint(3, 7), color))
        azimuth += 2 * half + (chance.uniform(4, 20) if chance.random() < 0.5 else 0)
    return row


def house_at(row, azimuth, elevation):
    for middle, half, top, columns, color in row:
        across = (azimuth - middle + half) / (2 * half)
        if 0 <= across < 1 and elevation < top:
            u, v = across * columns % 1, elevation * columns / (2 * half) % 1
            is_window = 0.25 < u < 0.75 and 0.3 < v < 0.8
            facing = math.cos(math.radians(middle) - SUN_AZIMUTH)  # the far side of the street faces back
            light = 0.25 + 1.1 * max(0, -facing)
            return tuple((0.15 if is_window else 1) * light * c for c in color)
    return None


def stone_at(azimuth, elevation, radiance):
    distance = 1.5 / math.tan(math.radians(-elevation))
    x, z = distance * math.sin(math.radians(azimuth)), distance * math.cos(math.radians(azimuth))
    contrast = 0.45 / (1 + (distance / 6) ** 2)
    sign = 1 if (math.floor(x / 1.3) + math.floor(z / 1.3)) % 2 else -1
    return tuple((1 + sign * contrast) * c for c in radiance)


def write(run, name):
    """The lat-long map `name` (.pfm) in the scratch folder."""
    run("probe", "convert", NOON, "sky.pfm", "--to", "lat-long", "--size", f"{WIDTH}x{HEIGHT}")
    rows = read_pfm(run.scratch / "sky.pfm")
    row = houses()
    for y in range(HEIGHT):
        elevation = 90 - 180 * (y + 0.5) / HEIGHT
        if elevation > 23:
            continue
        for x in range(WIDTH):
            # The middle is -Z, the right half is on the side of +X.
            azimuth = (180 - 360 * ((x + 0.5) / WIDTH - 0.5) + 180) % 360 - 180
            if elevation < 0:
                rows[y][x] = stone_at(azimuth, elevation, rows[y][x])
            else:
                rows[y][x] = house_at(row, azimuth, elevation) or rows[y][x]
    pixels.write_pfm(run.scratch / name, rows)
    return run.scratch / name
