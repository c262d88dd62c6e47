# SPDX-License-Identifier: Apache-2.0
"""Whether the samples of a strategy have its pdf."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Callable, NamedTuple

from . import _arrays, _core, _values
from ._errors import InputError
from ._strategy import CheckedStrategy

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

_HEIGHTS, _AZIMUTHS = 24, 48
_MOST_HALVINGS, _MOST_CELLS, _BATCH = 12, 1 << 19, 1 << 18
_NORMALS = ((0, 1, 0), (0.6, 0, -0.8), (-0.36, -0.48, 0.8))


class ChiSquare(NamedTuple):
    """Pearson's chi-square test of a strategy's samples against its pdf."""

    statistic: float
    degrees_of_freedom: int
    #: The probability of such a statistic if the pdf is right: below 1e-4 it is wrong.
    p_value: float
    #: The integral of pdf() over the sphere, the mean over the points: 1 minus the fraction of samples that are none.
    total: float
    #: The fraction of samples whose pdf differs from that of pdf() by more than a hundredth.
    mismatch: float


def chi_square(strategy: Any, points: Any = None, *, samples: int = 100_000, seed: int = 0) -> ChiSquare:
    """Compares the numbers of directions of sample() in 24 x 48 bins of equal solid angle with the integrals of pdf().

    strategy: a Strategy, or any object with sample() and pdf(). points: Points(positions [P,3] or None, normals [P,3]), each
    of which gets `samples` samples; None: three normals where samples depend on them. Bins in which less than 5 are expected
    are pooled.
    """
    import numpy as np

    checked = CheckedStrategy(strategy)
    generator = np.random.default_rng(_values.whole("seed", seed, 0, 2**64 - 1))
    if samples < 1:
        raise InputError(f"chi_square(): samples is {samples}; it should be 1 or more")
    positions, normals = _points(checked, points, generator.random((256, 2)))
    statistic, degrees, totals, mismatches = 0.0, 0, [], []
    for position, normal in zip(positions, normals):

        def at(count: int) -> tuple[Any, Any]:
            return np.tile(position, (count, 1)), np.tile(normal, (count, 1))

        directions, pdf = checked.sample(*at(samples), generator.random((samples, 2)))
        found = pdf > 0
        integrals = _integrals(lambda w: checked.pdf(w, *at(len(w))), directions[found], samples)
        counts = np.bincount(_bins(directions[found]), minlength=len(integrals))
        total = integrals.sum()
        # Each point has a number of samples of its own.
        of_point = _core.chi_square([*counts.astype(float), float(np.count_nonzero(~found))], [*(integrals * samples), max(0, 1 - total) * samples])
        statistic, degrees = statistic + of_point[0], degrees + of_point[1]
        totals.append(total)
        again = checked.pdf(directions, *at(samples))
        mismatches.append(np.mean(np.abs(again - pdf)[found] > 0.01 * pdf[found]) if found.any() else 0)
    return ChiSquare(statistic, degrees, _core.chi_square_p_value(statistic, degrees), float(np.mean(totals)), float(np.mean(mismatches)))


def _points(checked: CheckedStrategy, points: Any, u: NDArray[np.float64]) -> tuple[Any, Any]:
    """Positions and normals [P,3]: the given ones, or those that are needed."""
    import numpy as np

    if points is not None:
        try:
            positions, normals = points
        except (TypeError, ValueError):
            raise InputError("chi_square(): points should be Points(positions, normals)") from None
        normals = _arrays.directions("normals", normals)
        if positions is None:
            return np.zeros_like(normals), normals
        return _arrays.array("positions", positions, (len(normals), 3), "float32"), normals
    normals = _arrays.directions("normals", _NORMALS)
    first, *others = (checked.sample(np.zeros((len(u), 3), np.float32), np.tile(n, (len(u), 1)), u) for n in normals)
    depends = any(not np.array_equal(a, b) for other in others for a, b in zip(first, other))
    normals = normals if depends else normals[:1]
    return np.zeros_like(normals), normals


def _grid(directions: NDArray[np.float32]) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Rows and columns of the bins, with fractions."""
    import numpy as np

    height = (directions[:, 1].astype(float) + 1) / 2 * _HEIGHTS
    turns = np.arctan2(directions[:, 2], directions[:, 0]).astype(float) / (2 * np.pi) % 1
    return height.clip(0, _HEIGHTS * (1 - 1e-12)), (turns * _AZIMUTHS).clip(0, _AZIMUTHS * (1 - 1e-12))


def _bins(directions: NDArray[np.float32]) -> NDArray[np.intp]:
    height, azimuth = _grid(directions)
    bins: NDArray[np.intp] = height.astype(int) * _AZIMUTHS + azimuth.astype(int)
    return bins


def _integrals(pdf: Callable[[Any], Any], found: NDArray[np.float32], samples: int) -> NDArray[np.float64]:
    """The integral of a pdf over each bin. `found`: directions of some of as many samples.

    Cells are divided into four until that changes little, and the numbers of samples in them do not tell of a part, such
    as a small sun, that their points have missed; if those are many, the roughest are.
    """
    import numpy as np

    def rule(row: Any, column: Any, halvings: int) -> Any:
        """The integrals over cells, by the 4 x 4 points in the middles of their parts."""
        n = 4 << halvings
        i, j = (np.arange(16) // 4, np.arange(16) % 4)
        # Even steps of the polar angle: pdfs of lat-long maps may have a pole, 1 / sin, there.
        low, high = (np.arccos(np.clip(2 * (row[:, None] + k) / (_HEIGHTS << halvings) - 1, -1, 1)) for k in (0, 1))
        polar = low + (high - low) * (i + 0.5) / 4
        weights = np.sin(polar) / np.sin(polar).sum(1, keepdims=True)
        turn = (4 * column[:, None] + j + 0.5) / (n * _AZIMUTHS) * 2 * np.pi
        x, y, z = np.sin(polar) * np.cos(turn), np.cos(polar), np.sin(polar) * np.sin(turn)
        directions = np.stack([x, y, z], -1).reshape(-1, 3).astype(np.float32)
        parts = [pdf(directions[k : k + _BATCH]) for k in range(0, len(directions), _BATCH)]
        angle = 4 * np.pi / (_HEIGHTS * _AZIMUTHS) / (1 << halvings) ** 2
        return (np.concatenate(parts).astype(float).reshape(-1, 16) * weights).sum(1) * angle

    height, azimuth = _grid(found)

    def counts(row: Any, column: Any, halvings: int) -> Any:
        """The numbers of samples in cells."""
        columns = _AZIMUTHS << halvings
        places, numbers = np.unique(
            (height * (1 << halvings)).astype(int) * columns + (azimuth * (1 << halvings)).astype(int), return_counts=True)
        cells = row * columns + column
        at = np.searchsorted(places, cells).clip(0, max(len(places) - 1, 0))
        return np.where(places[at] == cells, numbers[at], 0) if len(places) else np.zeros(len(cells))

    def beside(row: Any, column: Any, rough: Any, columns: int) -> Any:
        """Whether cells have a rough neighbour, a sliver of which may be theirs."""
        down, right = (a.ravel() for a in np.meshgrid([-1, 0, 1], [-1, 0, 1]))
        around = (row[rough][:, None] + down) * columns + (column[rough][:, None] + right) % columns
        return np.isin(row * columns + column, around)

    bins = np.arange(_HEIGHTS * _AZIMUTHS)
    row, column = np.divmod(bins, _AZIMUTHS)
    integrals: NDArray[np.float64] = np.zeros(len(bins))
    estimate = rule(row, column, 0)
    for halvings in range(1, _MOST_HALVINGS + 1):
        row, column = (2 * row[:, None] + [0, 0, 1, 1]).ravel(), (2 * column[:, None] + [0, 1, 0, 1]).ravel()
        bins = bins.repeat(4)
        fine = rule(row, column, halvings)
        change = np.abs(fine.reshape(-1, 4).sum(1) - estimate).repeat(4) * samples
        surplus = np.abs(counts(row, column, halvings) - fine * samples)
        missed = surplus > 1.5 * np.sqrt(fine * samples + 0.25)
        rough = (change > 0.2) | missed
        if halvings < 7:  # then the slivers are too small to count
            rough |= beside(row, column, rough, _AZIMUTHS << halvings)
        rough |= halvings < 3
        if halvings == _MOST_HALVINGS:
            rough[:] = False
        elif 4 * np.count_nonzero(rough) > _MOST_CELLS:
            most = np.where(rough, change + np.where(missed, surplus, 0), 0)
            rough[np.argpartition(most, -_MOST_CELLS // 4)[: -_MOST_CELLS // 4]] = False
        np.add.at(integrals, bins[~rough], fine[~rough])
        bins, row, column, estimate = bins[rough], row[rough], column[rough], fine[rough]
        if not len(bins):
            break
    return integrals
