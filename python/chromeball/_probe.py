# SPDX-License-Identifier: Apache-2.0
"""Light probes."""

from __future__ import annotations

import os
import warnings
from typing import TYPE_CHECKING, Any, NamedTuple, Sequence

from . import _arrays, _values
from ._core import ProbeMap
from ._errors import InputError, RenderWarning

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray


class Lights(NamedTuple):
    """Directional lights in place of a probe."""

    #: [N,3] unit, from the scene to the light
    directions: NDArray[np.float64]
    #: [N,3] W/m^2 on a surface that faces the light
    irradiances: NDArray[np.float64]
    #: [N] angular diameters, degrees; 0: a point
    angles: NDArray[np.float64]
    #: [3] radiance from all directions, where it was asked for
    ambient: NDArray[np.float32] | None


def _lights(found: Any) -> Lights:
    import numpy as np

    directions, irradiances, angles, ambient = found
    return Lights(directions, irradiances, np.asarray(angles, np.float64),
                  None if ambient is None else np.asarray(ambient, np.float32))


class Probe:
    """The radiance from all directions: of a file (.exr, .hdr, .png, .jpg, a folder of cube faces), or an array [H,W,3].

    Radiance is linear Rec. 709. `mapping`: "auto" (detected), "lat-long", "angular", "mirror-ball", "cube-cross",
    "cube-strip", "cube-3x2" or "fisheye[:FOV[:PROJECTION]]". The middle of the image shows -Z, its top +Y. A probe does
    not change: rotated() and scaled() return others, which share its map.
    """

    def __init__(self, source: Any, mapping: str = "auto") -> None:
        if isinstance(source, ProbeMap):
            self._map = source
            return
        mapping = _values.text("Probe(): mapping", mapping)
        if isinstance(source, (str, os.PathLike)):
            self._map = ProbeMap.read(_values.path("Probe()", source), mapping)
        else:
            texels = _arrays.array("Probe()", source, ("H", "W", 3), "float32")
            if texels.size == 0:
                raise InputError("Probe(): the array has no texels")
            self._map = ProbeMap.of_array(texels, mapping)
        for kind, text in self._map.messages:
            if kind == "warning":
                warnings.warn(text, RenderWarning, stacklevel=2)

    @property
    def size(self) -> tuple[int, int]:
        """Width and height of the lat-long map, in texels."""
        return self._map.size

    @property
    def mapping(self) -> str:
        """The mapping of the file or array."""
        return self._map.mapping

    @property
    def messages(self) -> list[tuple[str, str]]:
        """How the file or array was read: pairs of "note" or "warning", and the text. (Warnings were RenderWarnings too.)"""
        return self._map.messages

    def rotated(self, rotation: float | Sequence[float]) -> Probe:
        """The probe after a turn: a yaw in degrees about +Y, counter-clockwise seen from above; (yaw, pitch, roll) in
        degrees; or a quaternion (x, y, z, w)."""
        return Probe(self._map.rotated(_numbers("rotated()", rotation, (1, 3, 4))))

    def scaled(self, factor: float | Sequence[float]) -> Probe:
        """The probe with all radiance times a number, or three for red, green and blue."""
        return Probe(self._map.scaled(_numbers("scaled()", factor, (1, 3))))

    def radiance(self, directions: Any) -> NDArray[np.float32]:
        """[N,3] radiance that arrives from these directions [N,3] of any length above 0, as renders see it."""
        return self._map.radiance(_arrays.directions("directions", directions))

    def irradiance(self, normals: Any) -> NDArray[np.float64]:
        """[N,3] exact irradiance, W/m^2, on unoccluded surfaces with these normals [N,3] of any length above 0."""
        return self._map.irradiance(_arrays.directions("normals", normals))

    def lights(self, method: str, n: int | None = None, *, seed: int = 0, ambient: bool = False) -> Lights:
        """Up to `n` directional lights in place of the probe, by a method of `chromeball lights`: "median-cut",
        "penrose", "irradiance-fit" and others (docs/methods.md). `seed`: of stochastic methods; `ambient`: of the fit."""
        count = None if n is None else _values.whole("lights(): n", n, 1, 2**31 - 1)
        seed = _values.whole("lights(): seed", seed, 0, 2**64 - 1)
        return _lights(self._map.lights(_values.text("lights(): method", method), count, seed, bool(ambient)))

    def suns(self) -> Lights:
        """The suns of the probe as discs of constant radiance, in order of decreasing irradiance."""
        return _lights(self._map.suns())

    def to(self, mapping: str, size: int | tuple[int, int] | None = None) -> NDArray[np.float32]:
        """[H,W,3] radiance in another mapping, turned and scaled. `size`: width and height, or one number for a square
        (the height, for "lat-long"); None: one that keeps the detail."""
        mapping = _values.text("to(): mapping", mapping)
        return self._map.to(mapping, None if size is None else _size(mapping, size))

    def __repr__(self) -> str:
        width, height = self.size
        return f"<chromeball.Probe {self._map.name}, {self.mapping}, {width} x {height}>"


def _size(mapping: str, size: Any) -> tuple[int, int]:
    most = 2**31 - 1
    if not isinstance(size, (tuple, list)):
        height = _values.whole("to(): size", size, 1, most // 2)
        return (2 * height if mapping == "lat-long" else height, height)
    if len(size) != 2:
        raise InputError(f"to(): size: {size!r} should be one whole number, or two")
    return (_values.whole("to(): size", size[0], 1, most), _values.whole("to(): size", size[1], 1, most))


def _numbers(name: str, value: Any, counts: tuple[int, ...]) -> list[float]:
    import numpy as np

    numbers = np.atleast_1d(_arrays.as_array(name, value))
    if numbers.ndim != 1 or numbers.size not in counts or numbers.dtype.kind not in "iuf":
        raise InputError(f"{name}: {value!r} should be {' or '.join(map(str, counts))} numbers")
    if not np.isfinite(numbers).all():
        raise InputError(f"{name}: {value!r} is not finite")
    return [float(x) for x in numbers]
