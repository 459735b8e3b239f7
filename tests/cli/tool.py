"""The tool from outside: runs it, reads its JSON, and makes small models for it.

    import tool
    class Commands(tool.Case):
        def test_x(self): info = self.json("info", self.city())
"""

import hashlib
import json
import math
import os
import pathlib
import shutil
import struct
import subprocess
import sys
import tempfile
import unittest
import zlib

sys.path.insert(0, str(pathlib.Path(__file__).parents[1] / "support"))

import leaks  # noqa: E402
from leaks import run  # noqa: E402

BINARY = os.path.abspath(sys.argv.pop(1)) if len(sys.argv) > 1 else "crease"
SHARED = pathlib.Path(
    os.environ.get("CREASE_SHARED_DATA", pathlib.Path(__file__).parents[3] / "shared/data"))

SQUARE = "v 0 0 {z}\nv 1 0 {z}\nv 1 1 {z}\nv 0 1 {z}\nf 1 2 3\nf 1 3 4\n"
TETRAHEDRON = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 1 4 3\n"

ONCE = tempfile.TemporaryDirectory(prefix="crease_cli_once_")


def quarters_png(side=32):
    """A picture whose quarters are red, green, then blue, yellow below."""
    palette = bytes([220, 30, 30, 30, 180, 30, 40, 60, 220, 240, 220, 40])
    rows = b"".join(b"\0" + bytes(x * 2 // side + 2 * (y * 2 // side) for x in range(side))
                    for y in range(side))

    def chunk(kind, data):
        return (struct.pack(">I", len(data)) + kind + data +
                struct.pack(">I", zlib.crc32(kind + data)))
    head = struct.pack(">IIBBBBB", side, side, 8, 3, 0, 0, 0)
    return (b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", head) + chunk(b"PLTE", palette) +
            chunk(b"IDAT", zlib.compress(rows)) + chunk(b"IEND", b""))


def digest(path):
    return hashlib.sha256(pathlib.Path(path).read_bytes()).hexdigest()


def png_size(path):
    head = pathlib.Path(path).read_bytes()[:24]
    assert head[:8] == b"\x89PNG\r\n\x1a\n"
    return struct.unpack(">II", head[16:24])


class Case(unittest.TestCase):
    def setUp(self):
        self.folder = pathlib.Path(tempfile.mkdtemp(prefix="crease_cli_"))
        self.addCleanup(shutil.rmtree, self.folder, ignore_errors=True)

    def path(self, name):
        return str(self.folder / name)

    def write(self, name, content):
        data = content if isinstance(content, bytes) else content.encode()
        (self.folder / name).write_bytes(data)
        return self.path(name)

    def run_tool(self, *arguments, exit_status=0):
        done = run([BINARY, *map(str, arguments)])
        self.assertEqual(done.returncode, exit_status,
                         f"crease {' '.join(map(str, arguments))}\n{done.stdout}{done.stderr}")
        self.assertNotIn("OpenGL: ", done.stderr)  # with CREASE_GL_DEBUG
        return done

    def json(self, *arguments, exit_status=0):
        """With --json: standard output is one object, whatever happens."""
        done = self.run_tool(*arguments, "--json", exit_status=exit_status)
        value = json.loads(done.stdout)
        self.assertIsInstance(value, dict)
        return value

    def once(self, name, *command):
        """What this command makes, in a file that ends as the name does: it runs once for all tests."""
        made = pathlib.Path(ONCE.name, hashlib.sha256(repr(command).encode()).hexdigest() + "_" + name)
        if not made.exists():
            self.run_tool(*command, "-o", made)
        return made

    def copied(self, made, name):
        if not os.path.exists(self.path(name)):
            shutil.copyfile(made, self.path(name))
        return self.path(name)

    def once_city(self, triangles):
        return self.once("city.ply", "generate", "city", "--triangles", triangles)

    def city(self, triangles=4000, name="city.ply"):
        return self.copied(self.once_city(triangles), name)

    def painted(self, cells=20, texture="quarters.png"):
        """A wavy sheet in an OBJ with a picture on it, which lies beside it."""
        lines = ["mtllib painted.mtl", "usemtl paint"]
        for j in range(cells + 1):
            for i in range(cells + 1):
                x, y = i / cells, j / cells
                lines.append(f"v {x} {y} {0.01 * math.sin(9 * x) * math.cos(7 * y)}")
                lines.append(f"vt {x} {y}")
        for j in range(cells):
            for i in range(cells):
                a = j * (cells + 1) + i + 1
                corners = (a, a + 1, a + cells + 2, a + cells + 1)
                lines.append("f " + " ".join(f"{c}/{c}" for c in corners))
        self.write("painted.mtl", f"newmtl paint\nKd 1 1 1\nmap_Kd {texture}\n")
        if texture == "quarters.png":
            self.write(texture, quarters_png())
        return self.write("painted.obj", "\n".join(lines) + "\n")

    def built(self, triangles=4000):
        return self.copied(self.once("city.crease", "build", self.once_city(triangles)), "city.crease")

    def has(self, value, *keys):
        for key in keys:
            self.assertIn(key, value)

    def camera(self, name, position, pixels=1):
        return self.write(name, json.dumps({"position": position, "target": [0, 0, 0],
                                            "viewport": [640, 480], "pixels": pixels}).encode())

    def hills_mesh(self, side=160):
        def height(x, y):
            return 3 * math.sin(x / 9) * math.cos(y / 13) + 0.3 * math.sin(x * 1.3 + y) + x * y / 5000

        lines = ["v %d %d %.5f" % (x, y, height(x, y)) for y in range(side) for x in range(side)]
        for y in range(side - 1):
            for x in range(1, side):
                a = y * side + x
                lines += ["f %d %d %d" % (a, a + 1, a + side), "f %d %d %d" % (a + 1, a + side + 1, a + side)]
        hills = pathlib.Path(ONCE.name, f"hills_{side}.obj")
        hills.write_text("\n".join(lines))
        return hills

    def hills(self):
        return self.copied(self.once("hills.crease", "build", self.hills_mesh()), "hills.crease")

    def files(self):
        return sorted(p.name for p in self.folder.iterdir())


def main():
    unittest.main(argv=[sys.argv[0]], verbosity=2)
