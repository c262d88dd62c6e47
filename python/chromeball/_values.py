# SPDX-License-Identifier: Apache-2.0
"""Arguments that are strings, paths and whole numbers."""

from __future__ import annotations

import array
import operator
import os
from typing import Any

from ._errors import InputError


def text(name: str, value: Any) -> str:
    """The value; throws InputError for what is no string, or no valid Unicode."""
    if not isinstance(value, str):
        raise InputError(f"{name}: is a {type(value).__name__}; it should be a string")
    try:
        value.encode()
    except UnicodeEncodeError:
        raise InputError(f"{name}: {value!r} is no valid text") from None
    return value


def path(name: str, value: Any) -> str:
    """The name of a file, from a string or a path."""
    return text(name, os.fspath(value) if isinstance(value, os.PathLike) else value)


def copied(value: Any) -> Any:
    """The value without references to the caller's lists, dicts and arrays, which may change later."""
    if isinstance(value, dict):
        return {key: copied(item) for key, item in value.items()}
    if isinstance(value, list):
        return [copied(item) for item in value]
    if type(value) is tuple:
        return tuple(copied(item) for item in value)
    if getattr(value, "ndim", 0) and hasattr(value, "__array__"):
        import numpy as np

        return np.array(value)
    if isinstance(value, (array.array, bytearray, memoryview)):
        return memoryview(value).tolist()
    return value


def whole(name: str, value: Any, low: int, high: int) -> int:
    """A whole number of any type, numpy's also."""
    try:
        number = operator.index(value)
    except TypeError:
        raise InputError(f"{name}: {value!r} should be a whole number") from None
    if not low <= number <= high:
        raise InputError(f"{name}: {number} should be {low} to {high}")
    return number
