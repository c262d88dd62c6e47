# SPDX-License-Identifier: Apache-2.0
"""Images as rows of (r, g, b) or numbers: reads the layers of .exr, writes .png and .pfm."""
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


class Exr:
    """The layers of a file of the program: scanlines of float32 or half, ZIP (OpenEXR's documentation)."""

    def __init__(self, path):
        with open(path, "rb") as file:
            self.data = file.read()
        self.at, header = 8, {}
        while name := self._text():
            kind, (size,) = self._text(), self._take("<i")
            header[name] = self.data[self.at:self.at + size]
            self.at += size
            assert kind
        left, top, right, bottom = struct.unpack("<4i", header["dataWindow"])
        self.width, self.height = right - left + 1, bottom - top + 1
        assert header["compression"] in (b"\2", b"\3"), "ZIP"
        self.channels = list(self._channels(header["channels"]))
        self._read(1 if header["compression"] == b"\2" else 16, top)

    def _text(self):
        end = self.data.index(b"\0", self.at)
        text, self.at = self.data[self.at:end].decode(), end + 1
        return text

    def _take(self, form):
        values = struct.unpack_from(form, self.data, self.at)
        self.at += struct.calcsize(form)
        return values

    @staticmethod
    def _channels(data):
        at = 0
        while data[at]:
            end = data.index(b"\0", at)
            yield data[at:end].decode(), {1: "e", 2: "f"}[data[end + 1]]
            at = end + 17

    def _read(self, lines, top):
        self.planes = {name: [None] * self.height for name, _ in self.channels}
        count = (self.height + lines - 1) // lines
        for offset in self._take(f"<{count}Q"):
            y, size = struct.unpack_from("<ii", self.data, offset)
            block, at = self._block(self.data[offset + 8:offset + 8 + size], min(lines, self.height - y + top)), 0
            for row in range(y - top, min(y - top + lines, self.height)):
                for name, form in self.channels:
                    self.planes[name][row] = struct.unpack_from(f"<{self.width}{form}", block, at)
                    at += struct.calcsize(f"<{self.width}{form}")

    def _block(self, packed, lines):
        raw = lines * self.width * sum(struct.calcsize("<" + form) for _, form in self.channels)
        if len(packed) == raw:
            return packed
        coded = bytearray(zlib.decompress(packed))
        for i in range(1, len(coded)):
            coded[i] = (coded[i] + coded[i - 1] - 128) & 255
        half = (len(coded) + 1) // 2
        plain = bytearray(len(coded))
        plain[0::2], plain[1::2] = coded[:half], coded[half:]
        return bytes(plain)

    def color(self, layer=""):
        """Rows of (r, g, b) of a layer of three channels, or of the image."""
        planes = [self.planes[(layer + "." if layer else "") + c] for c in "RGB"]
        return [list(zip(*rows)) for rows in zip(*planes)]

    def plane(self, layer):
        """Rows of numbers of a layer of one channel."""
        return next(self.planes[name] for name, _ in self.channels if name.split(".")[0] == layer)
