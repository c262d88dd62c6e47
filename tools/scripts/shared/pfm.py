# SPDX-License-Identifier: Apache-2.0
"""Reads .pfm images."""
import array
import sys


def read_pfm(path):
    """Rows from the top: [y][x] = (r, g, b)."""
    with open(path, "rb") as file:
        assert file.readline().strip() == b"PF"
        width, height = map(int, file.readline().split())
        little = float(file.readline()) < 0
        values = array.array("f", file.read())
    if little != (sys.byteorder == "little"):
        values.byteswap()
    rows = [[tuple(values[3 * (y * width + x):3 * (y * width + x) + 3]) for x in range(width)]
            for y in range(height)]
    return rows[::-1]
