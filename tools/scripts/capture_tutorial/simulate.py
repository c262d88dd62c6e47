# SPDX-License-Identifier: Apache-2.0
"""The photographs of part 1, with their truth."""
import camera
import pixels
import place
import surroundings
from camera import View
from pfm import read_pfm

CARD_VIEW = View((0, 0, 10), (1.2, 0, 0), 24, (420, 280))
# Constants of the lens: 1 + a2 r^2 + a4 r^4, r = 1 in the corners.
FALLOFF = (-0.3, 0.05)
# Where the lamp of the flat field is, in pixels.
SPOTS = [(240, 160), (290, 190), (340, 220), (380, 255), (420, 280), (455, 300), (470, 310)]
LAMP_TIMES = [(1, 125), (1, 60), (1, 15)]


def falloff(x, y):
    width, height = place.PLATE.size
    r2 = ((x - width / 2) ** 2 + (y - height / 2) ** 2) / (width ** 2 + height ** 2) * 4
    return 1 + r2 * (FALLOFF[0] + r2 * FALLOFF[1])


def lamp_at(spot):
    """A disc of constant radiance in front of black."""
    width, height = place.PLATE.size
    return [[(1.0, 0.9, 0.8) if (x + 0.5 - spot[0]) ** 2 + (y + 0.5 - spot[1]) ** 2 < 36 else (0, 0, 0)
             for x in range(width)] for y in range(height)]


class Photographs:
    """Renders what the camera sees, and takes the photographs."""

    def __init__(self, run):
        folder = run.scratch
        self.run = run
        self.truth = folder / "true.pfm"
        finished = folder / "photographs.txt"
        if finished.exists():
            return
        surroundings.write(run, self.truth.name)
        ball, grey = place.mirror_ball(folder, False), place.grey_ball(folder)
        self._take("front", ball, place.sphere_view(0, place.BALL_SIZE), 64)
        self._take("side", ball, place.sphere_view(place.SECOND_AZIMUTH, place.BALL_SIZE), 64)
        self._take("card", place.mirror_ball(folder, True), CARD_VIEW, 64)
        self._take("grey", grey, place.sphere_view(0, place.GREY_SIZE), 64)
        self._take("plate", place.the_set(folder, "real.gltf", True, False), place.PLATE, 96, falloff)
        camera.bracket(folder, "even", self.radiance("front"), "even", camera.EVEN_TIMES)
        for i, spot in enumerate(SPOTS):
            camera.bracket(folder, f"lamp{i}", lamp_at(spot), f"lamp{i}", LAMP_TIMES, falloff)
        finished.write_text("The photographs are complete.\n")

    def _take(self, name, model, view, samples, darkening=None):
        scene = place.scene(self.run.scratch, f"{name}.toml", model, view, self.truth)
        self.run.render(scene, f"true-{name}.pfm", "--samples", samples)
        camera.bracket(self.run.scratch, name, self.radiance(name), name, falloff=darkening)

    def radiance(self, name):
        return read_pfm(self.run.scratch / f"true-{name}.pfm")

    @staticmethod
    def files(name, times=None):
        return [f"{name}-{a}-{b}.png" for a, b in times or camera.TIMES]
