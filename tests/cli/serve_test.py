"""`crease serve`, and the commands that read what it serves."""

import contextlib
import json
import os
import re
import shutil
import signal
import subprocess
import urllib.error
import urllib.request

import tool

os.environ["no_proxy"] = "127.0.0.1,localhost"


class Serve(tool.Case):
    @contextlib.contextmanager
    def served(self, *options):
        """The address of a server on our folder, and the process."""
        process = subprocess.Popen([tool.BINARY, "serve", str(self.folder), "--json", *options],
                                   stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
        try:
            text = ""
            while not text.endswith("}\n"):
                line = process.stdout.readline()
                if not line:
                    self.fail(f"it ended: {text}{process.stderr.read()}")
                text += line
            yield json.loads(text)["url"], process
        finally:
            process.kill()
            process.communicate()

    def test_it_prints_one_object_when_ready_and_ends_with_130(self):
        for number in (signal.SIGINT, signal.SIGTERM):
            with self.served() as (url, process):
                self.assertRegex(url, r"^http://127\.0\.0\.1:\d+/$")
                self.built()
                with urllib.request.urlopen(url + "?json") as answer:
                    listed = json.load(answer)
                self.assertEqual([f["name"] for f in listed["files"]], ["city.crease"])
                with contextlib.suppress(urllib.error.HTTPError):
                    urllib.request.urlopen(url + "%1b%5b31mred")
                process.send_signal(number)
                out, err = process.communicate()
                self.assertEqual(process.returncode, 130)
                self.assertEqual(out, "")
                self.assertNotIn("\x1b", err)
                self.assertIn("200 GET /", err)

    def test_urls_are_taken_as_they_are_copied_and_other_schemes_refused(self):
        os.rename(self.built(), self.path("a \u00e4.crease"))
        with self.served("--quiet") as (url, _):
            there = self.json("info", "HTTP" + url[4:] + "a \u00e4.crease")
            here = self.json("info", self.path("a \u00e4.crease"))
            self.assertEqual(there["triangles"], here["triangles"])
        for command in (("info",), ("validate",), ("build", "-o", self.path("x.crease"))):
            failed = self.json(*command, "ftp://host/a.crease", exit_status=3)
            self.assertEqual(failed["error"]["name"], "NotSupported")

    def test_a_level_of_a_url_is_that_of_the_file_and_reads_what_it_needs(self):
        model = self.built(40000)
        with self.served("--quiet") as (url, _):
            for target in (("--triangles", 500), ("--ratio", 0.2), ("--ratio", 1)):
                near, far = self.path("near.ply"), self.path("far.ply")
                here = self.json("extract", model, "-o", near, *target, "--samples", 0)
                there = self.json("extract", url + "city.crease", "-o", far, *target)
                with open(near, "rb") as a, open(far, "rb") as b:
                    self.assertEqual(a.read(), b.read())
                for same in ("triangles", "vertices", "blocks_read", "file_bytes", "error"):
                    self.assertEqual(here[same], there[same])
                self.assertIsNone(there["error_measured"])
                self.assertGreaterEqual(there["bytes_read"], min(65536, here["file_bytes"]))
                # What the first request brings is not asked for again.
                self.assertLessEqual(there["bytes_read"], there["file_bytes"])
                self.assertLessEqual(there["bytes_read"], here["bytes_read"] + 65536)
            coarse = self.json("extract", url + "city.crease", "-o", far, "--triangles", 100)
            self.assertLess(coarse["bytes_read"], 65536 + 8192)  # and the names of parts
            self.assertGreater(coarse["bytes_read"], 65536)
            for command in (("extract", url + "city.crease", "-o", self.path("far.stl")),
                            ("render", url + "city.crease", "-o", self.path("a.png"), "--size", "64x48")):
                coarse = self.json(*command, "--triangles", 100)
                self.assertEqual(coarse["bytes_read"], 65536)

    def test_all_that_came_is_counted_whatever_had_to_be_tried(self):
        self.built(40000)
        camera = self.write("camera.json", json.dumps(
            {"position": [-150, -200, 40], "target": [0, 0, 0], "up": [0, 0, 1], "pixels": 0.25}))
        for target in ((), ("--triangles", 1500), ("--triangles", 6000)):
            with self.served() as (url, server):
                told = self.json("extract", url + "city.crease", "-o", self.path("seen.stl"),
                                 "--view", camera, *target, "--samples", 0)
                server.send_signal(signal.SIGTERM)
                _, log = server.communicate()
            ranges = re.findall(r"bytes=(\d+)-(\d+)", log)
            self.assertEqual(told["bytes_read"], sum(int(b) + 1 - int(a) for a, b in ranges))

    def test_what_is_asked_to_be_measured_is(self):
        self.built()
        with self.served() as (url, _):
            for more in (("--triangles", 500, "--samples", 1000), ("--error", 1)):
                report = self.json("extract", url + "city.crease", "-o", self.path("a.ply"), *more)
                self.assertIsNotNone(report["error_measured"])

    def test_the_other_commands_read_urls(self):
        model = self.built()
        with self.served() as (url, _):
            far = url + "city.crease"
            here, there = self.json("info", model), self.json("info", far)
            there["bytes_read"] = here["bytes_read"]
            self.assertEqual(here, there)
            head = self.json("info", far, "--head")
            for same in ("triangles", "vertices", "bytes", "blocks", "precision"):
                self.assertEqual(head[same], here[same])
            self.assertLessEqual(head["bytes_read"], 65536)
            valid = self.json("validate", far, "--file-only")
            self.assertTrue(valid["ok"])
            self.assertEqual(valid["bytes"], here["bytes"])
            self.assertLess(self.json("compare", far, model)["distance"]["max"]["a_to_b"], 1e-3)
            camera = self.write("camera.json", json.dumps(
                {"position": [0, 0, 300], "target": [0, 0, 0], "up": [0, 1, 0],
                 "vertical_fov": 45, "viewport": [64, 48], "pixels": 4}))
            view = self.json("extract", far, "-o", self.path("seen.ply"), "--view", camera)
            self.assertIsNone(view["error_measured"])
            picture = self.json("render", far, "-o", self.path("a.png"), "--ratio", 0.1,
                                "--size", "64x48")
            self.assertGreater(picture["bytes_read"], 0)

    def test_a_damaged_file_behind_a_url_is_found(self):
        model = self.built()
        with open(model, "r+b") as file:
            file.seek(-10, os.SEEK_END)
            byte = file.read(1)
            file.seek(-10, os.SEEK_END)
            file.write(bytes([byte[0] ^ 1]))
        with self.served() as (url, _):
            report = self.json("validate", url + "city.crease", exit_status=6)
            self.assertIn("checksum", report["errors"][0])
            self.assertIn(url + "city.crease", report["errors"][0])

    def test_urls_that_cannot_be_read(self):
        self.write("text.crease", "no model")
        with self.served() as (url, _):
            for name, error in (("none.crease", "NotFound"), ("text.crease", "NotCrease")):
                report = self.json("info", url + name, exit_status=2)
                self.assertEqual(report["error"]["name"], error)
                self.assertIn(url + name, report["error"]["message"])

    def test_an_interrupted_read_leaves_nothing(self):
        self.built(40000)
        with self.served("--delay", "60000") as (url, _):
            out = self.path("a.ply")
            process = subprocess.Popen([tool.BINARY, "extract", url + "city.crease", "-o", out],
                                       stderr=subprocess.PIPE, text=True)
            # It cannot be over: the first answer takes a minute. It may not have begun to watch.
            while process.poll() is None:
                process.send_signal(signal.SIGINT)
                with contextlib.suppress(subprocess.TimeoutExpired):
                    process.wait(0.5)
                    break
            process.communicate()
            self.assertIn(process.returncode, (130, -signal.SIGINT))
            self.assertEqual(self.files(), ["city.crease"])

    def test_a_shaped_line_gives_the_same(self):
        model = self.built()
        with self.served("--limit", "80Mbit", "--delay", "1") as (url, _):
            with urllib.request.urlopen(url + "city.crease") as answer, open(model, "rb") as file:
                self.assertEqual(answer.read(), file.read())

    def test_what_cannot_be_served(self):
        self.json("serve", self.path("none"), exit_status=2)
        self.json("serve", self.folder, "--limit", "fast", exit_status=1)
        self.run_tool("serve", self.folder, "--port", "70000", exit_status=1)
        self.json("serve", self.folder, "--host", "no.such.host.invalid", exit_status=1)
        with self.served() as (url, _):
            port = url.rstrip("/").rsplit(":", 1)[1]
            report = self.json("serve", self.folder, "--port", port, exit_status=2)
            self.assertIn(port, report["error"]["message"])

    def test_symbolic_links(self):
        outside = self.path("outside")
        os.mkdir(outside)
        shutil.copy(self.built(), outside)
        os.rename(self.path("city.crease"), self.path("other.crease"))
        os.symlink("outside/city.crease", self.path("link.crease"))
        with self.served() as (url, _):
            self.json("info", url + "link.crease", exit_status=2)
        with self.served("--follow-symlinks") as (url, _):
            self.json("info", url + "link.crease")


if __name__ == "__main__":
    tool.main()
