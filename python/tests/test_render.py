# SPDX-License-Identifier: Apache-2.0
"""render(): bits of the command, keywords, results."""

import gc
import json
import math
import subprocess
import sys
import warnings

import numpy as np
import pytest
from conftest import PROJECT, SQUARE, TWO, sky, square_scene

import chromeball as cb

MODEL = PROJECT / "scenes" / "models" / "still-life.glb"
PROBE = PROJECT / "probes" / "dusk.exr"
SCENE = f"""
model = "{MODEL}"
[probe]
file = "{PROBE}"
rotation = 40
[render]
size = [32, 24]
samples = 16
"""


def pfm(path):
    with open(path, "rb") as file:
        assert file.readline() == b"PF\n"
        width, height = map(int, file.readline().split())
        assert float(file.readline()) < 0
        return np.fromfile(file, "<f4").reshape(height, width, 3)[::-1]


def test_the_same_bits_as_the_command(command, tmp_path):
    (tmp_path / "scene.toml").write_text(SCENE)
    arguments = ["--seed", "3", "--strategy", "importance", "--max-depth", "3"]
    subprocess.run([command, "render", "scene.toml", "-o", "command.pfm", *arguments], check=True)
    expected = pfm("command.pfm")
    settings = dict(seed=3, strategy="importance", max_depth=3)
    assert np.array_equal(cb.render("scene.toml", **settings).color, expected)
    as_dict = {"model": MODEL, "probe": {"file": PROBE, "rotation": 40}, "render": {"size": (32, 24), "samples": 16}}
    assert np.array_equal(cb.render(as_dict, **settings).color, expected)
    settings.update(size=np.array([32, 24]), samples=np.int64(16))
    scene, probe = cb.load(MODEL), cb.Probe(PROBE)
    assert np.array_equal(cb.render(scene, probe.rotated(40), **settings).color, expected)
    assert not np.array_equal(cb.render(scene, probe, **settings).color, expected)
    # The scene is loaded already; the probe turns.
    assert np.array_equal(cb.render(scene, probe, probe_rotation=40, **settings).color, expected)


def rendered_by(command, *arguments):
    """The command's picture, and what it says."""
    done = subprocess.run([command, "render", *arguments, "-o", "command.pfm"], capture_output=True, text=True, check=True)
    return pfm("command.pfm"), done.stderr


def write_pfm(path, array):
    height, width = array.shape[:2]
    with open(path, "wb") as file:
        file.write(b"PF\n%d %d\n-1.0\n" % (width, height) + array[::-1].astype("<f4").tobytes())


def test_a_probe_by_its_path_is_the_commands_option(command, tmp_path):
    write_pfm("other.pfm", sky())
    (tmp_path / "scene.toml").write_text(SCENE.replace("rotation = 40", "rotation = 40\nscale = 2"))
    (tmp_path / "keys.toml").write_text(SCENE.replace("rotation = 40", "rotation_keys = [[0, 0], [1, 90]]"))
    for scene, options, settings in [
        ("scene.toml", [], {}),
        ("scene.toml", ["--probe-rotation", "10"], dict(probe_rotation=10)),
        ("scene.toml", ["--probe-mapping", "cube-cross"], dict(probe_mapping="cube-cross")),
        ("keys.toml", ["--animation-time", "0.5"], dict(animation_time=0.5)),
    ]:
        if "cube-cross" in options:
            write_pfm("other.pfm", cb.Probe(sky()).to("cube-cross", (24, 32)))
        expected, _ = rendered_by(command, scene, "--probe", "other.pfm", *options)
        image = cb.render(scene, "other.pfm", **settings)
        assert np.array_equal(image.color, expected)
        assert image.metadata["probe"].endswith("other.pfm") and "other.pfm" in image.metadata["files"]
        assert str(PROBE) not in image.metadata["files"]
    with pytest.raises(cb.InputError, match=r"render\(\): `probe`: nothing.pfm: no such file"):
        cb.render("scene.toml", "nothing.pfm")
    with pytest.raises(cb.InputError, match="did you mean `?cube-cross"):
        cb.render("scene.toml", "other.pfm", probe_mapping="cube-cros")


def test_notes_on_a_probes_file_are_the_commands(command):
    ball = cb.Probe(sky(32)).to("mirror-ball", 64)
    write_pfm("ball.pfm", ball)
    _, said = rendered_by(command, MODEL, "--probe", "ball.pfm", "--size", "8x6", "--samples", "2")
    note = next(line for line in said.splitlines() if "detected as an angular" in line).removeprefix("chromeball: ")
    assert ("note", note) in cb.render(cb.load(MODEL), "ball.pfm", size=(8, 6), samples=2).messages
    assert ("note", note) in cb.Probe("ball.pfm").rotated(3).messages
    assert cb.Probe("ball.pfm", "mirror-ball").messages == []


TURNS = [((30, 20, 10), (-70, 5, 60)), (50, 40), ((0, 90, 0), 90)]


@pytest.mark.parametrize("own, around", TURNS)
def test_the_turn_and_scale_of_a_probe_go_with_those_of_the_scene(own, around, scene, camera, small):
    probe = cb.Probe(sky())
    placed = probe.rotated(own).scaled((1, 2, 3))
    expected = cb.render(scene, probe.rotated(own).rotated(around).scaled((0.5, 1, 1.5)), camera, **small).color
    by_keywords = cb.render(scene, placed, camera, probe_rotation=around, probe_scale=0.5, **small)
    np.testing.assert_allclose(by_keywords.color, expected, rtol=1e-5)
    for turn in (dict(rotation=around), dict(rotation_keys=[[0, around]])):
        by_scene = cb.Scene(probe={"scale": 0.5, **turn})
        by_scene.add_mesh(SQUARE, TWO, material=cb.Material(base_color=(0.5, 0.4, 0.3), specular=0))
        assert np.array_equal(cb.render(by_scene, placed, camera, **small).color, by_keywords.color)
    session = cb.Session(scene, placed, camera, **small)
    session.start().wait()
    session.update(probe_rotation=around)
    image = session.start().wait()
    assert not session.work["loaded_probe"] and not session.work["loaded_scene"]
    np.testing.assert_allclose(image.color, 2 * expected, rtol=1e-4)


@pytest.mark.parametrize("own, around", TURNS)
def test_the_probe_is_turned_by_itself_and_then_by_the_scene(own, around, camera):
    """The camera sees in a direction d what the probe's image has at own^-1 around^-1 d."""
    view = cb.Camera.look_at((0, 50, 0), (0, 100, 0), up=(0, 0, -1), fov=5)  # up, past the square
    with pytest.warns(cb.RenderWarning, match="no surface is in view"):
        image = cb.render(square_scene(), cb.Probe(sky(64)).rotated(own), view, probe_rotation=around, size=(3, 3),
                          samples=64, adaptive="off")

    def matrix(turn):
        yaw, pitch, roll = np.radians(turn if np.ndim(turn) else (turn, 0, 0))
        c, s = np.cos, np.sin
        return (np.array([[c(yaw), 0, s(yaw)], [0, 1, 0], [-s(yaw), 0, c(yaw)]])
                @ np.array([[1, 0, 0], [0, c(pitch), -s(pitch)], [0, s(pitch), c(pitch)]])
                @ np.array([[c(roll), -s(roll), 0], [s(roll), c(roll), 0], [0, 0, 1]]))

    there = matrix(own).T @ matrix(around).T @ [0, 1, 0]
    np.testing.assert_allclose(image.color[1, 1], cb.Probe(sky(64)).radiance([there])[0], rtol=0.03)


def test_a_mapping_is_not_for_a_probe_in_memory(scene, camera, small, tmp_path):
    with pytest.raises(cb.InputError, match=r"render\(\): probe_mapping: the probe is in memory"):
        cb.render(scene, cb.Probe(sky()), camera, probe_mapping="angular", **small)
    (tmp_path / "scene.toml").write_text(SCENE.replace("rotation = 40", 'mapping = "lat-long"'))
    with pytest.warns(cb.RenderWarning, match=r"scene.toml:5: `probe.mapping` has no effect .*the probe is in memory"):
        cb.render("scene.toml", cb.Probe(sky()))


def test_seeds_and_repeats(scene, camera, small):
    probe = cb.Probe(sky())
    first = cb.render(scene, probe, camera, seed=1, **small).color
    assert np.array_equal(cb.render(square_scene(), probe, camera, seed=1, **small).color, first)
    assert np.array_equal(cb.render(scene, probe, camera, seed=1, **{**small, "threads": 1}).color, first)
    assert not np.array_equal(cb.render(scene, probe, camera, seed=2, **small).color, first)


def test_a_matte_square_has_the_radiance_of_its_irradiance(camera):
    probe = cb.Probe(sky())
    image = cb.render(square_scene(), probe, camera, size=(16, 16), samples=512, max_depth=1)
    expected = probe.irradiance([[0, 1, 0]])[0] * [0.5, 0.4, 0.3] / np.pi
    np.testing.assert_allclose(image.color[7:9, 7:9].mean((0, 1)), expected, rtol=0.03)


@pytest.mark.parametrize("settings, expected", [
    (dict(sampels=4), r"render\(\): unknown keyword `sampels`; did you mean `?samples"),
    (dict(samples="many"), r"`samples` must be a whole number"),
    (dict(samples=-1), r"`samples` must be a whole number"),
    (dict(samples=2**70), r"`samples` must be a whole number"),
    (dict(samples=True), r"`samples` must be a whole number"),
    (dict(time=float("nan")), r"`time` must be"),
    (dict(size=(10,)), r"`size` must be"),
    (dict(strategy="importanse"), r"did you mean `?importance"),
    (dict(layers=["deph"]), r"did you mean `?depth"),
    (dict(denoise="yes"), r"`denoise` must be"),
    (dict(samples=object()), r"samples: is of the type object"),
    (dict(output="a.exr"), r"unknown keyword `output`"),
    (dict(noise_map="a.png"), r"unknown keyword `noise_map`; it is an option of the command alone"),
    (dict(plate="a.png"), r"unknown keyword `plate`; it is a key of \[composite\]: give it in the scene"),
    (dict(ground_height=1), r"unknown keyword `ground_height`; it is a key of"),
    (dict(visible=False), r"it is a key of \[\[light\]\]"),
    (dict(fps=30), r"render\(\): fps: needs frames or a shutter; see shutter"),
    (dict(crop=(0, 0, 4)), r"crop: \(0, 0, 4\) should be \(x, y, width, height\)"),
    (dict(crop=(0, 0, 4, 2.5)), r"crop: 2.5 should be a whole number"),
    (dict(strategy="\ud800"), r"strategy: '.ud800' is no valid text"),
    (dict(scene={"model": "\ud800"}), r"scene.model: '.ud800' is no valid text"),
    (dict(scene={"\ud800": 1}), r"scene: a key: '.ud800' is no valid text"),
    (dict(scene="\ud800"), r"scene: '.ud800' is no valid text"),
    (dict(probe="\ud800"), r"probe: '.ud800' is no valid text"),
    (dict(probe=cb.Probe(np.ones((4, 8, 3))).scaled(1e30), probe_scale=1e30), r"the array: its scale times that"),
    (dict(progress="bar"), r"progress: is a str"),
    (dict(camera="Front"), r"camera is a str"),
    (dict(probe=3), r"probe is a int"),
    (dict(scene=3), r"scene is a int"),
    (dict(scene=cb.Scene()), r"has no models, and no meshes"),
    (dict(scene={"modell": "a.glb"}), r"scene: unknown key `modell`; did you mean `?model"),
    (dict(scene={"render": {"sampels": 3}}), r"scene: unknown key `sampels` in \[render\]; did you mean `?samples"),
    (dict(scene="nothing.toml"), r"nothing.toml"),
    (dict(probe=None), r"nothing lights the scene; it needs a probe"),
])
def test_wrong_arguments_are_refused_by_name(settings, expected, scene, camera):
    arguments = {"scene": scene, "probe": cb.Probe(sky()), "camera": camera, "size": (8, 8), "samples": 2, **settings}
    with pytest.raises(cb.InputError, match=expected):
        cb.render(**arguments)
    assert cb.render(scene, cb.Probe(sky()), size=(8, 8), samples=2).is_complete


def test_a_list_that_contains_itself_is_refused(scene):
    endless = []
    endless.append(endless)
    with pytest.raises(cb.InputError, match="nested"):
        cb.render(scene, layers=endless)


def test_every_keyword_has_a_meaning():
    names = cb.keywords()
    assert {"samples", "size", "strategy", "probe_rotation", "max_depth", "transparent", "threads"} <= set(names)
    assert not {"output", "checkpoint", "frames", "noise_map", "camera", "plate", "type", "visible"} & set(names)
    assert all(len(cb.keywords(name)) > 20 for name in names)
    assert "1 to" in cb.keywords("samples") and "depth" in cb.keywords("layers")


def test_results(scene, camera, small):
    image = cb.render(scene, cb.Probe(sky()), camera, layers=["depth", "normal"], transparent=True, **small)
    assert image.color.shape == (16, 24, 4) and image.color.dtype == np.float32
    assert not image.color.flags.writeable and image.color.flags.c_contiguous
    assert np.shares_memory(image.color, image.color)
    depth = image.layers["depth"]
    assert depth.shape == (16, 24)
    np.testing.assert_allclose(depth[8, 12], math.sqrt(8), rtol=0.1)
    np.testing.assert_allclose(image.layers["normal"][8, 12], [0, 1, 0], atol=1e-3)
    assert image.color[8, 12, 3] == 1 and image.color[0, 0, 3] == 0
    assert image.stats["samples_per_pixel"] == 16 and image.stats["rays"]["camera"] > 0
    assert 0 < image.noise < 1 and image.samples == pytest.approx(16, rel=0.1) and image.is_complete
    assert image.metadata["max-depth"] == 8
    color, layer = image.color, image.layers["depth"]
    first = color.copy(), layer.copy()
    del image, depth
    gc.collect()
    assert np.array_equal(color, first[0]) and np.array_equal(layer, first[1])


def test_other_libraries_see_the_same_numbers(scene, camera, small):
    image = cb.render(scene, cb.Probe(sky()), camera, **small)
    shared = np.from_dlpack(image)
    assert np.array_equal(shared, image.color) and np.shares_memory(shared, image.color)
    assert np.shares_memory(np.asarray(image), image.color)
    assert np.asarray(image, np.float64).dtype == np.float64


def test_files_and_pictures(scene, camera, small, tmp_path):
    image = cb.render(scene, cb.Probe(sky()), camera, layers=["depth"], **small)
    for name in ("a.exr", "a.hdr", "a.pfm", "a.png"):
        image.save(tmp_path / name)
        assert (tmp_path / name).stat().st_size > 100
    assert np.array_equal(pfm("a.pfm"), image.color)
    assert image._repr_png_() == (tmp_path / "a.png").read_bytes()
    assert image.png(exposure=3) != image.png(exposure=0) and image.png(exposure="auto") == image.png()
    with pytest.raises(cb.InputError, match=".exr"):
        image.save("a.gif")
    with pytest.raises(cb.InputError, match="did you mean `?exposure"):
        image.png(exposur=1)
    for unheard in (dict(samples=4), dict(develop="vignette=0.4")):
        with pytest.raises(cb.InputError, match=r"png\(\): unknown keyword"):
            image.png(**unheard)
        with pytest.raises(cb.InputError, match=r"save\(\): unknown keyword"):
            image.save("a.png", **unheard)
    with pytest.raises(cb.InputError, match=r"save\(\): '.ud800.png' is no valid text"):
        image.save("\ud800.png")
    with pytest.raises((cb.RunError, cb.InputError)):
        image.save("no/such/folder.exr")


def test_warnings_are_pythons(scene, camera, small):
    with pytest.warns(cb.RenderWarning, match="is black"):
        cb.Probe(np.zeros((8, 16, 3)))
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        cb.render(scene, cb.Probe(sky()), camera, **small)


def warnings_of(*arguments, **settings):
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        image = cb.render(*arguments, **settings)
    assert all(w.category is cb.RenderWarning and w.filename == __file__ for w in caught)
    texts = [str(w.message) for w in caught]
    assert texts == [text for kind, text in image.messages if kind == "warning"]
    return texts


def test_warnings_about_the_picture_are_the_commands(command, scene, camera, small):
    """What spoils a picture is said as the command says it, with keywords in place of options."""
    size = ["--size", "32x24", "--samples", "16", "--probe", PROBE]
    for options, settings, begin in [
        (["--max-depth", "0"], dict(max_depth=0), "--max-depth 0 cut about"),
        (["--max-specular-depth", "0"], dict(max_specular_depth=0), "--max-specular-depth 0 cut about"),
        (["--clamp", "0.1"], dict(clamp=0.1), "--clamp scaled"),
    ]:
        _, said = rendered_by(command, MODEL, *size, *options)
        lines = [line.removeprefix("chromeball: warning: ") for line in said.splitlines() if "warning" in line]
        assert any(line.startswith(begin) for line in lines), said
        texts = warnings_of(cb.load(MODEL), PROBE, size=(32, 24), samples=16, **settings)
        keyword, value = next(iter(settings.items()))
        by_option = {f"--{keyword.replace('_', '-')} {value}": f"{keyword}={value}",
                     f"--{keyword.replace('_', '-')}": keyword}
        for option, word in by_option.items():
            lines = [line.replace(option, word) for line in lines]
        assert texts == lines
    away = cb.Camera.look_at((0, 5, 0), (0, 50, 1), fov=20)
    assert warnings_of(scene, cb.Probe(sky()), away, **small) == ["no surface is in view; try another camera"]
    black = cb.Probe(sky()).scaled(0)
    assert warnings_of(scene, black, camera, **small)[0].startswith("100% of the visible surfaces are black")
    notes = cb.render(scene, cb.Probe(sky()), camera, size=(24, 16), samples=4, noise=0.01).messages
    assert any(kind == "note" and "the noise is" in text and text.endswith("see samples") for kind, text in notes)


def test_a_crop_is_text_or_numbers(scene, camera, small):
    small["adaptive"] = "off"
    whole = cb.render(scene, cb.Probe(sky()), camera, **small).color
    for crop in ("3,2,5,4", (3, 2, 5, 4), [3, 2, 5, 4], np.array([3, 2, 5, 4])):
        image = cb.render(scene, cb.Probe(sky()), camera, crop=crop, **small)
        assert np.array_equal(image.color, whole[2:6, 3:8])


def test_progress(scene, camera, small, capsys):
    seen = []
    cb.render(scene, cb.Probe(sky()), camera, progress=lambda *p: seen.append(p), **small)
    assert seen[-1] == ("render", 1) and {stage for stage, _ in seen} >= {"probe", "render"}
    count = len(seen)
    cb.render(scene, cb.Probe(sky()), camera, **small)
    assert len(seen) == count
    cb.render(scene, cb.Probe(sky()), camera, progress=True, **small)
    assert "render 100%" in capsys.readouterr().err

    def fails(stage, fraction):
        raise KeyError(stage)

    with pytest.raises(KeyError):
        cb.render(scene, cb.Probe(sky()), camera, progress=fails, **small)
    assert cb.render(scene, cb.Probe(sky()), camera, **small).is_complete


def test_lamps_instances_and_models_go_together(camera, small):
    scene = square_scene()
    cube = scene.add_mesh(SQUARE, TWO, material=cb.Material(double_sided=True), transform=np.diag([0.1, 1, 0.1, 1]))
    for x in range(3):
        matrix = np.diag([0.1, 1.0, 0.1, 1.0])
        matrix[:3, 3] = x - 1, 0.5, 0
        scene.add_instance(cube, matrix)
    dark = cb.render(scene, cb.Probe(sky()), camera, **small)
    assert dark.stats["triangles"] == 10
    scene.add_light("point", position=(0, 3, 0), power=100)
    assert cb.render(scene, cb.Probe(sky()), camera, **small).color.sum() > dark.color.sum()
    scene.add_model(MODEL, translation=(0, 0, -1))
    assert cb.render(scene, cb.Probe(sky()), camera, **small).stats["triangles"] > 10
    with pytest.raises(cb.InputError, match=r"add_light\(\): a point light has no `radiance`"):
        scene.add_light("point", position=(0, 3, 0), radiance=3)
    with pytest.raises(cb.InputError, match="did you mean `?spot"):
        scene.add_light("spott")
    with pytest.raises(cb.InputError, match="no mesh 7 among 2"):
        scene.add_instance(7, np.eye(4))
    with pytest.raises(cb.InputError, match="nothing.glb"):
        scene.add_model("nothing.glb")


@pytest.mark.filterwarnings("ignore:no surface is in view")  # the square is edge-on
def test_cameras(scene, small):
    probe = cb.Probe(sky())
    expected = cb.render(scene, probe, cb.Camera.look_at((0, 0, 3), (0, 0, 0), fov=40), **small).color
    pose = np.eye(4)
    pose[2, 3] = 3
    f = 8 / math.tan(math.radians(20))
    K = [[f, 0, 12], [0, f, 8], [0, 0, 1]]
    for camera in (
        cb.Camera.from_matrix(pose, fov=40),
        cb.Camera.from_matrix(pose @ np.diag([1, -1, -1, 1]), "opencv", fov=40),
        cb.Camera.from_matrix(pose[:3], fov=40),
        cb.Camera.from_intrinsics(K, (24, 16), pose),
    ):
        np.testing.assert_allclose(cb.render(scene, probe, camera, **small).color, expected, rtol=1e-2, atol=1e-3)
    assert cb.render(scene, probe, cb.Camera.from_intrinsics(K, (24, 16), pose), samples=2).color.shape == (16, 24, 3)
    shifted = cb.Camera.from_intrinsics([[f, 0, 9], [0, f, 8], [0, 0, 1]], (24, 16), pose)
    assert not np.allclose(cb.render(scene, probe, shifted, **small).color, expected, rtol=1e-2)
    for wrong in (
        lambda: cb.Camera(positon=(0, 0, 1)),
        lambda: cb.Camera.look_at((0, 0, 1), (0, 0, 1)),
        lambda: cb.Camera.from_matrix(2 * np.eye(4)),
        lambda: cb.Camera.from_matrix(np.diag([-1, 1, 1, 1])),
        lambda: cb.Camera.from_matrix(np.eye(4), "blender"),
        lambda: cb.Camera.from_intrinsics([[f, 0, 9], [0, 2 * f, 8], [0, 0, 1]], (24, 16)),
        lambda: cb.Camera.from_intrinsics(np.full((3, 3), np.nan), (24, 16)),
    ):
        with pytest.raises(cb.InputError):
            wrong()


def resident():
    with open("/proc/self/statm") as file:
        return int(file.read().split()[1]) * 4096


def test_many_renders_leak_nothing(camera):
    probe = cb.Probe(sky(128))

    def work():
        scene = square_scene()
        for angle in (0, 30):
            cb.render(scene, probe.rotated(angle), camera, size=(64, 64), samples=1, layers=["depth"],
                      progress=lambda *_: None)
        with pytest.raises(cb.InputError):
            cb.render(scene, probe, camera, strategy="none")

    for _ in range(20):
        work()
    gc.collect()
    before, references = resident(), sys.getrefcount(None)
    for _ in range(60):
        work()
    gc.collect()
    # One image, its film and the probe's table take 0.6 MB a render.
    assert resident() - before < 10e6
    assert abs(sys.getrefcount(None) - references) < 50


@pytest.mark.parametrize("matrix, size, expected", [
    (np.transpose([[10, 0, 4], [0, 10, 3], [0, 0, 1]]), (8, 6), r"should be \[\[f, 0, cx\]"),
    (2 * np.array([[10, 0, 4], [0, 10, 3], [0, 0, 1]]), (8, 6), r"should be \[\[f, 0, cx\]"),
    ([[10, 0, 4], [5, 10, 3], [0, 0, 1]], (8, 6), r"should be \[\[f, 0, cx\]"),
    ([[10, np.nan, 4], [0, 10, 3], [0, 0, 1]], (8, 6), "finite"),
    ([[10, 0, 4], [0, 10, 3], [0, 0, 1]], (8, 0), "size: 0 should be 1"),
    ([[10, 0, 4], [0, 10, 3], [0, 0, 1]], (-8, 6), "size: -8 should be 1")], ids=str)
def test_wrong_intrinsics_are_refused(matrix, size, expected):
    with pytest.raises(cb.InputError, match=expected):
        cb.Camera.from_intrinsics(matrix, size)
