# SPDX-License-Identifier: Apache-2.0
"""Probes: closed forms, mappings, turns."""

import json
import subprocess

import numpy as np
import pytest
from conftest import PROJECT, sky

import chromeball as cb

AXES = np.array([[0, 0, -1], [1, 0, 0], [0, 0, 1], [-1, 0, 0], [0, 1, 0], [0, -1, 0]])


def test_a_constant_probe_has_pi_times_its_radiance():
    probe = cb.Probe(np.full((32, 64, 3), [1, 2, 4]))
    np.testing.assert_allclose(probe.irradiance(AXES), np.pi * np.array([[1, 2, 4]] * 6), rtol=1e-4)
    np.testing.assert_allclose(probe.radiance(3 * AXES), [[1, 2, 4]] * 6, rtol=1e-6)


def test_the_middle_shows_minus_z_and_a_quarter_right_of_it_x():
    array = np.zeros((32, 64, 3), np.float32)
    array[:, 28:36, 0] = 2
    array[:, 44:52, 1] = 2
    np.testing.assert_allclose(cb.Probe(array).radiance(AXES[:2]), [[2, 0, 0], [0, 2, 0]], atol=1e-6)


def test_turns():
    probe = cb.Probe(sky())
    turned = probe.rotated(90)  # what was over +X is over -Z
    np.testing.assert_allclose(turned.radiance([[0, 0, -1]]), probe.radiance([[1, 0, 0]]), rtol=1e-5)
    np.testing.assert_allclose(turned.irradiance([[0, 0, -1]]), probe.irradiance([[1, 0, 0]]), rtol=1e-5)
    np.testing.assert_allclose(turned.rotated((0, 20, 30)).rotated(-90).rotated(360).radiance(AXES),
                               probe.rotated((-90, 0, 0)).rotated((90, 0, 0)).rotated((90, 0, 0))
                               .rotated((0, 20, 30)).rotated(-90).radiance(AXES), rtol=1e-4)
    np.testing.assert_allclose(probe.scaled(2).scaled((1, 2, 3)).radiance(AXES),
                               probe.radiance(AXES) * [2, 4, 6], rtol=1e-6)


@pytest.mark.parametrize("mapping, size", [("angular", 128), ("mirror-ball", 256), ("cube-cross", (96, 128)),
                                           ("cube-strip", (64, 384)), ("lat-long", 64)])
def test_every_mapping_comes_back(mapping, size):
    probe = cb.Probe(sky(32))
    there = probe.to(mapping, size)
    back = cb.Probe(there, mapping)
    assert there.dtype == np.float32 and back.mapping == mapping
    directions = np.random.default_rng(1).normal(size=(200, 3))
    directions = directions[directions[:, 2] < 0]  # a ball's rim shows +Z
    error = np.abs(back.radiance(directions) - probe.radiance(directions))
    assert error.mean() < 0.02


def test_sizes_are_whole_numbers_of_any_type():
    probe = cb.Probe(sky())
    assert probe.to("lat-long", np.int64(8)).shape == probe.to("lat-long", np.uint8(8)).shape == (8, 16, 3)
    assert probe.to("cube-cross", (np.int64(24), 32)).shape == (32, 24, 3)
    assert len(probe.lights("median-cut", np.int32(4)).angles) == 4


def test_lights_keep_the_energy_and_turn_with_the_probe():
    probe = cb.Probe(sky()).scaled(2)
    lights = probe.lights("median-cut", 16)
    assert lights.directions.shape == lights.irradiances.shape == (16, 3) and lights.ambient is None
    rows = (np.arange(16) + [[0], [1]]) * np.pi / 16
    weight = (np.cos(rows[0]) - np.cos(rows[1])) * 2 * np.pi / 32
    np.testing.assert_allclose(lights.irradiances.sum(0), 2 * (sky() * weight[:, None, None]).sum((0, 1)), rtol=1e-4)
    turned = probe.rotated(90).lights("median-cut", 16)
    x, y, z = lights.directions.T
    np.testing.assert_allclose(turned.directions, np.stack([z, y, -x], 1), atol=1e-6)
    with pytest.raises(cb.InputError, match="did you mean `?median-cut"):
        probe.lights("median-cat", 16)
    with pytest.raises(cb.InputError, match="needs a count"):
        probe.lights("median-cut")


def test_suns():
    array = np.full((64, 128, 3), 0.01)
    array[20, 70:72] = 3000
    suns = cb.Probe(array).suns()
    assert len(suns.directions) == 1 and suns.angles[0] > 0
    assert np.argmax(cb.Probe(array).radiance(suns.directions)[0]) == 0
    assert len(cb.Probe(sky()).suns().directions) == 0


def test_files():
    probe = cb.Probe(PROJECT / "probes" / "dusk.exr")
    assert probe.size[0] == 2 * probe.size[1] and probe.radiance(AXES).max() > 0
    with pytest.raises(cb.InputError, match="no such file|nothing.exr"):
        cb.Probe("nothing.exr")
    with pytest.raises(cb.InputError, match="did you mean `?angular"):
        cb.Probe(sky(), "angle")


@pytest.mark.parametrize("call", [
    lambda p: p.radiance([0, 0, 1]),
    lambda p: p.radiance([[0, 0, 0]]),
    lambda p: p.irradiance([[0, np.nan, 1]]),
    lambda p: p.rotated((1, 2)),
    lambda p: p.rotated(np.inf),
    lambda p: p.rotated((1, 2, 3, 4)),
    lambda p: p.scaled(-1),
    lambda p: p.scaled("plate"),
    lambda p: p.to("cube"),
    lambda p: p.to("angular", (3, 5)),
    lambda p: p.to("angular", 0),
    lambda p: p.to("angular", 2**31),
    lambda p: p.to("angular", 8.0),
    lambda p: p.to("cube-cross", (48, 64.0)),
    lambda p: p.to("\ud800"),
    lambda p: p.to(5),
    lambda p: p.lights("median-cut", 2**31),
    lambda p: p.lights("median-cut", 2.5),
    lambda p: p.lights("median-cut", 4, seed=-1),
    lambda p: p.lights("\ud800", 4),
    lambda p: p.rotated([[1], [1, 2]]),
    lambda p: cb.Probe("\ud800"),
    lambda p: cb.Probe(sky(), "\ud800"),
    lambda p: cb.Strategy("\ud800", p),
    lambda p: cb.keywords("\ud800"),
])
def test_wrong_arguments_are_refused(call):
    with pytest.raises(cb.InputError):
        call(cb.Probe(sky()))


def test_jpeg_tiff_with_unassociated_alpha_is_refused(command):
    image = pytest.importorskip("PIL.Image")  # writes them; the module itself reads no TIFF
    texels = np.zeros((32, 64, 4), np.uint8)
    texels[..., :3], texels[..., 3] = (200, 150, 100), 128
    image.fromarray(texels).save("jpeg.tif", compression="jpeg")
    image.fromarray(texels).save("lzw.tif", compression="tiff_lzw")

    def info(file):
        return subprocess.run([command, "probe", "info", "--json", file], capture_output=True, text=True)

    refused = info("jpeg.tif")
    assert refused.returncode == 2
    assert "alpha is unassociated and its compression JPEG" in refused.stderr
    red = ((200 / 255 + 0.055) / 1.055) ** 2.4 * 128 / 255
    assert json.loads(info("lzw.tif").stdout)["mean"][0] == pytest.approx(red, rel=1e-3)
