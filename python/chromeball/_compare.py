# SPDX-License-Identifier: Apache-2.0
"""Comparisons of strategies, by the definitions of `chromeball compare`."""

from __future__ import annotations

import contextlib
import csv
import html
import math
import os
import warnings
from typing import TYPE_CHECKING, Any, Iterable, NamedTuple

from . import _arrays, _core, _values
from ._camera import Camera
from ._chi_square import ChiSquare, chi_square
from ._errors import InputError, RenderWarning, RunError
from ._probe import Probe
from ._render import Progress, ProbeLike, SceneLike, _callback, _plan
from ._result import Result
from ._strategy import Strategy

if TYPE_CHECKING:
    import numpy as np
    import pandas  # type: ignore[import-untyped,import-not-found,unused-ignore]
    from numpy.typing import NDArray

_WRONG = 1e-4  # a p-value


class ComparisonRow(NamedTuple):
    """A strategy with one number of samples. Errors are relative to the reference, and `_error` is a standard error."""

    strategy: str
    samples: int
    #: The root of relmse; NaN where the noise of the reference hides it.
    rmse: float
    #: Mean of (image - reference)^2 / (reference^2 + 0.01), without the variance of the reference: variance + squared bias.
    relmse: float
    relmse_error: float
    variance: float
    variance_error: float
    squared_bias: float
    squared_bias_error: float
    #: mean(image - reference) / mean(reference)
    bias: float
    bias_error: float
    #: bias / bias_error: outside -4 to 4 the strategy is biased, unless it has missed light.
    bias_z: float
    #: Of an unbiased built-in strategy whose mean is significantly below the reference's: its samples have not found rare bright
    #: light, such as a small sun, so that neither error nor bias is known.
    missed_light: bool
    #: Of a render, the mean.
    seconds: float
    #: 1 / (relmse seconds); NaN where light is missed.
    efficiency: float
    #: The test of the pdf (chi_square()); NaN, and 0 degrees of freedom, for strategies that have none.
    chi_square: float
    degrees_of_freedom: int
    p_value: float
    #: The fraction of samples whose pdf is not that of pdf().
    mismatch: float


class Comparison:
    """The rows of a comparison. All numbers but times depend on the seed alone."""

    def __init__(self, rows: list[ComparisonRow], reference: NDArray[np.float32]) -> None:
        self.rows = rows
        #: [H,W,3]
        self.reference = reference

    def frame(self) -> pandas.DataFrame:
        """A DataFrame of pandas, which must be installed."""
        try:
            import pandas
        except ImportError:
            raise InputError("frame(): pandas is not installed (pip install pandas); rows, table() and save() need none") from None
        return pandas.DataFrame(self.rows)

    def table(self) -> str:
        """The rows as text, errors with their 95% intervals."""
        cells = self._cells()
        widths = [max(map(len, column)) for column in zip(*cells)]
        lines = ("  ".join([line[0].ljust(widths[0]), *(c.rjust(w) for c, w in zip(line[1:], widths[1:]))]) for line in cells)
        return "\n".join(line.rstrip() for line in lines)

    def save(self, path: str | os.PathLike[str]) -> None:
        """Writes a .csv, which is complete or as it was before."""
        name = os.fspath(path)
        if not name.endswith(".csv"):
            raise InputError(f"save(): {name}: the name must end in .csv")
        part = f"{name}.{os.getpid()}.tmp"
        try:
            with open(part, "w", newline="", encoding="utf-8") as file:
                writer = csv.writer(file)
                writer.writerow(ComparisonRow._fields)
                writer.writerows(self.rows)
            os.replace(part, name)
        except OSError as error:
            with contextlib.suppress(OSError):
                os.remove(part)
            raise RunError(f"save(): {name}: {error.strerror}") from None

    def _cells(self) -> list[list[str]]:
        return [["strategy", "samples", "RMSE %", "relMSE", "variance", "bias %", "z", "seconds", "efficiency", "pdf"]] + [
            [r.strategy, str(r.samples), f"{100 * r.rmse:.3g}", _core.positive_text(r.relmse, r.relmse_error),
             _core.positive_text(r.variance, r.variance_error),
             _core.bias_text(r.bias, r.bias_error, r.missed_light), f"{r.bias_z:.1f}",
             f"{r.seconds:.3g}", f"{r.efficiency:.3g}", _pdf_text(r)]
            for r in self.rows
        ]

    def _repr_html_(self) -> str:
        head, *lines = ([html.escape(cell) for cell in line] for line in self._cells())
        body = "".join("<tr><td>" + "</td><td>".join(line) + "</td></tr>" for line in lines)
        return "<table><thead><tr><th>" + "</th><th>".join(head) + f"</th></tr></thead><tbody>{body}</tbody></table>"

    def __str__(self) -> str:
        return self.table()

    def __repr__(self) -> str:
        return f"<chromeball.Comparison of {', '.join(dict.fromkeys(row.strategy for row in self.rows))}>"


def _pdf_text(row: ComparisonRow) -> str:
    if not row.degrees_of_freedom:
        return "not tested"
    if row.mismatch > 0.01:
        return f"WRONG: pdf() is not sample()'s in {100 * row.mismatch:.3g}%"
    return f"{'WRONG' if row.p_value < _WRONG else 'right'}: p = {row.p_value:.2g}"


def compare(
    scene: SceneLike,
    probe: ProbeLike = None,
    strategies: Iterable[Any] = ("uniform", "importance"),
    camera: Camera | None = None,
    *,
    samples: Iterable[int] = (1, 4, 16, 64),
    repeats: int = 8,
    seed: int = 0,
    reference: Any = None,
    reference_samples: int | None = None,
    progress: Progress = None,
    **settings: Any,
) -> Comparison:
    """Renders each strategy `repeats` times with each number of samples, and measures error, bias and time.

    strategies: names, also with modes ("importance+denoise"; docs/methods.md), and objects with sample() and pdf(), whose
    pdf is tested too. reference: a Result (its layer "variance" is heeded) or an array [H,W,3]; None: rendered by
    "importance" with `reference_samples` (16 times the most samples, at least 1024) and other seeds. Other arguments as of
    render().

    Definitions, seeds and images are those of `chromeball compare`: the same settings give the same errors.
    """
    counts = _counts("samples", samples)
    if repeats < _core.MIN_REPEATS:
        raise InputError(f"compare(): repeats is {repeats}; it should be {_core.MIN_REPEATS} or more")
    callback = _callback(progress)
    study = _Renders(scene, probe, camera, settings, seed)
    names = study.add(strategies)
    for name in names:
        study.render(name, counts[0], 0)  # the first render of a strategy is slow
    if reference is None:
        (total,) = _counts("reference_samples", [max(1024, 16 * counts[-1]) if reference_samples is None else reference_samples])
        truth, squared_error = study.reference(total)
    else:
        truth, squared_error = _given(reference)
    tests = {name: study.test(name) for name in names}
    rows: dict[tuple[str, int], ComparisonRow] = {}
    lights: list[tuple[str, Any, float]] = []  # with the most samples
    of_reference = 0.0
    for i, count in enumerate(counts):
        images: dict[str, list[Any]] = {name: [] for name in names}
        seconds = dict.fromkeys(names, 0.0)
        # Strategies alternate, so that a machine whose speed drifts does not favour any of them.
        for repeat in range(repeats):
            for name in names:
                color, time = study.render(name, count, repeat)
                images[name].append(color)
                seconds[name] += time / repeats
            if callback:
                callback("compare", (i + (repeat + 1) / repeats) / len(counts))
        for name in names:
            if images[name][0].shape != truth.shape:
                raise InputError(f"reference: has the shape {list(truth.shape)}; it should be {list(images[name][0].shape)}")
            errors = _core.errors_of(images[name], truth, squared_error, study.row(name))
            rows[name, count] = _row(name, count, errors, seconds[name], tests[name])
            of_reference = max(of_reference, errors[4] / errors[0][0] if errors[0][0] > 0 else math.inf)
            if count == counts[-1]:
                lights.append((name, errors[5], rows[name, count].bias))
    for text in _core.light_warnings(lights, reference is not None):
        warnings.warn(text, RenderWarning, stacklevel=2)
    if of_reference > 0.1:
        warnings.warn(f"the variance of the reference is {100 * of_reference:.0f}% of a relMSE; it has been subtracted, but "
                      "intervals are wide: give more reference_samples", RenderWarning, stacklevel=2)
    return Comparison([rows[name, count] for name in names for count in counts], truth)


class _Renders:
    """Renders of one scene by many strategies, which is loaded once."""

    def __init__(self, scene: SceneLike, probe: ProbeLike, camera: Camera | None, settings: dict[str, Any],
                 seed: int) -> None:
        self._scene, self._probe, self._camera = scene, probe, camera
        self._settings = settings
        self._seed = _values.whole("seed", seed, 0, 2**64 - 1)
        self._strategies: dict[str, Any] = {}
        self._plans: dict[str, Any] = {}
        self._session: Any = None

    def add(self, strategies: Iterable[Any]) -> list[str]:
        """The names of the rows."""
        if isinstance(strategies, str) or not isinstance(strategies, Iterable):
            raise InputError("compare(): strategies should be a list of names, and objects with sample() and pdf()")
        for strategy in strategies:
            if isinstance(strategy, str):
                name = _core.row_name(strategy)
                if name in self._strategies:
                    raise InputError(f"compare(): `{name}` is given twice")
                self._add(name, strategy, {})
                continue
            own = getattr(strategy, "name", None)
            name = first = own if isinstance(own, str) else type(strategy).__name__
            number = 1
            while name in self._strategies or name == _core.REFERENCE:
                number += 1
                name = f"{first} {number}"
            self._add(name, strategy, {"strategy": strategy})
        if not self._strategies:
            raise InputError("compare(): there are no strategies")
        return list(self._strategies)

    def _add(self, name: str, strategy: Any, given: dict[str, Any]) -> None:
        self._strategies[name] = strategy
        self._plans[name] = self._plan(given)

    def _plan(self, given: dict[str, Any]) -> Any:
        return _plan("compare()", self._scene, self._probe, self._camera, {**self._settings, **given}, is_compared=True)

    def row(self, name: str) -> str:
        """The name for the library; empty for a strategy of Python's."""
        return name if isinstance(self._strategies[name], str) else ""

    def render(self, name: str, samples: int, repeat: int, row: str = "") -> tuple[Any, float]:
        """The colour [H,W,3], and the seconds."""
        import numpy as np

        seed = _core.seed_of(name, samples, repeat, self._seed)
        plan = _core.render_of(self._plans[name], row or self.row(name), samples, seed)
        if self._session is None:
            self._session = _core.Session(plan, None)
        else:
            self._session.update(plan)
        self._session.start()
        image = Result(self._session.wait())
        return np.array(image.color), image.stats["seconds"]["render"]

    def reference(self, samples: int) -> tuple[Any, Any]:
        """The mean of independent parts, and its squared standard error."""
        import numpy as np

        self._plans[_core.REFERENCE] = self._plan({})
        parts = _core.REFERENCE_PARTS
        images = [self.render(_core.REFERENCE, -(-samples // parts), part, "auto")[0].astype(float) for part in range(parts)]
        mean, variance = np.mean(images, 0), np.var(images, 0, ddof=1)
        return mean.astype(np.float32), (variance / parts).astype(np.float32)

    def test(self, name: str) -> ChiSquare | None:
        """The test of the pdf; None for built-in strategies that have none: of lights, or of several samples."""
        strategy = self._strategies[name]
        if not isinstance(strategy, str):
            return chi_square(strategy, seed=self._seed)
        probe = self._probe
        if isinstance(probe, (str, os.PathLike)):
            with warnings.catch_warnings():
                warnings.simplefilter("ignore", RenderWarning)  # the renders have them
                probe = Probe(probe, self._settings.get("probe_mapping", "auto"))
        if probe is None:
            return None
        try:
            built = Strategy(name.split("+")[0], probe, mis=self._settings.get("mis") != "off")
            return chi_square(built, seed=self._seed)
        except InputError:
            return None


def _row(name: str, count: int, errors: Any, seconds: float, test: ChiSquare | None) -> ComparisonRow:
    relmse, variance, squared_bias, bias, _, light = errors
    missed = light == _core.FoundLight.MISSED
    work = math.nan if missed else relmse[0] * seconds
    return ComparisonRow._make([
        name, count, math.sqrt(relmse[0]) if relmse[0] >= 0 else math.nan, *relmse, *variance, *squared_bias, *bias,
        bias[0] / bias[1] if bias[1] > 0 else math.nan, missed, seconds, 1 / work if work > 0 else math.nan,
        *((*test[:3], test.mismatch) if test and test.degrees_of_freedom else (math.nan, 0, math.nan, math.nan))])


def _counts(name: str, values: Iterable[int]) -> list[int]:
    """In ascending order, without repetition."""
    import operator

    try:
        counts = sorted({operator.index(value) for value in values})
    except TypeError:
        raise InputError(f"{name}: {values!r} should be whole numbers") from None
    least = _core.REFERENCE_PARTS if name == "reference_samples" else 1
    if not counts or not least <= counts[0] <= counts[-1] < 2**31:
        raise InputError(f"{name}: {counts} should be {least} or more")
    return counts


def _given(reference: Any) -> tuple[Any, Any]:
    """The colour of a reference, and its squared standard error, which may be unknown."""
    squared_error = None
    if isinstance(reference, Result):
        squared_error = reference.layers.get("variance")
        reference = reference.layers.get("noisy", reference.color)  # what is denoised is biased
    truth = _arrays.finite("reference", reference, ("H", "W", 3))
    if (truth < 0).any():
        raise InputError("reference: has negative radiance")
    return truth, squared_error if squared_error is not None and squared_error.shape == truth.shape else None
