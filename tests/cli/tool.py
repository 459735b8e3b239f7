"""The tool from outside: runs it, reads its JSON, and makes small models for it.

    import tool
    class Commands(tool.Case):
        def test_x(self): info = self.json("info", self.city())
"""

import json
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile
import unittest

BINARY = os.path.abspath(sys.argv.pop(1)) if len(sys.argv) > 1 else "crease"
SHARED = pathlib.Path(
    os.environ.get("CREASE_SHARED_DATA", pathlib.Path(__file__).parents[3] / "shared/data"))

SQUARE = "v 0 0 {z}\nv 1 0 {z}\nv 1 1 {z}\nv 0 1 {z}\nf 1 2 3\nf 1 3 4\n"
TETRAHEDRON = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 1 4 3\n"


# Of the leak checker's own tracer, now and then while the threads of an OpenGL driver end: it has
# looked for no leak, and ends the process with a status of its own.
LEAK_CHECK_FAILED = "LeakSanitizer has encountered a fatal error"


def run(command, environment=None, timeout=None):
    """The finished command; once more without the leak checker if that is what failed."""
    environment = dict(environment or os.environ)
    for _ in range(2):
        done = subprocess.run(command, capture_output=True, text=True, errors="replace",
                              env=environment, timeout=timeout)
        if LEAK_CHECK_FAILED not in done.stderr:
            break
        options = environment.get("ASAN_OPTIONS")
        environment["ASAN_OPTIONS"] = (options + ":" if options else "") + "detect_leaks=0"
    return done


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
        return done

    def json(self, *arguments, exit_status=0):
        """With --json: standard output is one object, whatever happens."""
        done = self.run_tool(*arguments, "--json", exit_status=exit_status)
        value = json.loads(done.stdout)
        self.assertIsInstance(value, dict)
        return value

    def city(self, triangles=4000, name="city.ply"):
        path = self.path(name)
        if not os.path.exists(path):
            self.json("generate", "city", "-o", path, "--triangles", triangles)
        return path

    def built(self, triangles=4000):
        path = self.path("city.crease")
        if not os.path.exists(path):
            self.json("build", self.city(triangles), "-o", path)
        return path

    def files(self):
        return sorted(p.name for p in self.folder.iterdir())


def main():
    unittest.main(argv=[sys.argv[0]], verbosity=2)
