# SPDX-License-Identifier: Apache-2.0
"""Pictures that the program does not make: the response, and photographs beside each other."""
import camera
import jpeg
import pixels

COLORS = ["#c33", "#393", "#33c"]


def response_plot(path, found):
    """`found`: for each level the true levels of the exposures that the solved response gives, per channel."""
    size, left, top = 240, 34, 8

    def curve(points, color, width):
        text = " ".join(f"{left + size * x:.1f},{top + size * (1 - y):.1f}" for x, y in points)
        return f'<polyline points="{text}" fill="none" stroke="{color}" stroke-width="{width}"/>'

    lines = [curve([(camera.exposure_of(level / 255), level / 255) for level in range(256)], "#000", 2.4)]
    for c in range(3):
        lines.append(curve([(camera.exposure_of(min(row[c], 255) / 255), level / 255)
                            for level, row in enumerate(found)], COLORS[c], 1))
    labels = [f'<text x="{left - 6}" y="{top + 10}" text-anchor="end">255</text>',
              f'<text x="{left - 6}" y="{top + size}" text-anchor="end">0</text>',
              f'<text x="{left}" y="{top + size + 15}">0</text>',
              f'<text x="{left + size}" y="{top + size + 15}" text-anchor="end">white</text>',
              f'<text x="{left + size / 2}" y="{top + size + 15}" text-anchor="middle">exposure</text>']
    path.write_text(
        f'<svg xmlns="http://www.w3.org/2000/svg" width="{left + size + 10}" height="{top + size + 22}" '
        f'font-family="sans-serif" font-size="11"><rect width="100%" height="100%" fill="#fff"/>'
        f'<rect x="{left}" y="{top}" width="{size}" height="{size}" fill="none" stroke="#999"/>'
        + "".join(lines + labels) + "</svg>\n")
    return path.name


def contact_sheet(run, names, picture, step=2):
    """8-bit photographs beside each other, at 1 / `step` of their size."""
    sheets = []
    for name in names:
        rows = pixels.read_png(run.scratch / name)
        sheets.append([row[::step] for row in rows[::step]])
    jpeg.write(run.pictures / picture, [[p for row in rows for p in row] for rows in zip(*sheets)])
    return picture
