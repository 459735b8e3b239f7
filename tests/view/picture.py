"""PNG pictures as the tool writes them: 8 bits a component, not interlaced."""

import pathlib
import struct
import zlib


class Picture:
    def __init__(self, path):
        data = pathlib.Path(path).read_bytes()
        assert data[:8] == b"\x89PNG\r\n\x1a\n"
        at, packed = 8, b""
        while at < len(data):
            size, kind = struct.unpack(">I4s", data[at:at + 8])
            body = data[at + 8:at + 8 + size]
            if kind == b"IHDR":
                self.width, self.height, depth, color, _, _, interlace = struct.unpack(
                    ">IIBBBBB", body)
                assert depth == 8 and color in (2, 6) and interlace == 0
                self.components = 3 if color == 2 else 4
            elif kind == b"IDAT":
                packed += body
            at += 12 + size
        self.rows = self._unfilter(zlib.decompress(packed))

    def _unfilter(self, raw):
        step, length = self.components, self.components * self.width
        rows, above = [], bytearray(length)
        for y in range(self.height):
            kind = raw[y * (length + 1)]
            row = bytearray(raw[y * (length + 1) + 1:(y + 1) * (length + 1)])
            if kind == 1:
                for i in range(step, length):
                    row[i] = (row[i] + row[i - step]) & 255
            elif kind == 2:
                row = bytearray((a + b) & 255 for a, b in zip(row, above))
            elif kind == 3:
                for i in range(length):
                    left = row[i - step] if i >= step else 0
                    row[i] = (row[i] + (left + above[i]) // 2) & 255
            elif kind == 4:
                for i in range(length):
                    left, corner = (row[i - step], above[i - step]) if i >= step else (0, 0)
                    up = above[i]
                    guess = left + up - corner
                    nearest = min((abs(guess - left), 0, left), (abs(guess - up), 1, up),
                                  (abs(guess - corner), 2, corner))[2]
                    row[i] = (row[i] + nearest) & 255
            rows.append(row)
            above = row
        return rows

    def pixel(self, x, y):
        at = x * self.components
        return tuple(self.rows[y][at:at + 3])

    def row_colors(self, y):
        row, n = self.rows[y], self.components
        return zip(row[0::n], row[1::n], row[2::n])


def differing(a, b, tolerance):
    """The share of pixels that differ by more in a component."""
    assert (a.width, a.height) == (b.width, b.height)
    count = 0
    for y in range(a.height):
        for p, q in zip(a.row_colors(y), b.row_colors(y)):
            if abs(p[0] - q[0]) > tolerance or abs(p[1] - q[1]) > tolerance or \
               abs(p[2] - q[2]) > tolerance:
                count += 1
    return count / (a.width * a.height)


def covered(picture):
    """The share of pixels that are not the background, which is nearly grey."""
    count = 0
    for y in range(picture.height):
        background = picture.pixel(0, y)
        count += sum(1 for p in picture.row_colors(y)
                     if max(abs(p[i] - background[i]) for i in range(3)) > 8)
    return count / (picture.width * picture.height)
