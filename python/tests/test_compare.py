# SPDX-License-Identifier: Apache-2.0
"""Comparisons of strategies, and the chi-square test of their pdfs."""

import builtins
import csv
import math
import resource
import signal
import subprocess

import numpy as np
import pytest
from conftest import PROJECT, sky, square_scene

import chromeball as cb

SIZE = {"size": (24, 16)}


class Uniform:
    """Directions of the whole sphere; `height` is that of the lowest, `factor` spoils the pdf."""

    def __init__(self, probe, height=-1.0, factor=1.0):
        self.probe, self.height, self.factor = probe, height, factor

    def sample(self, points, u):
        y = self.height + (1 - self.height) * u[:, 0]
        phi, r = 2 * np.pi * u[:, 1], np.sqrt(1 - y * y)
        directions = np.stack([r * np.cos(phi), y, r * np.sin(phi)], axis=-1)
        return directions, self.probe.radiance(directions), self.pdf(directions)

    def pdf(self, directions):
        return np.full(len(directions), self.factor / (4 * np.pi))


class Cosine:
    """Directions around the normal; `factor` spoils the pdf."""

    def __init__(self, factor=1.0):
        self.factor = factor

    def sample(self, points, u):
        n, s, phi = points.normals, np.sqrt(u[:, 0]), 2 * np.pi * u[:, 1]
        x = np.cross(np.where(np.abs(n[:, :1]) > 0.5, [[0, 1, 0]], [[1, 0, 0]]), n)
        x /= np.linalg.norm(x, axis=1, keepdims=True)
        z = np.sqrt(1 - u[:, 0])
        directions = (s * np.cos(phi))[:, None] * x + (s * np.sin(phi))[:, None] * np.cross(n, x) + z[:, None] * n
        return directions, np.ones_like(directions), self.factor * z / np.pi

    def pdf(self, directions, points):
        return self.factor * np.maximum((directions * points.normals).sum(1), 0) / np.pi


def sunny(height=32):
    """A sky with a sun of one texel, whose edges no bin has."""
    probe = sky(height)
    probe[height // 5, height // 3] = 300
    return cb.Probe(probe)


@pytest.mark.parametrize("strategy", ["importance", "product", "uniform"])
def test_built_in_strategies_have_their_pdf(strategy):
    test = cb.chi_square(cb.Strategy(strategy, sunny().rotated((30, 20, 0)), mis=False), samples=30_000)
    assert test.p_value > 1e-4 and test.degrees_of_freedom > 40
    assert test.total == pytest.approx(1, abs=1e-3) and test.mismatch < 0.01


def test_p_values_of_a_right_strategy_are_uniform():
    p = np.sort([cb.chi_square(Uniform(sunny()), samples=10_000, seed=seed).p_value for seed in range(10)])
    # Kolmogorov and Smirnov's distance; above 0.58 in one of 1000 cases.
    assert np.abs(p - (np.arange(10) + 0.5) / 10).max() < 0.53


@pytest.mark.parametrize("strategy, total", [
    (lambda p: Uniform(p, factor=1.1), 1.1),
    (lambda p: Uniform(p, factor=0.9), 0.9),
    (lambda p: Uniform(p, height=-0.8), 1),
    (lambda p: Uniform(p, height=-0.98), 1),
    (lambda p: Cosine(1.1), 1.1),
], ids=["too high", "too low", "misses a part", "misses a small part", "depends on points"])
def test_wrong_pdfs_are_caught(strategy, total):
    test = cb.chi_square(strategy(sunny()), samples=400_000 if total == 1 else 30_000)
    assert test.p_value < 1e-4 and test.total == pytest.approx(total, rel=1e-3)


def test_points_are_tested_where_samples_depend_on_them():
    one, several = cb.chi_square(Uniform(sunny())), cb.chi_square(Cosine(), samples=30_000)
    assert one.degrees_of_freedom == 24 * 48 - 1
    assert several.p_value > 1e-4 and several.degrees_of_freedom > 24 * 48
    given = cb.chi_square(Cosine(), cb.Points(None, [(0, 1, 0)]), samples=30_000)
    assert given.p_value > 1e-4 and given.degrees_of_freedom < 24 * 48 * 0.6  # above the horizon


def test_a_pdf_of_samples_that_is_another_than_that_of_pdf_is_seen():
    class Torn(Uniform):
        def sample(self, points, u):
            directions, radiance, pdf = super().sample(points, u)
            return directions, radiance, 1.5 * pdf

    assert cb.chi_square(Torn(sunny()), samples=1000).mismatch == 1
    assert cb.chi_square(Uniform(sunny()), samples=1000).mismatch == 0


@pytest.fixture(scope="module")
def comparison():
    probe = cb.Probe(sky())
    return cb.compare(square_scene(), probe, ["importance", "bsdf", Uniform(probe)],
                      cb.Camera.look_at((0, 2, 2), (0, 0, 0), fov=40), samples=[1, 4], repeats=4, seed=3,
                      reference_samples=1024, **SIZE)


def test_rows(comparison):
    rows = comparison.rows
    assert [(r.strategy, r.samples) for r in rows] == [(s, n) for s in ("importance", "bsdf", "Uniform") for n in (1, 4)]
    for r in rows:
        assert r.relmse == pytest.approx(r.variance + r.squared_bias) and r.rmse == pytest.approx(math.sqrt(r.relmse))
        assert abs(r.bias_z) < 5 and r.bias_z == pytest.approx(r.bias / r.bias_error)
        assert r.efficiency == pytest.approx(1 / (r.relmse * r.seconds))
    assert rows[5].variance < rows[4].variance
    assert rows[0].p_value > 1e-4 and rows[4].p_value > 1e-4
    assert rows[2].degrees_of_freedom == 0 and math.isnan(rows[2].p_value)  # of BSDFs alone
    assert comparison.reference.shape == (16, 24, 3)


def test_the_same_seed_gives_the_same_rows(comparison):
    probe = cb.Probe(sky())
    arguments = (square_scene(), probe, ["importance", "bsdf", Uniform(probe)],
                 cb.Camera.look_at((0, 2, 2), (0, 0, 0), fov=40))
    again = cb.compare(*arguments, samples=[4, 1], repeats=4, seed=3, reference_samples=1024, **SIZE)
    other = cb.compare(*arguments, samples=[1, 4], repeats=4, seed=4, reference_samples=1024, **SIZE)

    def errors(comparison):
        return [row._replace(seconds=0, efficiency=0) for row in comparison.rows if row.strategy != "bsdf"]

    assert errors(again) == errors(comparison) and errors(other) != errors(comparison)


def test_the_numbers_of_the_command(command, tmp_path):
    model, probe = PROJECT / "scenes" / "models" / "still-life.glb", PROJECT / "probes" / "dusk.exr"
    strategies = ["importance", "median-cut:16", "importance+regularize", "importance+denoise"]
    subprocess.run([command, "compare", model, "--probe", probe, "--strategies", ",".join(strategies), "--samples", "2,4",
                    "--repeats", "3", "--reference-samples", "256", "--size", "24x16", "--seed", "5", "-o", "report"],
                   check=True, capture_output=True)
    with open("report/results.csv") as file:
        expected = {(r["strategy"], int(float(r["samples"]))): r for r in csv.DictReader(file)}
    found = cb.compare(str(model), probe, strategies, samples=[2, 4], repeats=3, reference_samples=256, seed=5, **SIZE)
    assert len(found.rows) == len(expected) == 8
    for row in found.rows:
        of_command = expected[row.strategy, row.samples]
        for name in ("relmse", "variance", "squared_bias", "bias"):
            value, error = getattr(row, name), getattr(row, name + "_error")
            assert value == pytest.approx(float(of_command[name]), rel=1e-4, abs=1e-4 * error), (row.strategy, name)
            assert value + 1.96 * error == pytest.approx(float(of_command[name + "_high"]), rel=1e-4, abs=1e-4 * error)


def test_a_wrong_strategy_is_biased_and_wrong():
    probe = cb.Probe(np.ones((8, 16, 3)))
    found = cb.compare(square_scene(), probe, [Uniform(probe, factor=1.1), Uniform(probe, factor=1)],
                       cb.Camera.look_at((0, 2, 2), (0, 0, 0), fov=40), samples=[64], repeats=4, mis="off", **SIZE)
    wrong, right = found.rows
    assert (wrong.strategy, right.strategy) == ("Uniform", "Uniform 2")
    assert wrong.p_value < 1e-4 < right.p_value and abs(wrong.bias_z) > 10 > 2 * abs(right.bias_z)
    assert found.table().count("WRONG") == 1 and found._repr_html_().count("WRONG") == 1


def test_a_given_reference(comparison, scene, camera):
    probe = cb.Probe(sky())
    arguments = dict(samples=[1], repeats=3, **SIZE)
    result = cb.render(scene, probe, camera, samples=256, seed=9, adaptive="off", layers=["variance"], **SIZE)
    with_error = cb.compare(scene, probe, ["importance"], camera, reference=result, **arguments).rows[0]
    without = cb.compare(scene, probe, ["importance"], camera, reference=result.color, **arguments).rows[0]
    assert 0 < with_error.relmse < without.relmse  # the variance of the reference is subtracted
    with pytest.raises(cb.InputError, match=r"reference: has the shape \[2, 2, 3\]; it should be \[16, 24, 3\]"):
        cb.compare(scene, probe, ["importance"], camera, reference=np.ones((2, 2, 3)), **arguments)
    with pytest.warns(cb.RenderWarning, match="reference_samples"):
        cb.compare(scene, probe, ["importance"], camera, reference_samples=8, samples=[16], repeats=3, **SIZE)


def test_tables(comparison, monkeypatch):
    lines = comparison.table().splitlines()
    assert lines[0].split()[:2] == ["strategy", "samples"] and len(lines) == 7
    assert "right: p = " in lines[1] and lines[3].endswith("not tested")
    assert comparison._repr_html_().count("<tr>") == 7
    comparison.save("rows.csv")
    with open("rows.csv") as file:
        rows = list(csv.DictReader(file))
    assert [float(r["relmse"]) for r in rows] == [r.relmse for r in comparison.rows]
    real = builtins.__import__
    monkeypatch.setattr(builtins, "__import__", lambda name, *rest: _absent() if name == "pandas" else real(name, *rest))
    with pytest.raises(cb.InputError, match="pandas is not installed"):
        comparison.frame()


def _absent():
    raise ImportError


def test_frame(comparison):
    pytest.importorskip("pandas")
    frame = comparison.frame()
    assert list(frame.columns) == list(cb.ComparisonRow._fields) and len(frame) == 6
    assert frame["relmse"].tolist() == [row.relmse for row in comparison.rows]


@pytest.mark.parametrize("arguments, expected", [
    (dict(strategies="importance"), "should be a list"),
    (dict(strategies=[]), "no strategies"),
    (dict(strategies=["importants"]), "did you mean `?importance"),
    (dict(strategies=["importance+blur"]), "not a mode"),
    (dict(strategies=["importance", "auto"]), "`importance` is given twice"),
    (dict(strategies=[object()]), "sample.. and pdf"),
    (dict(samples=[0, 1]), r"samples: \[0, 1\] should be 1 or more"),
    (dict(samples=[1.5]), "whole numbers"),
    (dict(repeats=2), "repeats is 2; it should be 3 or more"),
    (dict(reference_samples=4), "8 or more"),
    (dict(denoise=True), "denoise is no setting of a comparison"),
    (dict(strategy="bsdf"), "strategy is no setting of a comparison"),
    (dict(time=3), "time is no setting of a comparison"),
    (dict(sizes=3), "unknown keyword `sizes`"),
])
def test_wrong_comparisons_are_refused(arguments, expected, scene):
    with pytest.raises(cb.InputError, match=expected):
        cb.compare(scene, cb.Probe(sky()), **{"strategies": ["importance"], **arguments})


@pytest.mark.parametrize("call, expected", [
    (lambda s: cb.chi_square(s, samples=0), "samples is 0"),
    (lambda s: cb.chi_square(s, 3), "Points"),
    (lambda s: cb.chi_square(s, cb.Points([(0, 0, 0)] * 2, [(0, 1, 0)])), r"positions: has the shape"),
    (lambda s: cb.chi_square("importance"), "is a str"),
])
def test_wrong_tests_are_refused(call, expected):
    with pytest.raises(cb.InputError, match=expected):
        call(Uniform(sunny()))


@pytest.fixture
def small():
    return square_scene(), cb.Probe(sky())


def test_a_denoised_reference_is_its_noisy_image(small):
    scene, probe = small
    settings = dict(size=(16, 12), samples=[2], repeats=4)
    noisy = cb.render(scene, probe, size=(16, 12), samples=64, layers=["variance"])
    denoised = cb.render(scene, probe, size=(16, 12), samples=64, layers=["variance"], denoise=True)
    of = [cb.compare(scene, probe, ["importance"], reference=r, **settings).rows[0].relmse for r in (noisy, denoised)]
    assert of[0] == pytest.approx(of[1], rel=1e-6)


@pytest.mark.parametrize("reference, expected", [
    (np.full((12, 16, 3), np.nan), "reference.*not finite"), (np.full((12, 16, 3), -1.0), "negative")], ids=["nan", "negative"])
def test_wrong_references_are_refused(reference, expected, small):
    with pytest.raises(cb.InputError, match=expected):
        cb.compare(*small, ["importance"], reference=reference, size=(16, 12), samples=[1], repeats=3)


@pytest.mark.parametrize("seed", [-1, 2**64, 1.5])
def test_wrong_seeds_are_refused(seed, small):
    with pytest.raises(cb.InputError, match="seed"):
        cb.compare(*small, ["importance"], seed=seed, size=(16, 12), samples=[1], repeats=3, reference_samples=32)


def test_a_file_is_complete_or_as_it_was(small, tmp_path):
    comparison = cb.compare(*small, ["importance"], size=(16, 12), samples=[1], repeats=3, reference_samples=32)
    with pytest.raises(cb.InputError, match="must end in .csv"):
        comparison.save(tmp_path / "x.exr")
    comparison.save(tmp_path / "x.csv")
    before = (tmp_path / "x.csv").read_bytes()
    limits = resource.getrlimit(resource.RLIMIT_FSIZE)
    handler = signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
    resource.setrlimit(resource.RLIMIT_FSIZE, (20, limits[1]))
    try:
        with pytest.raises(cb.RunError, match="x.csv"):
            comparison.save(tmp_path / "x.csv")
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, limits)
        signal.signal(signal.SIGXFSZ, handler)
    assert (tmp_path / "x.csv").read_bytes() == before
    assert [f.name for f in tmp_path.iterdir()] == ["x.csv"]


def sunny(height=256):
    """A grainy sky with a sun of a few texels, and of half the light."""
    texels = 0.2 * np.random.default_rng(1).uniform(0.5, 1.5, (height, 2 * height, 1)).repeat(3, 2).astype(np.float32)
    texels[60:62, 101:103] = 0.2 * texels[:, :, 0].size / 4
    return cb.Probe(texels)


@pytest.mark.parametrize("mis", [True, False])
def test_small_suns_of_a_right_pdf_are_found(mis):
    tests = [cb.chi_square(cb.Strategy("importance", sunny(), mis=mis), seed=seed) for seed in range(3)]
    assert all(abs(test.total - 1) < 2e-4 for test in tests)
    assert min(test.p_value for test in tests) > 1e-4


def test_each_point_has_its_own_number_of_samples():
    """Two bins with equal chances at each of ten points: ten degrees of freedom."""

    class TwoBins:
        turns = (np.arange(2) + 0.5) * 2 * np.pi / 48

        def sample(self, points, u):
            turn = (np.floor(2 * u[:, 0]) + u[:, 0] * 2 % 1) * 2 * np.pi / 48
            y = u[:, 1] / 12
            r = np.sqrt(1 - y * y)
            directions = np.stack([r * np.cos(turn), y, r * np.sin(turn)], 1)
            return directions, np.ones((len(u), 3)), self.pdf(directions)

        def pdf(self, directions):
            turn = np.arctan2(directions[:, 2], directions[:, 0]) / (2 * np.pi) % 1
            inside = (turn < 2 / 48) & (directions[:, 1] > 0) & (directions[:, 1] < 1 / 12)
            return np.where(inside, 1 / (2 * 4 * np.pi / (24 * 48)), 0)

    test = cb.chi_square(TwoBins(), cb.Points(None, np.repeat([[0.0, 1, 0]], 10, 0)), samples=1000)
    assert test.degrees_of_freedom == 10
    assert test.p_value > 1e-4


def test_a_pdf_that_is_not_that_of_samples_is_wrong_in_the_table(small):
    class Twice(Uniform):
        def sample(self, points, u):
            directions, radiance, pdf = super().sample(points, u)
            return directions, radiance, 2 * pdf

    scene, probe = small
    comparison = cb.compare(scene, probe, [Twice(probe)], size=(16, 12), samples=[1], repeats=3, reference_samples=32)
    assert comparison.rows[0].mismatch == 1 and "WRONG: pdf() is not sample()'s in 100%" in comparison.table()


def write_pfm(path, texels):
    path.write_bytes(b"PF\n%d %d\n-1.0\n" % texels.shape[1::-1] + texels[::-1].astype("<f4").tobytes())


def test_the_scenes_mapping_holds_for_a_probe_by_its_path(tmp_path):
    texels = np.zeros((64, 64, 3), np.float32)
    y, x = (np.mgrid[0:64, 0:64] + 0.5) / 32 - 1
    texels[x * x + y * y < 1] = (1, 2, 3)
    texels[(x * x + y * y < 1) & (y < 0)] = 9
    scene = square_scene()
    for mapping in ("angular", "mirror-ball"):
        write_pfm(tmp_path / "p.pfm", texels)
        arguments = dict(size=(8, 6), samples=[1], repeats=3, reference_samples=256)
        by_path = cb.compare(scene, str(tmp_path / "p.pfm"), ["uniform"], probe_mapping=mapping, **arguments)
        in_memory = cb.compare(scene, cb.Probe(texels, mapping), ["uniform"], **arguments)
        np.testing.assert_allclose(by_path.reference, in_memory.reference, rtol=1e-5)


def sunlit(strategies, **settings):
    """The comparison, and what is warned of. One of 30,000 samples of `uniform` meets the sun."""
    with pytest.warns(cb.RenderWarning) as warned:
        found = cb.compare(square_scene(), sunny(), strategies, size=(16, 12), repeats=3, **settings)
    return found, " ".join(str(warning.message) for warning in warned)


def test_a_few_bright_samples_are_warned_of():
    _, told = sunlit(["uniform"], samples=[256], reference_samples=32)
    assert "ingle bright samples may make up most of the error of uniform:" in told and "have not found" not in told


def test_light_that_no_sample_has_found_is_no_bias():
    found, told = sunlit(["bsdf", "importance"], samples=[1], reference_samples=256)
    missed, good = found.rows
    assert "The samples of bsdf have not found light that the reference has" in told and "error of bsdf" not in told
    assert missed.missed_light and missed.bias_z < -4 and math.isnan(missed.efficiency) and not good.missed_light
    assert found.table().splitlines()[1].count("(light not found)") == 1


def test_a_wrong_strategy_has_missed_no_light(small):
    scene, probe = small
    found = cb.compare(scene, probe, [Uniform(probe, factor=2)], size=(16, 12), samples=[64], repeats=3, mis="off",
                       reference_samples=64)
    assert found.rows[0].bias_z < -4 and not found.rows[0].missed_light

