# SPDX-License-Identifier: Apache-2.0
"""Steps 7 to 9: the plate without the falloff of its lens, its camera, and objects in it."""
import json
import math
import random

import camera
import pixels
import place
import simulate
from exr import Exr
from page import Step, some_lines
from plots import contact_sheet

PICK_ERROR = 0.4  # pixels, standard deviation of what a person picks


def flat_field(run, photographs):
    names = []
    for i in range(len(simulate.SPOTS)):
        names.append(f"lamp{i}.exr")
        run("probe", "merge", *photographs.files(f"lamp{i}", simulate.LAMP_TIMES), "--response", "response.csv", "-o",
            names[-1])
    arguments = ["image", "flat-field", *names, "-o", "flat.exr"]
    said = run.said(*arguments)
    flat = Exr(run.scratch / "flat.exr").color()
    error = max(abs(v / simulate.falloff(x + 0.5, y + 0.5) - 1) for y, row in enumerate(flat)
                for x, pixel in enumerate(row) for v in pixel)
    merged = run.said("probe", "merge", *photographs.files("plate"), "--response", "response.csv", "--flat-field",
                      "flat.exr", "-o", "plate.exr")
    unit = camera.unit()
    truth = [[tuple(unit * v for v in pixel) for pixel in row] for row in photographs.radiance("plate")]
    pixels.write_pfm(run.scratch / "true-plate-scaled.pfm", truth)
    plate = run.json("image", "error", "plate.exr", "true-plate-scaled.pfm", "--flip")
    contact_sheet(run, [f"plate-{a}-{b}.png" for a, b in camera.TIMES[3:6]], "plates.jpg")
    corner = 1 + sum(simulate.FALLOFF)
    return Step(
        "The plate, without the falloff of the lens",
        f"The lens darkens the corners to {100 * corner:.0f}%. Photograph one lamp in at least four places of the "
        f"picture, "
        "from the middle to a corner; merge each with the response. `image flat-field` fits the falloff, and "
        "`probe merge` divides the plate by it.",
        ["for i in 0 1 2 3 4 5 6; do\n  chromeball probe merge lamp$i-*.png --response response.csv -o "
         "lamp$i.exr\ndone",
         "chromeball image flat-field lamp?.exr -o flat.exr",
         "chromeball probe merge plate-*.png --response response.csv --flat-field flat.exr -o plate.exr"],
        said + "\n" + some_lines(merged, "clipped"),
        [("plates.jpg", "Three of the seven exposures of the plate")],
        [("falloff, largest error in the image", "", "", f"{100 * error:.1f}%"),
         ("plate, relMSE and FLIP", "", "", f"{plate['relmse']:.1e}, {plate['flip']:.3f}")])


def solve(run):
    chance = random.Random(3)
    lines = ["name,x,y,z,px,py"]
    for name, position in place.points():
        px, py = place.PLATE.pixel(position)
        lines.append(f"{name},{position[0]},{position[1]},{position[2]},{px + chance.gauss(0, PICK_ERROR):.2f},"
                     f"{py + chance.gauss(0, PICK_ERROR):.2f}")
    (run.scratch / "points.csv").write_text("\n".join(lines) + "\n")
    place.the_set(run.scratch, "measured.gltf", False, True)
    run("image", "view", "plate.exr", "plate.png", "--exposure", -9)
    arguments = ["camera", "solve", "measured.gltf", "plate.png", "--points", "points.csv", "--distortion", "-o",
                 "camera.toml"]
    said = run.said(*arguments, "--preview", "camera.png")
    found = run.json(*arguments)
    run.picture("camera.png", "camera.jpg")
    return found, said, len(lines) - 1, lines


def camera_step(run):
    found, said, count, lines = solve(run)
    truth = place.PLATE
    sigma, k1 = found["errors"], found["distortion"][0]
    offset = 1000 * math.dist(found["position"], truth.position)
    picked = "\n".join("    " + line for line in lines[:4])
    return Step(
        "The camera of the plate",
        f"Measure points of the set by tape, find them in the plate, and write both to a table, points.csv. Here "
        f"{count} points "
        f"are picked with an error of {PICK_ERROR} pixels (standard deviation, in each direction):\n\n{picked}\n   "
        f" ...",
        ["chromeball image view plate.exr plate.png --exposure -9",
         "chromeball camera solve measured.gltf plate.png --points points.csv --distortion \\\n"
         "  -o camera.toml --preview camera.png"], said,
        [("camera.jpg", "The edges of the model over the plate (also of the objects); crosses were picked, circles "
                        "are what the "
                        "camera sees")],
        [("position", _numbers(found["position"], 3), _numbers(truth.position, 3),
          f"{offset:.0f} mm (standard error {1000 * math.hypot(*sigma['position']):.0f} mm)"),
         ("vertical field of view, degrees", f"{found['fov']:.2f}", f"{truth.fov}",
          f"{abs(found['fov'] - truth.fov):.2f} ({sigma['fov']:.2f})"),
         ("distortion k1", f"{k1:.3f}", f"{truth.k1}", f"{abs(k1 - truth.k1):.3f} ({sigma['k1']:.3f})")],
        "In brackets are the standard errors that the program states. Position and field of view are wrong "
        "together: the "
        "picture that the camera shows is better than each of them.")


def _numbers(values, digits):
    return ", ".join(f"{v:.{digits}f}" for v in values)


SCENE = """model = "measured.gltf"

[camera]
file = "camera.toml"

[probe]
file = "sunny.exr"

[composite]
plate = "plate.exr"
local_scene = ["floor", "wall", "step", "post"]
reflectance = "plate"

[render]
samples = 48
denoise = true

[output]
file = "composite.exr"
aovs = ["difference", "alpha"]
"""


def over(run, catcher):
    """plate (1 - alpha) ratio + objects, as a file."""
    plate = Exr(run.scratch / "plate.exr").color()
    layers = Exr(run.scratch / catcher)
    ratio, objects, alpha = layers.color("ratio"), layers.color("objects"), layers.plane("alpha")
    rows = [[tuple(p * (1 - alpha[y][x]) * r + o for p, r, o in zip(plate[y][x], ratio[y][x], objects[y][x]))
             for x in range(layers.width)] for y in range(layers.height)]
    pixels.write_pfm(run.scratch / "over.pfm", rows)


def composite(run, photographs):
    (run.scratch / "composite.toml").write_text(SCENE)
    said = run.said("render", "composite.toml")
    for name, probe, scale in (("sun", "probe.exr", 1), ("light", photographs.truth, camera.unit())):
        text = SCENE.replace("composite.exr", f"{name}.exr")
        text = text.replace('"sunny.exr"\n', f'"{probe}"\nscale = {scale:.9g}\n')
        (run.scratch / f"{name}.toml").write_text(text)
        run("render", f"{name}.toml", "--quiet")
    catcher = SCENE[:SCENE.index("[composite]")] + "[render]\nsize = [480, 320]\nsamples = 48\n"
    (run.scratch / "catcher.toml").write_text(catcher)
    run("render", "catcher.toml", "--shadow-catcher", ",".join(place.LOCAL), "-o", "catcher.exr", "--quiet")
    over(run, "catcher.exr")
    full = place.the_set(run.scratch, "full.gltf", True, True)
    scene = place.scene(run.scratch, "full.toml", full, place.PLATE, photographs.truth, camera.unit())
    run.render(scene, "full.exr", "--samples", 128, "--seed", 1)  # other noise than the composite's
    errors = {name: run.json("image", "error", name, "full.exr", "--flip")
              for name in ("composite.exr", "sun.exr", "light.exr", "over.pfm", "plate.exr")}
    for name, picture in (("composite.exr", "composite.jpg"), ("full.exr", "full.jpg"), ("sun.exr", "no-sun.jpg"),
                          ("over.pfm", "over.jpg")):
        run.picture(name, picture, "--exposure", -9.5)

    def row(what, name):
        return what, "", "", f"{errors[name]['relmse']:.1e}, {errors[name]['flip']:.3f}"

    return Step(
        "The composite",
        "The model has a grey copy of the set, as one builds it from the measured points, and the objects. "
        "`reflectance = \"plate\"` gives the copy the plate's colours. Plate and probe have one unit, because the "
        "same "
        "camera took both with one response: no scale is needed.\n\ncomposite.toml:\n\n"
        + "\n".join("    " + line if line else "" for line in SCENE.splitlines()),
        ["chromeball render composite.toml"], said,
        [("composite.jpg", "The composite"), ("full.jpg", "The truth: a render of the real set with the objects"),
         ("no-sun.jpg", "The composite without the sun of step 5")],
        [row("composite, relMSE and FLIP", "composite.exr"), row("the same with the true probe", "light.exr"),
         row("the same without the sun of step 5", "sun.exr"), row("the plate without objects", "plate.exr"),
         row("shadow catcher over the plate", "over.pfm")],
        "The errors are against the render of the real set, in its true light, through the true lens.\n\n"
        "For a compositing program, `--shadow-catcher` renders the objects and what they do to the plate as layers "
        "(catcher.toml is composite.toml without `[composite]`):\n\n"
        f"    chromeball render catcher.toml --shadow-catcher {','.join(place.LOCAL)} -o catcher.exr\n\n"
        "The last row is plate x (1 - `alpha`) x `ratio` + `objects`. It has a larger error because its set stays "
        "grey: "
        "the objects mirror it.\n\n![The same by layers](pictures/capture/over.jpg)")


def steps(run, photographs):
    return [flat_field(run, photographs), camera_step(run), composite(run, photographs)]
