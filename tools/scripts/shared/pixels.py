# SPDX-License-Identifier: Apache-2.0
"""Images as rows of (r, g, b): reads and writes .png, writes .pfm."""
import array
import struct
import sys
import zlib


def write_pfm(path, rows):
    values = array.array("f", (value for row in rows[::-1] for pixel in row for value in pixel))
    if sys.byteorder == "big":
        values.byteswap()
    with open(path, "wb") as file:
        file.write(f"PF\n{len(rows[0])} {len(rows)}\n-1.0\n".encode() + values.tobytes())


def write_png(path, rows, exif=b""):
    """`rows`: [y][x] = (r, g, b) of 0 to 255. `exif`: a TIFF block."""
    def chunk(name, data):
        return struct.pack(">I", len(data)) + name + data + struct.pack(">I", zlib.crc32(name + data))

    lines = b"".join(b"\0" + bytes(level for pixel in row for level in pixel) for row in rows)
    header = struct.pack(">IIBBBBB", len(rows[0]), len(rows), 8, 2, 0, 0, 0)
    with open(path, "wb") as file:
        file.write(b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", header) + (chunk(b"eXIf", exif) if exif else b"")
                   + chunk(b"IDAT", zlib.compress(lines, 9)) + chunk(b"IEND", b""))


def read_png(path):
    """Of 8 bits, (r, g, b), without an alpha channel or interlacing."""
    data, at, packed = path.read_bytes(), 8, b""
    while at < len(data):
        size, name = struct.unpack_from(">I4s", data, at)
        body = data[at + 8:at + 8 + size]
        if name == b"IHDR":
            width, height = struct.unpack_from(">II", body)
            assert body[8:] == b"\10\2\0\0\0", "8 bits, RGB"
        packed += body if name == b"IDAT" else b""
        at += size + 12
    lines, stride = zlib.decompress(packed), 3 * width + 1
    rows, above = [], bytes(3 * width)
    for y in range(height):
        above = _unfiltered(lines[y * stride], bytearray(lines[y * stride + 1:(y + 1) * stride]), above)
        rows.append([tuple(above[3 * x:3 * x + 3]) for x in range(width)])
    return rows


def _unfiltered(kind, line, above):
    """The filters of PNG, section 9."""
    for i in range(len(line)):
        a, b, c = (line[i - 3] if i > 2 else 0), above[i], (above[i - 3] if i > 2 else 0)
        if kind == 1:
            guess = a
        elif kind == 2:
            guess = b
        elif kind == 3:
            guess = (a + b) // 2
        elif kind == 4:
            guess = min((a, b, c), key=lambda v: abs(a + b - c - v))
        else:
            break
        line[i] = (line[i] + guess) & 255
    return bytes(line)


def exif(seconds, f_number, iso):
    """The block of a photograph; `seconds` as (numerator, denominator)."""
    first = b"MM" + struct.pack(">HIHHHIII", 42, 8, 1, 0x8769, 4, 1, 26, 0)
    values = 26 + 2 + 3 * 12 + 4
    return (first + struct.pack(">H", 3) + struct.pack(">HHII", 0x829a, 5, 1, values)
            + struct.pack(">HHII", 0x829d, 5, 1, values + 8) + struct.pack(">HHIHH", 0x8827, 3, 1, iso, 0)
            + struct.pack(">I", 0) + struct.pack(">IIII", *seconds, f_number, 1))
