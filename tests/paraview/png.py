"""Reads the 8-bit RGB and RGBA files that ParaView writes, with nothing but Python."""
import struct
import zlib
from collections import Counter


def colours(path):
    """How many pixels there are of each (red, green, blue)."""
    with open(path, "rb") as file:
        data = file.read()
    if data[:8] != b"\x89PNG\r\n\x1a\n":
        raise ValueError(f"{path}: not a PNG")
    at, packed = 8, b""
    while at < len(data):
        length, kind = struct.unpack(">I4s", data[at:at + 8])
        body = data[at + 8:at + 8 + length]
        if kind == b"IHDR":
            width, height, depth, colour_type = struct.unpack(">IIBB", body[:10])
        elif kind == b"IDAT":
            packed += body
        at += length + 12
    size = {(8, 2): 3, (8, 6): 4}[depth, colour_type]
    raw, row = zlib.decompress(packed), width * size
    above, counts = bytearray(row), Counter()
    for y in range(height):
        start = y * (row + 1)
        line = unfilter(raw[start], bytearray(raw[start + 1:start + 1 + row]), above, size)
        counts.update(zip(line[0::size], line[1::size], line[2::size]))
        above = line
    return counts


def unfilter(kind, line, above, size):
    for i in range(len(line) if kind else 0):
        left = line[i - size] if i >= size else 0
        corner = above[i - size] if i >= size else 0
        if kind == 1:
            guess = left
        elif kind == 2:
            guess = above[i]
        elif kind == 3:
            guess = (left + above[i]) // 2
        else:  # Paeth
            p = left + above[i] - corner
            guess = min((left, above[i], corner), key=lambda value: abs(p - value))
        line[i] = (line[i] + guess) & 255
    return line
