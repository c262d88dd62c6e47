# SPDX-License-Identifier: Apache-2.0
"""Makes docs/capture.md; see ../capture_tutorial.sh."""
import argparse
import pathlib
import tempfile
import time

import course
import light
import plate
from page import page
from run import ROOT, Run
from simulate import Photographs

PLACE = """The place has the light of `true.pfm`: the project's noon with a row of houses and stones on the ground. chromeball
renders what a camera sees there. The script makes photographs of it: noise of the light and of the sensor, an
S-shaped response, 8 bits, EXIF. The balls float: they were photographed where the set was built later. The plate's
lens has distortion and darkens the corners."""


def main():
    options = argparse.ArgumentParser(description=__doc__)
    options.add_argument("--out", type=pathlib.Path, help="a folder, in place of docs/")
    options.add_argument("--scratch", type=pathlib.Path,
                         help="keep the files in this folder, and use its photographs again")
    given = options.parse_args()
    docs = given.out or ROOT / "docs"
    pictures = docs / "pictures" / "capture"
    pictures.mkdir(parents=True, exist_ok=True)
    start = time.monotonic()

    def tell(what):
        print(f"{time.monotonic() - start:5.0f} s  {what}", flush=True)

    with tempfile.TemporaryDirectory() as temporary:
        scratch = (given.scratch or pathlib.Path(temporary)).resolve()
        scratch.mkdir(parents=True, exist_ok=True)
        run = Run(scratch, pictures.resolve())
        tell("photographs")
        photographs = Photographs(run)
        tell("light")
        steps = light.steps(run, photographs)
        tell("plate")
        steps += plate.steps(run, photographs)
        tell("course data")
        real = course.text(run, given.out / course.RECORD.name if given.out else course.RECORD)
    (docs / "capture.md").write_text(page(PLACE, steps, real, "pictures/capture"))
    tell(docs / "capture.md")


if __name__ == "__main__":
    main()
