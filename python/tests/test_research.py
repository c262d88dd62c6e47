# SPDX-License-Identifier: Apache-2.0
"""Strategies and BSDFs over arrays, and strategies that are written in Python."""

import gc
import threading
import weakref

import numpy as np
import pytest
from conftest import sky, square_scene

import chromeball as cb

UP = np.array([[0, 1, 0]], np.float32)
COUNT = 40_000


def numbers(columns=2, count=COUNT, seed=1):
    return np.random.default_rng(seed).random((count, columns))


def points(count=COUNT, normal=UP):
    return cb.Points(None, np.repeat(normal, count, 0))


def sphere_grid(rows, refined):
    """Directions of the middles of a lat-long grid, and their solid angles, [rows * refined, 2 * rows * refined, ...]."""
    n = rows * refined
    theta = (np.arange(n) + 0.5) * np.pi / n
    phi = (np.arange(2 * n) + 0.5) * np.pi / n
    x = np.sin(theta)[:, None] * np.cos(phi)
    z = np.sin(theta)[:, None] * np.sin(phi)
    y = np.repeat(np.cos(theta)[:, None], 2 * n, 1)
    angle = np.cos(np.arange(n) * np.pi / n) - np.cos((np.arange(n) + 1) * np.pi / n)
    return np.stack([x, y, z], -1), np.repeat((angle * np.pi / n)[:, None], 2 * n, 1)


@pytest.mark.parametrize("name", ["importance", "product", "uniform"])
def test_samples_have_their_pdf(name):
    probe = cb.Probe(sky(32)).rotated(30)
    strategy = cb.Strategy(name, probe)
    directions, radiance, pdf = strategy.sample(points(), numbers())
    np.testing.assert_allclose(strategy.pdf(directions, points()), pdf, rtol=1e-2)
    np.testing.assert_allclose(radiance, probe.radiance(directions), rtol=1e-3, atol=1e-5)
    assert cb.chi_square(strategy, points(3)).p_value > 1e-5

    class Tilted:
        pdf = strategy.pdf

        def sample(self, points, u):
            directions, radiance, pdf = strategy.sample(points, u)
            return directions[:, [1, 2, 0]], radiance, pdf

    assert cb.chi_square(Tilted(), points(3)).p_value < 1e-9
    irradiance = radiance * np.maximum(directions[:, 1:2], 0) / np.where(pdf > 0, pdf, np.inf)[:, None]
    if name != "importance":  # whose samples leave the dark part to those of BSDFs
        error = irradiance.mean(0) - probe.irradiance(UP)[0]
        assert (np.abs(error) < 5 * irradiance.std(0) / np.sqrt(COUNT) + 1e-3).all()


def test_without_mis_importance_alone_finds_all_light():
    probe = cb.Probe(sky(32))
    directions, radiance, pdf = cb.Strategy("importance", probe, mis=False).sample(None, numbers())
    irradiance = radiance * np.maximum(directions[:, 1:2], 0) / pdf[:, None]
    error = irradiance.mean(0) - probe.irradiance(UP)[0]
    assert (np.abs(error) < 5 * irradiance.std(0) / np.sqrt(COUNT)).all()


def test_strategies_of_several_samples_or_lights_refuse_to_sample():
    probe = cb.Probe(sky())
    with pytest.raises(cb.InputError, match="takes 8 samples"):
        cb.Strategy("kollig-keller-strata:8", probe).sample(None, numbers(count=1))
    with pytest.raises(cb.InputError, match="replaces the probe by lights|takes 16 samples"):
        cb.Strategy("median-cut:16", probe).sample(None, numbers(count=1))
    assert (cb.Strategy("median-cut:16", probe).pdf(UP) == 0).all()
    assert (cb.Strategy("kollig-keller-strata:8", probe).pdf(UP) > 0).all()
    assert (cb.Strategy("bsdf", probe).sample(None, numbers(count=2))[2] == 0).all()


@pytest.mark.parametrize("call, expected", [
    (lambda p: cb.Strategy("importants", p), "did you mean `?importance"),
    (lambda p: cb.Strategy("importance", "probe.exr"), "probe is a str"),
    (lambda p: cb.Strategy("importance", p).sample(None, [[0.5, 1]]), "below 1"),
    (lambda p: cb.Strategy("importance", p).sample(None, [0.5, 0]), r"\[N,2\]"),
    (lambda p: cb.Strategy("uniform", p).sample(None, [[0.5, 0]]), "depends on the normal"),
    (lambda p: cb.Strategy("uniform", p).pdf(UP, cb.Points(None, [[0, 1, 0]] * 2)), r"normals: has the shape \[2, 3\]"),
    (lambda p: cb.Strategy("uniform", p).pdf(UP, 3), "Points"),
    (lambda p: cb.Material().eval(UP, np.repeat(UP, 2, 0)), "wi and wo: have 1 and 2"),
    (lambda p: cb.Material().sample(UP, [[0, 0, 1.5]]), "below 1"),
    (lambda p: cb.Material().sample(UP, [[0, 0]]), r"\[N,3\]"),
    (lambda p: cb.Material(base_color_texture=np.zeros((2, 2, 3))).eval(UP, UP), "textured"),
])
def test_wrong_arguments_are_refused(call, expected):
    with pytest.raises(cb.InputError, match=expected):
        call(cb.Probe(sky()))


MATERIALS = {
    "matte": (dict(specular=0), 1),
    "metal": (dict(metallic=1, roughness=0.4), 1),
    "plastic": (dict(roughness=0.5), 1),
    "coat": (dict(roughness=0.8, clearcoat=1, clearcoat_roughness=0.3), 1),
    "glass": (dict(roughness=0.5, transmission=1, thin_walled=False), 1),
    "grey": (dict(base_color=0.5, specular=0), 0.5),
}


@pytest.mark.parametrize("name", MATERIALS)
@pytest.mark.parametrize("degrees", [0, 60])
def test_furnace(name, degrees):
    """White materials reflect all light: by the samples' weights, and by the integral of f cos."""
    keywords, albedo = MATERIALS[name]
    material = cb.Material(**keywords)
    a = np.radians(degrees)
    wo = np.repeat([[np.sin(a), 0, np.cos(a)]], COUNT, 0)
    wi, weight, pdf = material.sample(wo, numbers(3))
    error = 5 * weight.std(0) / np.sqrt(COUNT) + 0.01
    np.testing.assert_array_less(np.abs(weight.mean(0) - albedo), error)
    found = pdf > 0
    np.testing.assert_allclose(material.pdf(wi[found], wo[found]), pdf[found], rtol=1e-2, atol=1e-5)
    np.testing.assert_allclose(material.eval(wi[found], wo[found]), weight[found] * pdf[found, None], rtol=1e-2, atol=1e-5)
    grid, angle = sphere_grid(8, 24)
    flat = grid.reshape(-1, 3)
    f_cos = material.eval(flat, np.repeat(wo[:1], len(flat), 0))
    np.testing.assert_allclose((f_cos * angle.reshape(-1, 1)).sum(0), albedo, rtol=0.02)


def test_mirrors_have_a_single_direction():
    mirror = cb.Material(metallic=1, roughness=0)
    wo = np.array([[0.6, 0, 0.8]])
    wi, weight, pdf = mirror.sample(wo, [[0.3, 0.3, 0.3]])
    np.testing.assert_allclose(wi, [[-0.6, 0, 0.8]], atol=1e-6)
    np.testing.assert_allclose(weight, 1, rtol=1e-5)
    assert pdf[0] == 0 and (mirror.eval(wi, wo) == 0).all()


class Uniform:
    """The built-in `uniform`."""

    def __init__(self, probe):
        self.probe, self.calls, self.largest, self.threads = probe, 0, 0, set()

    def sample(self, points, u):
        self.calls += 1
        self.largest = max(self.largest, len(u))
        self.threads.add(threading.get_ident())
        normal = points.normals
        r, phi = np.sqrt(1 - u[:, 0] ** 2), 2 * np.pi * u[:, 1]
        axis = np.where(np.abs(normal[:, :1]) > 0.5, [[0, 1, 0]], [[1, 0, 0]])
        x = np.cross(axis, normal)
        x /= np.linalg.norm(x, axis=1, keepdims=True)
        y = np.cross(normal, x)
        directions = (r * np.cos(phi))[:, None] * x + (r * np.sin(phi))[:, None] * y + u[:, :1] * normal
        return directions, self.probe.radiance(directions), np.full(len(u), 0.5 / np.pi)

    def pdf(self, directions, points):
        return np.where(np.einsum("ij,ij->i", directions, points.normals) > 0, 0.5 / np.pi, 0)


class Sphere:
    """Uniform over the sphere, whatever the point."""

    def __init__(self, probe):
        self.probe = probe

    def sample(self, points, u):
        y, phi = 1 - 2 * u[:, 0], 2 * np.pi * u[:, 1]
        r = np.sqrt(1 - y * y)
        directions = np.stack([r * np.cos(phi), y, r * np.sin(phi)], 1)
        return directions, self.probe.radiance(directions), np.full(len(u), 0.25 / np.pi)

    def pdf(self, directions):
        return np.full(len(directions), 0.25 / np.pi)


def lit_by(strategy, camera, seed, mis="balance", samples=64, **more):
    scene = more.pop("scene", None) or square_scene()
    return cb.render(scene, cb.Probe(sky()), camera, size=(24, 16), samples=samples, seed=seed, adaptive="off", mis=mis,
                     strategy=strategy, **more).color


def z_of(a, b):
    """Of the difference of the means over all pixels of images [K,H,W,3]."""
    a, b = a.mean((1, 2, 3)), b.mean((1, 2, 3))
    return (a.mean() - b.mean()) / np.sqrt(a.var(ddof=1) / len(a) + b.var(ddof=1) / len(b))


@pytest.mark.parametrize("mis", ["balance", "off"])
@pytest.mark.parametrize("make", [Uniform, Sphere, lambda p: cb.Strategy("product", p)], ids=["hemisphere", "sphere", "product"])
def test_a_python_strategy_is_unbiased(make, mis, camera):
    strategy = make(cb.Probe(sky()))
    own = np.stack([lit_by(strategy, camera, seed, mis) for seed in range(10)])
    built = np.stack([lit_by("uniform", camera, seed, mis) for seed in range(100, 110)])
    # 4.5 standard errors of 18 degrees of freedom: below 1e-3 by chance in all six cases.
    assert abs(z_of(own, built)) < 4.5
    assert abs(z_of(own * 1.02, built)) > 4.5


def test_it_is_called_for_many_points_and_gives_the_same_bits_for_any_threads(camera):
    strategy = Uniform(cb.Probe(sky()))
    one = lit_by(strategy, camera, 1, threads=1)
    assert strategy.largest > 1000 and strategy.calls < 200
    assert np.array_equal(lit_by(strategy, camera, 1, threads=2), one)
    assert threading.get_ident() not in strategy.threads


def test_layers_denoising_and_glass(camera):
    scene = cb.Scene()
    square_scene(transmission=1, thin_walled=False)
    scene = square_scene(transmission=0.5, thin_walled=False, roughness=0.4)
    own = np.stack([lit_by(Sphere(cb.Probe(sky())), camera, seed, samples=16, scene=scene) for seed in range(8)])
    built = np.stack([lit_by("uniform", camera, seed, samples=16, scene=scene) for seed in range(100, 108)])
    assert abs(np.log(own.mean() / built.mean())) < 0.02
    image = cb.render(square_scene(), cb.Probe(sky()), camera, size=(24, 16), samples=4, denoise=True,
                      layers=["depth", "ao"], strategy=Sphere(cb.Probe(sky())))
    assert np.isfinite(image.color).all() and "depth" in image.layers


def failing(**methods):
    base = Sphere(cb.Probe(sky()))
    return type("Failing", (), {"sample": staticmethod(base.sample), "pdf": staticmethod(base.pdf),
                                **{name: staticmethod(method) for name, method in methods.items()}})()


def raises(*_):
    raise KeyError("own")


GOOD = Sphere(cb.Probe(sky())).sample


def changed(index, change):
    def sample(points, u):
        found = list(GOOD(points, u))
        found[index] = change(np.array(found[index]))
        return found

    return sample


def with_element(value):
    def change(array):
        array[-1] = value
        return array

    return change


@pytest.mark.parametrize("methods, error, expected", [
    (dict(sample=raises), KeyError, "own"),
    (dict(pdf=raises), KeyError, "own"),
    (dict(sample=lambda points, u: None), cb.InputError, "should return directions"),
    (dict(sample=changed(0, lambda d: d[:-1])), cb.InputError, "directions of sample.*has the shape"),
    (dict(sample=changed(2, lambda p: p[:, None])), cb.InputError, r"pdf of sample\(\): has the shape"),
    (dict(sample=changed(2, with_element(0))), cb.InputError, "pdf of sample.* is 0.0; it should be finite and above 0"),
    (dict(sample=changed(2, with_element(np.nan))), cb.InputError, "is nan"),
    (dict(sample=changed(1, with_element(-1))), cb.InputError, "radiance of sample.*not negative"),
    (dict(sample=changed(0, with_element(2))), cb.InputError, "unit vectors"),
    (dict(pdf=lambda d: np.full(len(d), np.nan)), cb.InputError, r"result of pdf\(\).* is nan"),
    (dict(pdf=lambda d: d), cb.InputError, r"result of pdf\(\): has the shape"),
])
def test_errors_of_a_strategy_end_the_render(methods, error, expected, camera):
    scene = square_scene()
    with pytest.raises(error, match=expected):
        lit_by(failing(**methods), camera, 1, scene=scene)
    assert np.isfinite(lit_by(failing(), camera, 1, scene=scene)).all()


@pytest.mark.filterwarnings("error")
def test_a_strategy_has_a_name_of_its_own_and_every_setting_has_an_effect(camera):
    class suns(Sphere):
        pass

    image = cb.render(square_scene(), cb.Probe(sky()), camera, size=(8, 8), samples=1, mis="off", adaptive="off",
                      strategy=suns(cb.Probe(sky())))
    assert image.stats["strategy"].endswith(".suns")


def test_what_is_no_strategy_is_refused(camera):
    with pytest.raises(cb.InputError, match="is a int; it should be a name, or have sample"):
        lit_by(3, camera, 1)


def test_no_samples_are_black_with_a_pdf_of_0(camera):
    def sample(points, u):
        return GOOD(points, u)[0], np.zeros((len(u), 3)), np.zeros(len(u))

    own = lit_by(failing(sample=sample, pdf=lambda d: np.zeros(len(d))), camera, 1)
    np.testing.assert_allclose(own, lit_by("bsdf", camera, 1), rtol=1e-5)


def test_a_strategy_may_use_the_renderer_and_is_freed(camera):
    probe = cb.Probe(sky())

    class Nested(Sphere):
        def sample(self, points, u):
            self.probe.irradiance(points.normals[:3000])
            return cb.Strategy.sample(self.built, None, u)

    strategy = Nested(probe)
    strategy.built = cb.Strategy("importance", probe, mis=False)
    strategy.pdf = strategy.built.pdf
    session = cb.Session(square_scene(), probe, camera, size=(16, 16), samples=64, strategy=strategy)
    found = session.start().wait().color
    assert np.isfinite(found).all()
    session.update(strategy="uniform").start().wait()
    gone = weakref.ref(strategy)
    del strategy, session
    gc.collect()
    assert gone() is None


def test_a_strategy_that_refers_to_its_session_is_freed_with_it(camera):
    strategy = Sphere(cb.Probe(sky()))
    strategy.session = cb.Session(square_scene(), strategy.probe, camera, size=(16, 16), samples=4, strategy=strategy)
    strategy.session.start().wait()
    gone = weakref.ref(strategy)
    del strategy
    gc.collect()
    assert gone() is None


def floor(x=0.0, size=1.0):
    scene = cb.Scene()
    square = np.array([[-1, 0, 1], [1, 0, 1], [1, 0, -1], [-1, 0, -1]]) * size
    scene.add_mesh(square, [[0, 1, 2], [0, 2, 3]], material=cb.Material(base_color=0.5, specular=0),
                   transform=[[1, 0, 0, x], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]])
    return scene


def sunny():
    """A grey probe with a small bright window above the horizon."""
    texels = np.full((32, 64, 3), 0.2, np.float32)
    texels[8:10, 31:33] = 400
    return cb.Probe(texels)


WINDOW = [[28, 12], [36, 12], [36, 6], [28, 6]]  # texels around it


@pytest.mark.parametrize("mis", ["off", "balance"])
@pytest.mark.parametrize("settings", [
    dict(), dict(probe_scale=2), dict(probe_rotation=70), dict(light_from="suns"), dict(light_from="rest"), dict(source=True),
    dict(layers=["light_groups"])], ids=str)
def test_the_light_is_the_probe_of_the_render(settings, mis, camera):
    """Whatever turns, scales or divides it: the strategy chooses directions only."""
    probe = sunny()
    settings = dict(settings)
    scene = floor()
    if settings.pop("source", False):
        scene = cb.Scene(source=[{"probe_polygon": WINDOW}])
        scene.add_mesh(np.array([[-1, 0, 1], [1, 0, 1], [1, 0, -1], [-1, 0, -1]]), [[0, 1, 2], [0, 2, 3]],
                       material=cb.Material(base_color=0.5, specular=0))

    def mean(strategy, samples):
        image = cb.render(scene, probe, camera, size=(12, 8), crop="2,3,8,3", samples=samples, adaptive="off", max_depth=1,
                          strategy=strategy, mis=mis, **settings)
        return image.color.mean()

    own = cb.Strategy("importance", probe.rotated(settings.get("probe_rotation", 0)), mis=False)  # else it is unbiased, but noisy
    expected = mean("importance", 256)
    assert abs(mean(own, 256) / expected - 1) < 0.02


@pytest.mark.parametrize("x", [0.0, 100.0, 1e6])
def test_points_are_in_the_world(x):
    seen = []

    class Where(Sphere):
        def sample(self, points, u):
            seen.append(points.positions.copy())
            return super().sample(points, u)

    cb.render(floor(x), cb.Probe(sky()), cb.Camera.look_at((x, 3, 3), (x, 0, 0)), size=(8, 8), samples=4,
              strategy=Where(cb.Probe(sky())))
    positions = np.concatenate(seen)
    assert positions.dtype == np.float64
    assert x - 1.001 < positions[:, 0].min() < x - 0.5 and x + 0.5 < positions[:, 0].max() < x + 1.001


def test_calls_of_a_render_do_not_overlap(camera):
    inside = []

    class Slow(Sphere):
        def sample(self, points, u):
            inside.append(1)
            assert len(inside) == 1
            self.probe.irradiance(np.repeat(UP, 200, 0))  # releases the interpreter's lock
            inside.pop()
            return super().sample(points, u)

    cb.render(square_scene(), cb.Probe(sky()), camera, size=(32, 24), samples=16, strategy=Slow(cb.Probe(sky())), threads=2)


@pytest.mark.parametrize("settings", [dict(integrator="environment-map"), dict(max_depth=0)], ids=str)
def test_a_strategy_without_effect_is_named(settings, camera):
    with pytest.warns(cb.RenderWarning, match="strategy has no effect"):
        lit_by(Sphere(cb.Probe(sky())), camera, 1, samples=1, **settings)


def test_numbers_that_round_to_1_are_below_it():
    wi, weight, pdf = cb.Material(metallic=1, roughness=0.4).sample([[0.6, 0, 0.8]], [[0.3, 0.2, 1 - 1e-9]])
    assert np.isfinite(wi).all() and np.isfinite(weight).all() and np.isfinite(pdf).all()
