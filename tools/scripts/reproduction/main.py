# SPDX-License-Identifier: Apache-2.0
"""Makes the reproduction page; see ../reproduce.sh."""
import argparse
import pathlib
import tempfile
import time

import approximations
import capture
import film
import formulas
import gallery
import lights
import optics
import probes
import rendering
import scenes
import shadows
import stage
import suns
import transfer
from page import page
from run import ROOT, Run

SECTIONS = [("Lights in place of a probe", [lights.rows, shadows.rows]),
            ("Probes", [probes.rows, capture.rows]), ("Sampling a probe", [gallery.temple, rendering.rows]),
            ("Suns", [suns.rows]), ("Optics", [optics.rows]), ("Cheaper answers", [approximations.rows]),
            ("Relighting", [stage.rows, transfer.rows]), ("Films", [film.rows]),
            ("Composites and rooms", [scenes.rows, formulas.rows, gallery.rows])]


def main():
    options = argparse.ArgumentParser(description=__doc__)
    options.add_argument("--out", type=pathlib.Path, help="a folder, in place of docs/measured/ and scenes/gallery/")
    out = options.parse_args().out
    docs = out or ROOT / "docs" / "measured"
    pictures = out or ROOT / "scenes" / "gallery" / "reproduction"
    for folder in (docs, pictures):
        folder.mkdir(parents=True, exist_ok=True)
    start = time.monotonic()
    with tempfile.TemporaryDirectory() as scratch:
        run = Run(scratch, pictures.resolve())
        sections = []
        for title, parts in SECTIONS:
            print(f"{time.monotonic() - start:5.0f} s  {title}", flush=True)
            sections.append((title, [row for rows in parts for row in rows(run)]))
    text = page(sections, sorted(run.missing), time.monotonic() - start,
                "." if out else "../../scenes/gallery/reproduction")
    (docs / "reproduction.md").write_text(text)
    print(f"{time.monotonic() - start:5.0f} s  {docs / 'reproduction.md'}")


if __name__ == "__main__":
    main()
