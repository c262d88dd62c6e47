# SPDX-License-Identifier: Apache-2.0
"""Lighting strategies: the built-in ones over arrays, and those that are written in Python."""

from __future__ import annotations

import inspect
from typing import TYPE_CHECKING, Any, NamedTuple

from . import _arrays, _values
from ._core import BuiltIn
from ._errors import InputError
from ._probe import Probe

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray


class Points(NamedTuple):
    """Points that receive light."""

    #: [N,3] metres, in the world
    positions: NDArray[Any]
    #: [N,3] unit shading normals, on the viewer's side
    normals: NDArray[np.float32]


class Strategy:
    """A built-in strategy ("importance", "product", "uniform"; docs/methods.md) over arrays.

    With `mis` (the default) it is as for renders that combine its samples with those of BSDFs: "importance" leaves to
    these what is darker than the mean (MIS compensation).
    """

    def __init__(self, name: str, probe: Probe, *, mis: bool = True) -> None:
        if not isinstance(probe, Probe):
            raise InputError(f"Strategy(): probe is a {type(probe).__name__}; it should be a chromeball.Probe")
        self.name = _values.text("Strategy()", name)
        self._built = BuiltIn(name, probe._map, mis)

    def sample(self, points: Any, u: Any) -> tuple[NDArray[np.float32], NDArray[np.float32], NDArray[np.float32]]:
        """Directions [N,3] to the light, their radiance [N,3], and pdf [N] over solid angle, for numbers `u` [N,2] in [0, 1).

        points: Points(positions [N,3] or None, normals [N,3]); or None, where the samples do not depend on them. A pdf of 0
        stands for no sample. Strategies that take several samples of a point, or replace the probe by lights, refuse.
        """
        numbers = _arrays.array("u", u, ("N", 2), "float64")
        if not ((numbers >= 0) & (numbers < 1)).all():
            raise InputError("u: should be 0 or above, and below 1")
        return self._built.sample(*self._points("sample()", points, len(numbers)), numbers)

    def pdf(self, directions: Any, points: Any = None) -> NDArray[np.float32]:
        """[N] the pdf, over solid angle, with which sample() finds directions [N,3]; for strategies of several samples, the
        sum of all. 0 where sample() cannot find them, as all lights without an extent."""
        units = _arrays.directions("directions", directions)
        return self._built.pdf(units, *self._points("pdf()", points, len(units)))

    def _points(self, caller: str, points: Any, count: int) -> tuple[Any, Any]:
        if points is None:
            if self._built.needs_normals:
                raise InputError(f"{caller}: `{self.name}` depends on the normal; give points, Points(positions, normals)")
            return None, None
        try:
            positions, normals = points
        except (TypeError, ValueError):
            raise InputError(f"{caller}: points should be Points(positions, normals)") from None
        if positions is not None:
            positions = _arrays.array("positions", positions, (count, 3), "float32")
        normals = _arrays.directions("normals", normals)
        if len(normals) != count:
            raise InputError(f"normals: has the shape {list(normals.shape)}; it should be [{count},3]")
        return positions, normals

    def __repr__(self) -> str:
        return f"<chromeball.Strategy {self.name}>"


class CheckedStrategy:
    """What the renderer calls: a strategy of a program, whose results are checked."""

    def __init__(self, strategy: Any) -> None:
        for method in ("sample", "pdf"):
            if not callable(getattr(strategy, method, None)):
                raise InputError(f"strategy: is a {type(strategy).__name__}; it should be a name, or have sample() and pdf()")
        self._strategy = strategy
        self._takes_points = _takes_two(strategy.pdf)
        kind = type(strategy)
        self.name = f"{kind.__module__}.{kind.__qualname__}"  # no name of a built-in one

    def sample(self, positions: Any, normals: Any, u: Any) -> tuple[Any, Any]:
        import numpy as np

        found = self._strategy.sample(Points(positions, normals), u)
        if not isinstance(found, (tuple, list)) or len(found) != 3:
            raise InputError("strategy: sample() should return directions [N,3], radiance [N,3] and pdf [N]")
        count = len(u)
        directions = _arrays.array("strategy: the directions of sample()", found[0], (count, 3), "float32")
        radiance = _arrays.array("strategy: the radiance of sample()", found[1], (count, 3), "float32")
        pdf = _arrays.array("strategy: the pdf of sample()", found[2], (count,), "float32")
        _refuse("radiance of sample()", radiance, ~(np.isfinite(radiance) & (radiance >= 0)).all(1), "finite, not negative")
        _refuse("pdf of sample()", pdf, ~((pdf > 0) & np.isfinite(pdf)) & ((pdf != 0) | radiance.any(1)),
                "finite and above 0, or 0 with black radiance")
        _refuse("directions of sample()", directions,
                ~(np.abs(np.einsum("ij,ij->i", directions, directions) - 1) < 1e-3), "unit vectors")
        return directions, pdf

    def pdf(self, directions: Any, positions: Any, normals: Any) -> Any:
        import numpy as np

        points = (Points(positions, normals),) if self._takes_points else ()
        pdf = _arrays.array("strategy: the result of pdf()", self._strategy.pdf(directions, *points), (len(directions),),
                            "float32")
        _refuse("result of pdf()", pdf, ~((pdf >= 0) & np.isfinite(pdf)), "finite, not negative")
        return pdf


def _refuse(name: str, values: Any, wrong: Any, expected: str) -> None:
    if wrong.any():
        i = int(wrong.argmax())
        raise InputError(f"strategy: the {name}: element {i} is {values[i].tolist()}; it should be {expected}")


def _takes_two(function: Any) -> bool:
    """Whether it can be called with two arguments: pdf(directions, points)."""
    try:
        inspect.signature(function).bind(None, None)
    except TypeError:
        return False
    except ValueError:  # no signature
        pass
    return True
