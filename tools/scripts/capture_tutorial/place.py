# SPDX-License-Identifier: Apache-2.0
"""The place of the simulated photographs: models with known truth, in the light of a known probe (surroundings.py)."""
import math
import random

import pixels
from camera import View
from gltf import Model

CHROME = (0.632, 0.647, 0.653)
GREY = (0.32, 0.333, 0.346)
CARD = (0.8, 0.8, 0.8)
BALL_DISTANCE = 10  # of the camera, in radii
BALL_SIZE, GREY_SIZE = 280, 140
SECOND_AZIMUTH = 91.5  # said to be 90

PLATE = View((0.7, 1.75, 4.6), (0.05, 0.42, 0), 40, (480, 320), -0.12)
LOCAL = ["floor", "wall", "step", "post"]


def sphere_view(azimuth, size, distance=BALL_DISTANCE):
    """Looks at a ball of radius 1 in the origin, 1.1 of whose outline fill the picture."""
    turn = math.radians(azimuth)
    fov = 2 * math.degrees(math.atan(1.1 / math.sqrt(distance ** 2 - 1)))
    return View((distance * math.sin(turn), 0, distance * math.cos(turn)), (0, 0, 0), fov, (size, size))


def mirror_ball(folder, card):
    """A chrome ball; with a white card at its side, whose face the camera and the ball see."""
    model = Model()
    model.sphere("ball", model.material(CHROME, 0, 1), (0, 0, 0), 1)
    if card:
        s = math.sqrt(0.5)
        model.quads("card", model.material(CARD), [((2.9 - 0.9 * s, -0.9, -0.9 * s), (1.8 * s, 0, 1.8 * s),
                                                    (0, 1.8, 0))])
    file = folder / ("ball-and-card.gltf" if card else "ball.gltf")
    model.write(file)
    return file


def grey_ball(folder):
    model = Model()
    model.sphere("grey ball", model.material(GREY), (0, 0, 0), 1)
    model.write(folder / "grey-ball.gltf")
    return folder / "grey-ball.gltf"


def paving(path):
    """A texture of 10 x 10 stones of different shades, with joints."""
    chance = random.Random(4)
    stones = {}
    for i in range(10):
        for j in range(10):
            shade, warm = 0.8 + 0.4 * chance.random(), 0.04 * chance.random()
            stones[i, j] = tuple(shade * c for c in (168 + 255 * warm, 158, 142 - 255 * warm))
    rows = []
    for y in range(480):
        row = []
        for x in range(480):
            joint = min(x % 48, y % 48) < 2
            grain = 1 + 0.05 * chance.gauss(0, 1)
            row.append(tuple(max(0, min(255, round((0.55 if joint else 1) * grain * c)))
                             for c in stones[x // 48, y // 48]))
        rows.append(row)
    pixels.write_png(path, rows)


def the_set(folder, name, real, objects):
    """The set, as it is, or (`real` false) a grey copy as one measures it; with or without objects."""
    model = Model()
    if real:
        paving(folder / "paving.png")
    grey = (0.4, 0.4, 0.4)
    floor = model.material((1, 1, 1), texture="paving.png") if real else model.material(grey)
    wall = model.material((0.55, 0.33, 0.22) if real else grey)
    stone = model.material((0.5, 0.5, 0.46) if real else grey)
    model.quads("floor", floor, [((-2.5, 0, 2.5), (5, 0, 0), (0, 0, -5))])
    model.box("wall", wall, (-2.2, 0, -1.7), (1.4, 1.1, -1.5))
    model.box("step", stone, (0.7, 0, -0.9), (1.6, 0.3, -0.1))
    model.box("post", stone, (-1.55, 0, -0.5), (-1.3, 0.9, -0.25))
    if objects:
        model.sphere("chrome ball", model.material((0.9, 0.9, 0.9), 0.2, 1), (-0.35, 0.35, 0.15), 0.35, 128, 64)
        model.box("red box", model.material((0.6, 0.06, 0.05)), (0.3, 0, 0.5), (0.75, 0.45, 0.95), 30)
        model.torus("golden ring", model.material((0.95, 0.7, 0.3), 0.25, 1), (1.15, 0.39, -0.5), 0.26, 0.09)
        model.sphere("white ball", model.material((0.75, 0.75, 0.75)), (-0.95, 0.2, 0.95), 0.2, 128, 64)
    model.write(folder / name)
    return folder / name


def points():
    """What one can measure by tape and find in the plate: (name, position)."""
    found = [(f"floor {x:+g} {z:+g}", (x, 0, z)) for x in (-1, 0, 1) for z in (0, 1.5)]
    found += [("wall left", (-2.2, 1.1, -1.5)), ("wall right", (1.4, 1.1, -1.5)), ("wall foot", (1.4, 0, -1.5)),
              ("step a", (0.7, 0.3, -0.1)), ("step b", (1.6, 0.3, -0.1)), ("step c", (1.6, 0.3, -0.9)),
              ("post a", (-1.55, 0.9, -0.25)), ("post b", (-1.3, 0.9, -0.25)), ("post c", (-1.3, 0.9, -0.5)),
              ("post foot", (-1.3, 0, -0.25))]
    return found


def scene(folder, name, model, view, probe, scale=1, more=""):
    """A scene file in the true light."""
    size = f"[render]\nsize = {list(view.size)}\n"
    text = f'model = "{model.name}"\n{view.toml()}[probe]\nfile = "{probe}"\nscale = {scale:.9g}\n{size}{more}'
    (folder / name).write_text(text)
    return folder / name
