# SPDX-License-Identifier: Apache-2.0
"""What add_mesh() and Probe() accept and refuse."""

import array
import os
import pathlib

import numpy as np
import pytest
from conftest import SQUARE, TWO, sky, square_scene

import chromeball as cb


def rendered(add, camera, small):
    scene = cb.Scene()
    add(scene)
    return cb.render(scene, cb.Probe(sky()), camera, **small).color


def test_every_kind_of_array_gives_the_same_image(camera, small):
    expected = rendered(lambda s: s.add_mesh(SQUARE, TWO), camera, small)
    wide = np.zeros((4, 6))
    wide[:, ::2] = SQUARE
    frozen = SQUARE.copy()
    frozen.flags.writeable = False
    for positions, triangles in [
        (SQUARE.tolist(), TWO.tolist()),
        (SQUARE.astype(np.float64), TWO.astype(np.uint8)),
        (np.asfortranarray(SQUARE), np.asfortranarray(TWO)),
        (wide[:, ::2], TWO.astype(np.int16)),
        (frozen, TWO.astype(np.uint64)),
        (SQUARE.astype(">f4"), TWO),
        (SQUARE[TWO.ravel()], None),
    ]:
        assert np.array_equal(rendered(lambda s: s.add_mesh(positions, triangles), camera, small), expected)


def test_arrays_of_lamps_cameras_and_materials_are_copied():
    place = np.array([1.0, 2.0, 3.0])
    scene = cb.Scene()
    scene.add_light("point", position=place, intensity=1)
    entry = {"type": "point", "position": place, "intensity": 1}
    listed = cb.Scene(light=[entry])
    seen = cb.Camera.look_at(place, [0, 0, 0])
    red = cb.Material(base_color=place / 3)
    color = np.array([0.5, 0.25, 0.125])
    other = cb.Material(base_color=color)
    up = np.array([[0.0, 0.0, 1.0]])
    before = other.eval(up, up)
    place[:] = 7
    color[:] = 1
    entry["intensity"] = 5
    for lamp in scene._keys["light"] + listed._keys["light"]:
        assert list(lamp["position"]) == [1, 2, 3] and lamp["intensity"] == 1
    assert list(seen.keys["position"]) == [1, 2, 3]
    assert np.allclose(red._keywords["base_color"], [1 / 3, 2 / 3, 1])
    assert np.array_equal(cb.Material(base_color=[0.5, 0.25, 0.125]).eval(up, up), before)
    assert np.array_equal(other.eval(up, up), before)


@pytest.mark.parametrize("kind", [lambda x: array.array("d", x), lambda x: memoryview(array.array("d", x)), np.array])
def test_arrays_of_the_standard_library_are_copied(kind):
    values = [0.25, 0.5, 0.75]
    place, color = kind(values), kind(values)
    scene = cb.Scene()
    scene.add_light("point", position=place, intensity=1)
    material = cb.Material(base_color=color)
    place[1] = color[1] = 0.0
    assert list(scene._keys["light"][0]["position"]) == values
    assert list(material._keywords["base_color"]) == values


def test_instances_of_what_is_no_mesh_are_refused():
    scene = cb.Scene()
    scene.add_mesh(SQUARE, TWO)
    scene.add_instance(np.int64(0), np.eye(4))
    for mesh in [0.0, "0", None, -1, 1]:
        with pytest.raises(cb.InputError, match="mesh"):
            scene.add_instance(mesh, np.eye(4))


def test_arrays_are_copied(camera, small):
    positions = SQUARE.copy()
    scene = cb.Scene()
    scene.add_mesh(positions, TWO)
    expected = cb.render(scene, cb.Probe(sky()), camera, **small).color
    positions[:] = 7
    assert np.array_equal(cb.render(scene, cb.Probe(sky()), camera, **small).color, expected)


@pytest.mark.parametrize(
    "arguments, expected",
    [
        (dict(positions=SQUARE.T), r"positions: has the shape \[3, 4\]; it should be \[V,3\]"),
        (dict(positions=SQUARE[None]), r"positions: has the shape"),
        (dict(positions=[[0, 1], [0]]), r"positions: is no array"),
        (dict(positions=SQUARE.astype(complex)), r"positions: has the type complex128; it should have real numbers"),
        (dict(positions=SQUARE.astype(object)), r"positions: has the type object"),
        (dict(positions=SQUARE * np.nan), r"position"),
        (dict(positions=SQUARE.astype(np.float64) * 1e39), r"position"),
        (dict(positions=SQUARE[:0], triangles=TWO[:0]), r"has no triangles"),
        (dict(triangles=TWO.astype(np.float32)), r"triangles: has the type float32; it should have whole numbers"),
        (dict(triangles=TWO - 1), r"triangles: -1 is out of range"),
        (dict(triangles=TWO + 2**32), r"triangles: 4294967299 is out of range"),
        (dict(triangles=TWO + 1), r"triangle"),
        (dict(normals=SQUARE[:3]), r"normals"),
        (dict(normals=np.where(SQUARE == 1, np.nan, SQUARE)), r"normals\[0\]: is not finite"),
        (dict(uvs=SQUARE), r"uvs: has the shape \[4, 3\]; it should be \[V,2\]"),
        (dict(colors=-np.ones((4, 3))), r"colors\[0\]: \[-1.0, -1.0, -1.0\] should be from 0 to 1"),
        (dict(colors=2 * np.ones((4, 4))), r"colors\[0\]: .* should be from 0 to 1"),
        (dict(colors=np.full((4, 3), 128)), r"colors\[0\]: \[128, 128, 128\] should be from 0 to 1, or be uint8"),
        (dict(colors=np.full((4, 3), np.nan)), r"colors\[0\]"),
        (dict(colors=np.full((4, 3), 0.5 + 0.1j)), r"colors: has the type complex128"),
        (dict(colors=[["1", "0", "0"]] * 4), r"colors: has the type <U1"),
        (dict(colors=np.ones((4, 3), bool)), r"colors: has the type bool"),
        (dict(colors=(1, 0, 0)), r"colors: has the shape \[3\]; it should be \[V,3\] or \[V,4\]"),
        (dict(colors=np.ones((4, 1, 3))), r"colors: has the shape \[4, 1, 3\]"),
        (dict(colors=[[1, 0, 0], [1, 0]]), r"colors: is no array"),
        (dict(colors=np.ones((3, 3))), r"colors"),
        (dict(name="\ud800"), r"name: '.ud800' is no valid text"),
        (dict(name=5), r"name: is a int; it should be a string"),
        (dict(transform=[[1, 0], [1]]), r"transform: is no array"),
        (dict(transform=np.eye(3)), r"transform: has the shape \[3, 3\]"),
        (dict(transform=np.diag([1, 1, 0, 1])), r"not invertible"),
        (dict(transform=np.full((4, 4), np.nan)), r"transform: is not finite"),
        (dict(material="red"), r"material: is a str"),
    ],
)
def test_wrong_meshes_are_refused_by_name(arguments, expected, camera, small):
    scene = cb.Scene()
    with pytest.raises(cb.InputError, match=expected):
        scene.add_mesh(**{"positions": SQUARE, "triangles": TWO, **arguments})
    scene.add_mesh(SQUARE, TWO)  # an error leaves the scene as it was
    assert np.array_equal(
        cb.render(scene, cb.Probe(sky()), camera, **small).color,
        rendered(lambda s: s.add_mesh(SQUARE, TWO), camera, small),
    )


@pytest.mark.parametrize(
    "keywords, expected",
    [
        (dict(base_colour=1), r"unknown keyword `base_colour`; did you mean `?base_color"),
        (dict(base_color=(1, 2)), r"base_color should be"),
        (dict(base_color=2), r"must be 0 to 1"),
        (dict(roughness="high"), r"roughness should be a number"),
        (dict(roughness=float("nan")), r"roughness is nan"),
        (dict(alpha_mode="masked"), r"did you mean `?mask"),
        (dict(unlit=1), r"unlit should be True or False"),
        (dict(base_color_texture=np.zeros((2, 2, 2))), r"base_color_texture: has the shape \[2, 2, 2\]"),
        (dict(base_color_texture=np.zeros((2, 2, 3), np.int64)), r"should have bytes"),
        (dict(base_color_texture=[[1, 2], [3]]), r"base_color_texture: is no array"),
        (dict(alpha_mode="\ud800"), r"alpha_mode: '.ud800' is no valid text"),
        (dict(name="\ud800"), r"name: '.ud800' is no valid text"),
        ({"\ud800": 1}, r"a keyword: '.ud800' is no valid text"),
    ],
)
def test_wrong_materials_are_refused_by_name(keywords, expected):
    with pytest.raises(cb.InputError, match=expected):
        cb.Material(**keywords)


def test_a_texture_colours_the_mesh(camera, small):
    texture = np.zeros((2, 2, 3), np.uint8)
    texture[..., 0] = 255
    scene = cb.Scene()
    scene.add_mesh(SQUARE, TWO, uvs=SQUARE[:, ::2], material=cb.Material(base_color_texture=texture, specular=0))
    middle = cb.render(scene, cb.Probe(sky()), camera, **small).color[8, 12]
    assert middle[0] > 0 and middle[1] == 0 and middle[2] == 0


def test_float_textures_above_one_are_refused_but_of_emission():
    with pytest.raises(cb.InputError, match="texel 0, 0 of a texture exceeds 1"):
        cb.Material(base_color_texture=np.full((2, 2, 3), 255.0))
    cb.Material(emission=1, emission_texture=np.full((2, 2, 3), 255.0))


def test_one_model_or_light_is_a_list_of_one():
    model = os.fspath(pathlib.Path(__file__).parents[2] / "scenes" / "models" / "pillars.gltf")
    scene = cb.Scene(model=model, light={"type": "sun", "direction": (0, -1, 0), "irradiance": 1})
    scene.add_model(model)
    scene.add_light("sun", direction=(0, -1, 0), irradiance=1)
    assert [m if isinstance(m, str) else m["file"] for m in scene._keys["model"]] == [model, model]
    assert len(scene._keys["light"]) == 2


def test_colours_of_vertices(camera, small):
    """Bytes and uint16 are fractions; floats and whole numbers of 0 and 1 are themselves."""
    grey = rendered(lambda s: s.add_mesh(SQUARE, TWO, material=cb.Material(base_color=0.2)), camera, small)

    def shown(colors):
        return rendered(lambda s: s.add_mesh(SQUARE, TWO, colors=colors, material=cb.Material(base_color=1)), camera, small)

    for colors in (np.full((4, 3), 0.2), np.full((4, 3), 51, np.uint8), np.full((4, 4), (51, 51, 51, 255), np.uint8),
                   np.full((4, 3), 13107, np.uint16), np.full((4, 3), 13107, ">u2")):
        np.testing.assert_allclose(shown(colors), grey, rtol=1e-5)
    np.testing.assert_array_equal(shown([(1, 0, 0)] * 4), shown(np.array([[1.0, 0, 0]] * 4)))


@pytest.mark.parametrize("array, expected", [
    (np.ones((4, 8)), r"\[H,W,3\]"),
    (np.ones((4, 8, 4)), r"\[H,W,3\]"),
    (np.full((4, 8, 3), np.nan), r"texel 0, 0 must be finite"),
    (-np.ones((4, 8, 3)), r"not negative"),
    (np.ones((0, 8, 3)), r"has no texels"),
    (np.ones((4, 8, 3), bool), r"has the type bool"),
])
def test_wrong_probes_are_refused(array, expected):
    with pytest.raises(cb.InputError, match=expected):
        cb.Probe(array)


def test_a_scene_grows_after_a_render(scene, camera, small):
    before = cb.render(scene, cb.Probe(sky()), camera, **small)
    kept = before.color.copy()
    wall = dict(positions=SQUARE[:, [0, 2, 1]] * 0.5, triangles=TWO, material=cb.Material(double_sided=True))
    scene.add_mesh(**wall)
    after = cb.render(scene, cb.Probe(sky()), camera, **small)
    fresh = square_scene()
    fresh.add_mesh(**wall)
    assert np.array_equal(after.color, cb.render(fresh, cb.Probe(sky()), camera, **small).color)
    assert not np.array_equal(after.color, kept) and np.array_equal(before.color, kept)
