# SPDX-License-Identifier: Apache-2.0
"""Part 2: the photographs of a student's course work."""


def text(run):
    return ""
