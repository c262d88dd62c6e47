# SPDX-License-Identifier: Apache-2.0
"""Lat-long maps as rows of (r, g, b): means and irradiance. `run` runs the program in a scratch folder."""
import math

from pfm import read_pfm


def solid_angle_mean(rows):
    """Of a lat-long map of (r, g, b)."""
    sums, total = [0, 0, 0], 0
    for y, row in enumerate(rows):
        weight = math.sin(math.pi * (y + 0.5) / len(rows))
        total += weight * len(row)
        for pixel in row:
            for c in range(3):
                sums[c] += weight * pixel[c]
    return [s / total for s in sums]


def irradiance(run, probe, name, scale=1.0):
    run("probe", "irradiance", probe, name, "--size", "128x64")
    return [[tuple(scale * value for value in pixel) for pixel in row] for row in read_pfm(run.scratch / name)]


def irradiance_error(found, truth):
    """(mean, largest) over all normals and channels, in percent of the mean irradiance of each channel."""
    mean = solid_angle_mean(truth)
    differences = [[tuple(100 * abs(a - b) / m for a, b, m in zip(p, q, mean)) for p, q in zip(*rows)]
                   for rows in zip(found, truth)]
    return sum(solid_angle_mean(differences)) / 3, max(v for row in differences for p in row for v in p)
