# SPDX-License-Identifier: Apache-2.0
"""Writes baseline JPEG (ITU-T T.81) without subsampling, with Huffman codes made for the image."""
import heapq
import math
import struct

LUMA = [16, 11, 10, 16, 24, 40, 51, 61, 12, 12, 14, 19, 26, 58, 60, 55, 14, 13, 16, 24, 40, 57, 69, 56, 14, 17, 22, 29,
        51, 87, 80, 62, 18, 22, 37, 56, 68, 109, 103, 77, 24, 35, 55, 64, 81, 104, 113, 92, 49, 64, 78, 87, 103, 121,
        120, 101, 72, 92, 95, 98, 112, 100, 103, 99]  # table K.1
ZIGZAG = sorted(range(64), key=lambda i: (i // 8 + i % 8, i // 8 if (i // 8 + i % 8) % 2 else i % 8))
BASIS = [[math.cos((2 * x + 1) * u * math.pi / 16) / (2 * math.sqrt(2) if u == 0 else 2) for x in range(8)]
         for u in range(8)]


def _planes(rows):
    """Y, Cb and Cr, around 0, of a size that blocks fill."""
    rows = [row + [row[-1]] * (-len(row) % 8) for row in map(list, rows)]
    rows += [rows[-1]] * (-len(rows) % 8)
    return [[[0.299 * r + 0.587 * g + 0.114 * b - 128 for r, g, b in row] for row in rows],
            [[-0.168736 * r - 0.331264 * g + 0.5 * b for r, g, b in row] for row in rows],
            [[0.5 * r - 0.418688 * g - 0.081312 * b for r, g, b in row] for row in rows]]


def _transform(block):
    lines = [[sum(a * b for a, b in zip(line, base)) for base in BASIS] for line in block]
    columns = list(zip(*lines))
    return [sum(a * b for a, b in zip(columns[u], BASIS[v])) for v in range(8) for u in range(8)]


def _symbols(values, before):
    """(table, symbol, bits, their number) of a block in zigzag order: table 0 for the mean, 1 for the rest."""
    def coded(value):
        size = abs(value).bit_length()
        return size, value if value > 0 else value + (1 << size) - 1

    size, bits = coded(values[0] - before)
    yield 0, size, bits, size
    zeros, last = 0, max((i for i in range(64) if values[i]), default=0)
    for value in values[1:last + 1]:
        if value == 0:
            zeros += 1
            continue
        while zeros > 15:
            yield 1, 0xf0, 0, 0
            zeros -= 16
        size, bits = coded(value)
        yield 1, zeros << 4 | size, bits, size
        zeros = 0
    if last < 63:
        yield 1, 0, 0, 0


def _code_lengths(counts):
    """Huffman's, of at most 16 bits; a symbol -1 takes the code of ones alone, which is not allowed."""
    counts = dict(counts)
    while True:
        heap = [(count, i, [symbol]) for i, (symbol, count) in enumerate(counts.items())] + [(0, -1, [-1])]
        heapq.heapify(heap)
        lengths = dict.fromkeys([*counts, -1], 0)
        number = len(heap)
        while len(heap) > 1:
            (a, _, first), (b, _, second) = heapq.heappop(heap), heapq.heappop(heap)
            for symbol in first + second:
                lengths[symbol] += 1
            heapq.heappush(heap, (a + b, number, first + second))
            number += 1
        if max(lengths.values()) <= 16:
            return lengths
        counts = {symbol: count // 2 + 1 for symbol, count in counts.items()}


def _huffman(counts):
    """(The table as the file has it, symbol -> (code, length))."""
    lengths = _code_lengths(counts)
    order = sorted(counts, key=lambda symbol: (lengths[symbol], symbol))
    longest = max(lengths.values())
    lengths_of_file = [sum(1 for s in order if lengths[s] == n) for n in range(1, 17)]
    assert longest == lengths[-1]
    codes, code, length = {}, 0, 0
    for symbol in order:
        code <<= lengths[symbol] - length
        length = lengths[symbol]
        codes[symbol] = code, length
        code += 1
    return bytes(lengths_of_file) + bytes(order), codes


def _marker(code, data):
    return struct.pack(">BBH", 255, code, len(data) + 2) + data


def write(path, rows, quality=85):
    """`rows`: [y][x] = (r, g, b) of 0 to 255."""
    scale = 5000 / quality if quality < 50 else 200 - 2 * quality
    steps = [max(1, min(255, int((q * scale + 50) / 100))) for q in LUMA]
    planes, stream, counts = _planes(rows), [], ({}, {})
    before = [0, 0, 0]
    for y in range(0, len(planes[0]), 8):
        for x in range(0, len(planes[0][0]), 8):
            for c, plane in enumerate(planes):
                values = _transform([line[x:x + 8] for line in plane[y:y + 8]])
                values = [round(values[i] / steps[i]) for i in ZIGZAG]
                for symbol in _symbols(values, before[c]):
                    stream.append(symbol)
                    counts[symbol[0]][symbol[1]] = counts[symbol[0]].get(symbol[1], 0) + 1
                before[c] = values[0]
    tables = [_huffman(count) for count in counts]
    bits = "".join(f"{tables[t][1][s][0]:0{tables[t][1][s][1]}b}" + (f"{value:0{size}b}" if size else "")
                   for t, s, value, size in stream)
    bits += "1" * (-len(bits) % 8)
    packed = int(bits, 2).to_bytes(len(bits) // 8, "big").replace(b"\xff", b"\xff\0")
    frame = struct.pack(">BHHB", 8, len(rows), len(rows[0]), 3) + b"".join(bytes([c, 0x11, 0]) for c in (1, 2, 3))
    scan = b"\3" + b"".join(bytes([c, 0]) for c in (1, 2, 3)) + b"\0\x3f\0"
    with open(path, "wb") as file:
        file.write(b"\xff\xd8" + _marker(0xe0, b"JFIF\0\1\1\0\0\1\0\1\0\0")
                   + _marker(0xdb, b"\0" + bytes(steps[i] for i in ZIGZAG)) + _marker(0xc0, frame)
                   + _marker(0xc4, b"\0" + tables[0][0]) + _marker(0xc4, b"\x10" + tables[1][0]) + _marker(0xda, scan)
                   + packed + b"\xff\xd9")
