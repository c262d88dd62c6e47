# SPDX-License-Identifier: Apache-2.0
"""Arguments that are arrays: their shapes and types. numpy is imported by the first of them."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from ._errors import InputError

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray


def _shape_text(shape: tuple[str | int, ...]) -> str:
    return "[" + ",".join(str(side) for side in shape) + "]"


def as_array(name: str, value: Any) -> NDArray[Any]:
    """The value as an array of its own type and shape. Throws InputError for a ragged list, a tensor on a GPU."""
    import numpy as np

    try:
        return np.asarray(value)
    except Exception as error:
        raise InputError(f"{name}: is no array: {error}") from None


def array(name: str, value: Any, shape: tuple[str | int, ...], dtype: str) -> NDArray[Any]:
    """The value as a contiguous array of this type: a copy only where it is not one already.

    `shape` has numbers, and names for sides of any length. Throws InputError for another shape, for a type
    that loses something (floats for integers, complex numbers), and for integers out of range.
    """
    import numpy as np

    found = as_array(name, value)
    if found.ndim != len(shape) or any(
        isinstance(side, int) and side != length for side, length in zip(shape, found.shape)
    ):
        raise InputError(f"{name}: has the shape {list(found.shape)}; it should be {_shape_text(shape)}")
    target = np.dtype(dtype)
    if found.dtype.kind not in ("iu" if target.kind in "iu" else "iuf"):
        kind = "whole numbers" if target.kind in "iu" else "real numbers"
        raise InputError(f"{name}: has the type {found.dtype}; it should have {kind}")
    if target.kind == "u" and found.size and found.dtype != target:
        low, high = int(found.min()), int(found.max())
        if low < 0 or high > np.iinfo(target).max:
            raise InputError(f"{name}: {low if low < 0 else high} is out of range")
    with np.errstate(over="ignore"):
        return np.ascontiguousarray(found, dtype=target)


def finite(name: str, value: Any, shape: tuple[str | int, ...]) -> NDArray[Any]:
    """The same for floats of 32 bits. Throws InputError, with its place, for a number that is not finite."""
    import numpy as np

    found = array(name, value, shape, "float32")
    wrong = np.argwhere(~np.isfinite(found))
    if wrong.size:
        raise InputError(f"{name}[{wrong[0][0]}]: is not finite")
    return found


def directions(name: str, value: Any) -> NDArray[Any]:
    """Unit vectors [N,3] of 32 bits. Throws InputError for one without a direction."""
    import numpy as np

    vectors = array(name, value, ("N", 3), "float64")
    length = np.linalg.norm(vectors, axis=1)
    wrong = np.flatnonzero(~(np.isfinite(length) & (length > 0)))
    if wrong.size:
        raise InputError(f"{name}[{wrong[0]}]: {vectors[wrong[0]].tolist()} has no direction")
    units: NDArray[np.float32] = (vectors / length[:, None]).astype(np.float32)
    return units


def colors(name: str, value: Any) -> NDArray[Any]:
    """Linear colours [V,3] or [V,4] from 0 to 1 as [V,4]; bytes and uint16 are fractions of the most that they hold."""
    import numpy as np

    found = as_array(name, value)
    if found.ndim != 2 or found.shape[1] not in (3, 4):
        raise InputError(f"{name}: has the shape {list(found.shape)}; it should be [V,3] or [V,4]")
    most = np.iinfo(found.dtype).max if found.dtype.kind == "u" and found.dtype.itemsize <= 2 else 1
    channels = array(name, found, ("V", found.shape[1]), "float64") / most
    wrong = np.flatnonzero(~((channels >= 0) & (channels <= 1)).all(1))
    if wrong.size:
        raise InputError(f"{name}[{wrong[0]}]: {found[wrong[0]].tolist()} should be from 0 to 1, or be uint8 or uint16, which are fractions of their most")
    opaque = np.ones((len(channels), 4), np.float32)
    opaque[:, : channels.shape[1]] = channels
    return opaque


def texels(name: str, value: Any) -> NDArray[Any]:
    """A picture [H,W,1], [H,W,3] or [H,W,4] as one of four channels: bytes, or floats of 32 bits."""
    import numpy as np

    given = found = as_array(name, value)
    if found.ndim == 2:
        found = found[:, :, None]
    if found.ndim != 3 or found.shape[2] not in (1, 3, 4) or found.size == 0:
        raise InputError(f"{name}: has the shape {list(given.shape)}; it should be [H,W,3] or [H,W,4]")
    if found.dtype.kind not in "uf" or (found.dtype.kind == "u" and found.dtype != np.uint8):
        raise InputError(f"{name}: has the type {found.dtype}; it should have bytes (uint8) or floats")
    dtype = np.uint8 if found.dtype == np.uint8 else np.float32
    grid = np.full((*found.shape[:2], 4), 255 if dtype == np.uint8 else 1, dtype)
    grid[:, :, : max(found.shape[2], 3)] = found
    return grid


def matrix(name: str, value: Any) -> NDArray[np.float64]:
    """An affine transform [4,4] of column vectors, or the upper [3,4] of one."""
    import numpy as np

    given = as_array(name, value)
    if given.shape == (3, 4):
        given = np.vstack([array(name, given, (3, 4), "float64"), [0, 0, 0, 1]])
    found = array(name, given, (4, 4), "float64")
    if not np.isfinite(found).all():
        raise InputError(f"{name}: is not finite")
    if not np.allclose(found[3], [0, 0, 0, 1]):
        raise InputError(f"{name}: its last row is {found[3].tolist()}; it should be 0, 0, 0, 1")
    return found
