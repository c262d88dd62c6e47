# SPDX-License-Identifier: Apache-2.0
"""Steps 1 to 6: from photographs of balls to a probe with its sun."""
import math

import camera
import place
from exr import Exr
from lat_long import irradiance, irradiance_error
from page import Step, some_lines
from plots import contact_sheet, response_plot

DIRECT, REFLECTED = "300,128,30,24", "182,136,7,7"


def at_direction(rows, direction):
    """The texel of a lat-long map in this direction."""
    x, y, z = direction
    u, v = 0.5 + math.atan2(x, -z) / (2 * math.pi), math.acos(y) / math.pi
    return rows[min(int(v * len(rows)), len(rows) - 1)][int(u * len(rows[0])) % len(rows[0])]


def levels_of_error(run, name):
    """In levels of 8 bits: what the true response gives for the exposures of a solved one, from level 5 to 250."""
    scale = camera.SENSITIVITY / camera.unit()
    lines = [line for line in (run.scratch / name).read_text().splitlines() if line[:1].isdigit()]
    found = [[camera.response(float(value) * scale) * 255 for value in line.split(",")[1:]] for line in lines]
    return found, max(abs(value - level) for level, row in enumerate(found) if 5 <= level <= 250 for value in row)


def error_of_merge(run, photographs, name):
    """RMS over the channels that are not clipped, in percent."""
    file, truth, unit = Exr(run.scratch / f"{name}.exr"), photographs.radiance(name), camera.unit()
    clipped = file.plane("clipped")
    squares = [(a / (b * unit) - 1) ** 2 for y, row in enumerate(file.color()) for x, pixel in enumerate(row)
               if not clipped[y][x] for a, b in zip(pixel, truth[y][x])]
    return 100 * math.sqrt(sum(squares) / len(squares))


def response(run, photographs):
    said = run.said("probe", "merge", *photographs.files("front"), "--response", "solve", "--write-response",
                    "response.csv", "-o", "front.exr")
    run("probe", "merge", *photographs.files("even", camera.EVEN_TIMES), "--response", "solve", "--write-response",
        "even.csv", "-o", "even.exr")
    found, error = levels_of_error(run, "response.csv")
    _, even = levels_of_error(run, "even.csv")
    response_plot(run.pictures / "response.svg", found)
    contact_sheet(run, [f"front-{a}-{b}.png" for a, b in camera.TIMES[1:6]], "exposures.jpg")
    return Step(
        "The response of the camera",
        "Photograph the mirror ball with the camera fixed, in manual mode, with exposure times that step by "
        "*different* "
        "factors of 2 to 4. The darkest shows no white but the sun, the brightest no black. "
        "`--response solve` finds the camera's response from them; the other series use its file.",
        ["chromeball probe merge front-*.png --response solve --write-response response.csv -o front.exr"], said,
        [("exposures.jpg", "Five of the seven exposures"),
         ("response.svg", "The solved response of the three channels, and the true one (black)")],
        [("response, largest error of levels 5 to 250", f"{error:.1f} levels", "0", f"{error:.1f} levels")],
        f"With six exposures in even steps of 4 the largest error is {even:.1f} levels: brackets of one ratio "
        f"leave part "
        "of the response [undetermined](methods.md#exposures-and-the-sun). EXIF gives times, f-numbers and ISO; "
        "without it give `--exposures`. The ratios compare neighbouring exposures. A warning about the darkest one "
        "can be ignored here: few of its pixels are well exposed, and noise chooses them.")


def merge(run, photographs):
    said = {name: run.said("probe", "merge", *photographs.files(name), "--response", "response.csv", "-o",
                           f"{name}.exr") for name in ("front", "side", "card", "grey")}
    errors = {name: error_of_merge(run, photographs, name) for name in said}
    worst = max(errors, key=errors.get)
    return Step(
        "Photographs of high dynamic range",
        "Merge all series of balls with this response.",
        ["for s in front side card grey; do\n  chromeball probe merge $s-*.png --response response.csv -o "
         "$s.exr\ndone"],
        some_lines(said["side"], "response", "clipped", "under"), [],
        [(f"radiance of `{worst}`, RMS of the channels that are not clipped", "", "", f"{errors[worst]:.1f}%")],
        "The sun is white in all exposures. The layer `clipped` marks its pixels; step 5 finds its irradiance.")


def reflectivity(run):
    arguments = ["probe", "reflectivity", "card.exr", "--direct", DIRECT, "--reflected", REFLECTED]
    found = run.json(*arguments)["reflectivity"]
    truth = [f + (1 - f) * (1 - math.sqrt(0.5)) ** 5 for f in place.CHROME]
    run.picture("card.exr", "card.jpg", "--exposure", -10)
    worst = max(abs(a / b - 1) for a, b in zip(found, truth))
    return found, Step(
        "The reflectivity of the ball",
        "A mirror ball is not a perfect mirror. One photograph shows a white card directly and in the ball; the card "
        "faces the middle between camera and ball. Give a rectangle in each, X,Y,WIDTH,HEIGHT in pixels.",
        [f"chromeball probe reflectivity card.exr --direct {DIRECT} --reflected {REFLECTED}"],
        run.said(*arguments), [("card.jpg", "The card and its reflection at the right side of the ball")],
        [("reflectivity, worst channel", ", ".join(f"{v:.3f}" for v in found),
          ", ".join(f"{v:.3f}" for v in truth), f"{100 * worst:.1f}%")],
        "The truth is the ball's colour by Schlick's formula at the 45 degrees of this reflection.")


def assemble(run, photographs, measured):
    reflectance = ",".join(f"{v:.4f}" for v in measured)
    arguments = ["probe", "assemble", "front.exr", "side.exr", "--azimuth", "0,90", "--distance",
                 place.BALL_DISTANCE, "--schlick", "--reflectivity", reflectance, "-o", "probe.exr"]
    said = run.said(*arguments, "--preview", "assemble.png")
    angle = run.json(*arguments)["views"][1]["azimuth"]
    white = 64000 / camera.SENSITIVITY / min(place.CHROME)
    run("probe", "edit", photographs.truth, "clipped-truth.pfm", "--clip", f"{white:.6g}")
    truth = irradiance(run, "clipped-truth.pfm", "e1.pfm", camera.unit())
    mean, largest = irradiance_error(irradiance(run, "probe.exr", "e2.pfm"), truth)
    run.picture("probe.exr", "probe.jpg", "--exposure", -9.7)
    return Step(
        "The probe",
        "The camera stood before the ball (azimuth 0) and at its right (azimuth 90), ten radii from its centre. In "
        "truth "
        f"it stood at {place.SECOND_AZIMUTH} degrees the second time. Each photograph replaces the camera's "
        f"reflection in "
        "the other one. The circles are found; `--preview` shows them, `--circle` replaces them.",
        ["chromeball probe assemble front.exr side.exr --azimuth 0,90 --distance 10 --schlick \\\n"
         f"  --reflectivity {reflectance} -o probe.exr --preview assemble.png"],
        said, [("probe.jpg", "The probe, as a lat-long map")],
        [("azimuth of the second camera", f"{angle:.2f}", f"{place.SECOND_AZIMUTH}",
          f"{abs(angle - place.SECOND_AZIMUTH):.2f} degrees"),
         ("irradiance without the sun's clipped part, mean / largest", "", "", f"{mean:.2f}% / {largest:.1f}%")],
        "The error of irradiance is over all normals, in percent of the mean irradiance; `probe irradiance` gives "
        "the maps. "
        "The truth is clipped at the white of the darkest exposure; most of the error is next to the sun, which is "
        "wider in "
        "pixels of the ball than in the truth. Step 5 replaces it. A real ball of chrome has `--ball-ior "
        "3.18,3.31` in "
        "place of `--schlick`, which is what rendered balls do.")


def sun(run, photographs):
    paint = ",".join(map(str, place.GREY))
    radius = place.GREY_SIZE / 2 / 1.1
    circle = f"{place.GREY_SIZE / 2:g},{place.GREY_SIZE / 2:g},{radius:.2f}"
    arguments = ["probe", "sun", "probe.exr", "--diffuse", "grey.exr", "--circle", circle, "--paint", paint, "--camera",
                 "0,0", "--distance", place.BALL_DISTANCE, "-o", "sunny.exr"]
    said = run.said(*arguments)
    found = run.json(*arguments)
    unit = camera.unit()
    truth = irradiance(run, photographs.truth, "e1.pfm", unit)
    clipped, sunny = irradiance(run, "probe.exr", "e2.pfm"), irradiance(run, "sunny.exr", "e3.pfm")
    before, after = irradiance_error(clipped, truth), irradiance_error(sunny, truth)
    direction = found["direction"]
    lost = [a - b for a, b in zip(at_direction(truth, direction), at_direction(clipped, direction))]
    real = run.json("probe", "info", photographs.truth)["suns"][0]["direction"]
    angle = angle_between(direction, real)
    worst = max(abs(a / b - 1) for a, b in zip(found["irradiance"], lost))
    run.picture("grey.exr", "grey.jpg", "--exposure", -9)
    return Step(
        "The sun",
        "The shortest exposure is white in the sun: its irradiance is lost. A grey matte ball in the same light, "
        "photographed with the same camera, shows it: what the probe does not explain of its radiance is the sun's. "
        "`--paint` is the reflectance of the ball; `probe reflectivity` measures it against a standard.",
        [f"chromeball probe sun probe.exr --diffuse grey.exr --circle {circle} --paint {paint} \\\n"
         f"  --camera 0,0 --distance 10 -o sunny.exr"], said,
        [("grey.jpg", "The grey ball")],
        [("direction of the sun", "", "", f"{angle:.2f} degrees"),
         ("irradiance of the sun, worst channel", ", ".join(f"{v:.0f}" for v in found["irradiance"]),
          ", ".join(f"{v:.0f}" for v in lost), f"{100 * worst:.1f}%"),
         ("irradiance of the probe, mean / largest", "", "", f"{after[0]:.2f}% / {after[1]:.1f}%"),
         ("the same without this step", "", "", f"{before[0]:.0f}% / {before[1]:.0f}%")],
        "The truth of the sun's irradiance is what the clipped probe lacks of the true one on a surface that faces "
        "the sun.")


def angle_between(a, b):
    dot = sum(x * y for x, y in zip(a, b)) / math.hypot(*a) / math.hypot(*b)
    return math.degrees(math.acos(max(-1, min(1, dot))))


def align(run, photographs):
    arguments = ["probe", "align", photographs.truth, "sunny.exr"]
    found = run.json(*arguments)
    quaternion = found["quaternion"]
    angle = 2 * math.degrees(math.acos(min(1, abs(quaternion[3]))))
    return Step(
        "The orientation of the probe",
        "`probe align` compares the probe with another of the same place; here with the true one. The rotation "
        "should be 0.",
        ["chromeball probe align true.pfm "
         "sunny.exr"], run.said(*arguments).replace(str(photographs.truth), "true.pfm"), [],
        [("rotation of the probe", f"{angle:.2f} degrees", "0", f"{angle:.2f} degrees")],
        "The error is a sixth of a texel of the probe. An error of the azimuths that were written down turns the "
        "whole probe. Without a second probe, check the "
        "direction "
        "of the sun against a shadow in the plate.")


def steps(run, photographs):
    first = [response(run, photographs), merge(run, photographs)]
    measured, step = reflectivity(run)
    return [*first, step, assemble(run, photographs, measured), sun(run, photographs), align(run, photographs)]
