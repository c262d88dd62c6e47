# SPDX-License-Identifier: Apache-2.0
"""Part 2: the photographs of a student's course work, in numbers only, because they have no licence."""
import os
import pathlib

from gltf import Model
from page import some_lines
from run import ROOT

FOLDER = "reference/differential_rendering"
TIMES = "1/10,1/40,1/160"
SAMPLES = "bbold72_cs445_samples"
# The record of a run, for machines without the photographs.
RECORD = pathlib.Path(__file__).with_name("course_record.md")
# Edges in empty.jpg: the desk's and the shelf's along the wall (x) and away from it (z), and a post
# (y). The depth of the desk is assumed: 30 inches, a usual size.
LINES = """axis,x1,y1,x2,y2,metres
x,364,1614,2091,2110,
x,1405,1350,2685,1551,
x,725,305,2460,104,
z,2698,1594,2091,2110,0.762
z,2767,200,2523,113,
y,2699,1675,2787,100,
"""
SCENE = """[[model]]
file = "objects.gltf"
translation = [-0.55, 0, 0.4]

[camera]
file = "desk.toml"

[probe]
file = "ball.exr"
scale = "plate"

[composite]
plate = "empty.jpg"
ground = true

[render]
size = [408, 306]
samples = 32

[output]
file = "desk.exr"
"""


def objects(path):
    model = Model()
    model.sphere("ball", model.material((0.9, 0.9, 0.9), 0.1, 1), (-0.08, 0.06, 0), 0.06, 128, 64)
    model.box("box", model.material((0.6, 0.06, 0.05)), (0.03, 0, -0.04), (0.12, 0.09, 0.05), 25)
    model.torus("ring", model.material((0.95, 0.7, 0.3), 0.25, 1), (-0.02, 0.022, 0.12), 0.05, 0.022)
    model.write(path)


def fenced(text):
    return f"```text\n{text}\n```"


def indented(text):
    return "\n".join("    " + line if line else "" for line in text.splitlines())


def data():
    folder = pathlib.Path(os.environ.get("CHROMEBALL_DATA", "")) / FOLDER
    return folder if "CHROMEBALL_DATA" in os.environ and folder.is_dir() else None


def text(run, record=RECORD):
    """Reads the record if there are no photographs; otherwise writes `record`."""
    folder = data()
    if not folder:
        print("        no course data in $CHROMEBALL_DATA: the record of an earlier run is used")
        return RECORD.read_text().rstrip()
    materials = folder / "kartikagrawal27" / "Materials"
    for name in ("10.JPG", "40.JPG", "160.JPG", "empty.jpg"):
        (run.scratch / name).unlink(missing_ok=True)
        (run.scratch / name).symlink_to(materials / name)
    made = "\n\n".join([*exposures(run), *ball(run), *camera(run), *composite(run), *merged(run, folder / SAMPLES)])
    record.write_text(made + "\n")
    return made


def exposures(run):
    photographs = ["10.JPG", "40.JPG", "160.JPG"]
    common = ["probe", "merge", *photographs, "--exposures", TIMES, "-o", "merged.exr"]
    sizes = run.said(*common, fails=True)
    shifted = run.said(*common, "--resize", fails=True)
    said = run.said(*common, "--resize", "--unaligned")
    solved = run.said(*common, "--resize", "--unaligned", "--response", "solve", fails=True)
    run(*common, "--resize", "--unaligned")
    return [
        "## Part 2: photographs of a course work",
        "Photographs with which a student made a composite: three exposures of a mirror ball, cropped by hand, and "
        "a plate "
        "of an office desk. They have no licence, so this part has numbers only. It needs "
        f"`$CHROMEBALL_DATA/{FOLDER}`. It shows what to expect of photographs that were not taken for this program.",
        "### Merge",
        "The crops have EXIF; the times are given here too. They have three sizes:",
        indented(f"chromeball probe merge 10.JPG 40.JPG 160.JPG --exposures {TIMES} -o merged.exr"), fenced(sizes),
        "`--resize` takes them as crops of one ball. They were cropped by hand, so they are shifted "
        "too:", fenced(shifted),
        "With `--resize --unaligned` they merge, and the program says what is wrong with them:", fenced(said),
        "Neighbouring exposures disagree: the phone has its own tone curve, which may change from one picture to "
        "the next, and "
        "the crops are not aligned to a pixel. The response cannot be solved from them:", fenced(solved),
        "Use a tripod, manual exposure, and crop after the merge, not before."]


def ball(run):
    command = ["probe", "assemble", "merged.exr", "--azimuth", "0:30", "--circle", "244.61,229.94,239.14",
               "--reflectivity", "0.6", "-o", "ball.exr"]
    said = run.said(*command)
    info = some_lines(run.said("probe", "info", "ball.exr"), "dynamic", "clipped", "brightest 10 ", "suns")
    return ["### The probe", "There is one photograph, from above: with an elevation of 30 degrees the horizon of "
                             "the probe is "
            "level. The reflectivity is assumed. The crops, which are not aligned, blur the outline so much that "
            "the search refuses it; the circle is given.",
            indented("chromeball " + " ".join(command)), fenced(said),
            "One photograph shows the camera in its middle, and what is behind the ball as a few stretched pixels "
            "at its rim. "
            "The crop cuts the ball. `probe info` says of the result:", fenced(info)]


def camera(run):
    (run.scratch / "lines.csv").write_text(LINES)
    objects(run.scratch / "objects.gltf")
    command = ["camera", "solve", "objects.gltf", "empty.jpg", "--lines", "lines.csv", "-o", "desk.toml"]
    said = run.said(*command)
    return ["### The camera", "Nobody measured points on this desk. Its edges are enough: two lines or more along "
                              "each of two "
            "axes. The ends were read off the photograph by eye, at four times its size. The scale is that of "
            "one line of known length; here the depth of the desk is assumed to be 0.762 m, a usual size. lines.csv:",
            indented(LINES), indented("chromeball " + " ".join(command)), fenced(said),
            "The EXIF of the plate says 33 mm on 35 mm film: the field of view is right. Without "
            "points, distortion cannot be found, and a wrong length scales the position in proportion."]


def composite(run):
    (run.scratch / "desk-scene.toml").write_text(SCENE)
    said = run.said("render", "desk-scene.toml")
    return ["### The composite", "A ground at the height of the desk's top is the whole local scene. The plate is "
                                 "another place "
            "than the ball's, taken by another camera, so `scale = \"plate\"` takes the brightness of the light "
            "from the "
            "plate. The objects are a ball, a box and a ring of 10 cm. desk-scene.toml:", indented(SCENE),
            indented("chromeball render desk-scene.toml"), fenced(said),
            "The picture shows objects that stand on the desk in the right perspective, with grey, soft shadows. "
            "There is no truth to measure its light by: the ball was in another room. The light's scale and "
            "colour are those of the desk around the objects, of which the photograph tells that it is half as "
            "bright as a white surface; of all that the camera sees below the horizon most is not the desk. A "
            "grey desk turns its colour into a colour of the light: if it is known to be bluish, say so "
            "(`ground_reflectance = [0.45, 0.5, 0.55]`)."]


def merged(run, folder):
    rows = []
    for name in ("naive_hdr", "weighted_hdr", "calib_hdr", "img_hdr"):
        said = run.said("probe", "info", folder / f"{name}.hdr")
        rows.append(f"{name + '.hdr':18}{some_lines(said, 'dynamic')[17:]}")
    return ["### Merged images of another course work",
            f"`{SAMPLES}` has one ball, merged by its author in four ways. `probe info` reads them as mirror balls "
            f"and tells their "
            "dynamic range:", fenced("\n".join(rows)),
            "None exceeds 13 : 1, less than one photograph holds, and the largest number is below 1: these images "
            "were scaled for "
            "display. For lighting, merge the exposures again."]
