# SPDX-License-Identifier: Apache-2.0
"""Rows of the reproduction page, and the page as Markdown."""
from dataclasses import dataclass, field


@dataclass
class Row:
    """A figure or a statement of a source, and what the program has for it."""

    title: str
    source: str  # what the source shows or says
    commands: list
    ours: str  # Markdown: numbers, perhaps a table
    why: str  # why they differ
    pictures: list = field(default_factory=list)  # (file name, what it shows)


def table(head, rows):
    def line(cells):
        return "| " + " | ".join(map(str, cells)) + " |"

    lines = [line(head), "| --- |" + " ---: |" * (len(head) - 1)]
    lines += [line(row) for row in rows]
    return "\n".join(lines)


def row_text(row, picture_folder):
    gap = "\n\n" if row.ours.startswith(("|", "- ")) else " "  # tables and lists start a paragraph
    parts = [f"### {row.title}", f"**Source.** {row.source}", f"**Here.**{gap}{row.ours}"]
    if row.commands:
        parts.append("\n".join("    " + command for command in row.commands))
    if row.why:
        parts.append(f"**Difference.** {row.why}")
    parts += [f"![{text}]({picture_folder}/{name})\n\n{text}" for name, text in row.pictures]
    return "\n\n".join(parts)


INTRODUCTION = """# Reproduction of the sources

What three sources show, beside what this program computes:

- HDRI: Reinhard et al., "High Dynamic Range Imaging", chapter 9, "Image-Based Lighting" (figures 9.x);
- ML07: Madsen and Laursen, "Performance Comparison of Techniques for Approximating Image-Based
  Lighting by Directional Light Sources" (2007);
- M03: Madsen et al., "Estimating Positions and Radiances of a Small Number of Light Sources for Real-Time
  Image-Based Lighting" (2003).

`tools/scripts/reproduce.sh` makes this page, with the scenes and images that are named without a folder. Debevec's probes may be used for research; their numbers are given
here, and pictures are only of probes that may be copied: those of Poly Haven and of this project (CC0)."""


WITHOUT = """## Figures without a row

- 9.11, a panorama of two rows of nine photographs: `probe stitch` makes a probe of such tiles ([stitching](../methods.md#stitching-tiles)),
  and tests prove it on tiles that the program renders; the photographs are not published.
- 9.12 and 9.42 show cameras and lamps; 9.20 is a drawing of rays, which [the path tracer](../architecture.md) follows.
- 9.13, the exposures of a sky through a fisheye lens: `probe merge` and `probe assemble` do what the text describes, and
  are proved on exposures that the program renders; the photographs are not published.
- The subjects of 9.21 (a pot), 9.31 (a statue), 9.34 (a kitchen), 9.43 (a face) and 9.46 (a bust, an armadillo, teapots) belong to others; the rows
  have scenes of this project in their place."""


def page(sections, missing, seconds, picture_folder):
    parts = [INTRODUCTION]
    for title, rows in sections:
        parts.append(f"## {title}")
        parts += [row_text(row, picture_folder) for row in rows]
    parts.append(WITHOUT)
    if missing:
        parts.append("## Left out\n\nThese are not in `$CHROMEBALL_DATA`: " + ", ".join(missing) + ".")
    parts.append(f"Made in {seconds / 60:.0f} minutes.")
    return "\n\n".join(parts) + "\n"
