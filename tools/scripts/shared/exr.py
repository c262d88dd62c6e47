# SPDX-License-Identifier: Apache-2.0
"""Reads the layers of .exr images."""
import struct
import zlib


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
