"""crease view --screenshot: the picture is the one that crease render makes, or there is a reason."""

import http.server
import json
import os
import pathlib
import sys
import threading
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).parents[1] / "cli"))

import tool  # noqa: E402
import picture  # noqa: E402
import screen_case  # noqa: E402

SIZE = "480x320"


class Ranges(http.server.SimpleHTTPRequestHandler):
    """A static host with range requests."""

    def do_GET(self):
        path = pathlib.Path(self.directory) / self.path.lstrip("/")
        if not path.is_file():
            return self.send_error(404)
        data = path.read_bytes()
        first, last = 0, len(data) - 1
        asked = self.headers.get("Range", "")
        if asked.startswith("bytes="):
            begin, end = asked[6:].split("-")
            first, last = int(begin), min(int(end) if end else last, last)
            self.send_response(206)
            self.send_header("Content-Range", f"bytes {first}-{last}/{len(data)}")
        else:
            self.send_response(200)
        self.send_header("Content-Length", str(last + 1 - first))
        self.end_headers()
        self.wfile.write(data[first:last + 1])

    def log_message(self, *_):
        pass


class Screenshot(screen_case.ScreenCase):
    def view(self, *arguments, exit_status=0, environment=None):
        done = tool.run([tool.BINARY, "view", *map(str, arguments)],
                        environment or self.screen.environment, timeout=600)
        self.assertEqual(done.returncode, exit_status, done.stdout + done.stderr)
        return done

    def camera(self, position, target, pixels=1):
        return self.write("camera.json", json.dumps(
            {"position": position, "target": target, "up": [0, 0, 1], "vertical_fov": 40,
             "viewport": [480, 320], "pixels": pixels}))

    def check_same_as_render(self, model, camera, *view_options, share=0.01):
        """Edges are smoothed by 4 samples here, by 16 there: only they may differ."""
        seen, rendered = self.path("seen.png"), self.path("rendered.png")
        done = self.view(model, "--view", camera, "--screenshot", seen, "--json", *view_options)
        report = json.loads(done.stdout)
        for key in ("frames", "median_frame_ms", "bytes_read", "triangles"):
            self.assertIn(key, report)
        self.assertGreater(report["triangles"], 0)
        self.assertGreater(report["frames"], 0)
        self.run_tool("render", model, "-o", rendered, "--view", camera, "--no-titles")
        a, b = picture.Picture(seen), picture.Picture(rendered)
        self.assertGreater(picture.covered(a), 0.1)
        self.assertLess(picture.differing(a, b, 48), share)
        return report

    def test_city(self):
        camera = self.camera([60, -160, 110], [0, 0, 0])
        report = self.check_same_as_render(self.built(12000), camera)
        self.assertGreater(report["bytes_read"], 1000)

    def test_modes_show_the_same(self):
        camera = self.camera([60, -160, 110], [0, 0, 0])
        for mode in ("vertex", "linear"):
            self.check_same_as_render(self.built(), camera, "--mode", mode)

    def test_zoo_model_as_mesh_file_is_built_on_the_way(self):
        lines = ["o sphere"]
        rings, segments = 24, 48
        import math
        for r in range(rings + 1):
            for s in range(segments):
                a, b = math.pi * r / rings, 2 * math.pi * s / segments
                p = (math.sin(a) * math.cos(b), math.sin(a) * math.sin(b), math.cos(a))
                lines.append("v %f %f %f" % p)
                lines.append("vn %f %f %f" % p)
        for r in range(rings):
            for s in range(segments):
                corners = [r * segments + s, (r + 1) * segments + s,
                           (r + 1) * segments + (s + 1) % segments, r * segments + (s + 1) % segments]
                lines.append("f " + " ".join(f"{c + 1}//{c + 1}" for c in corners))
        model = self.write("sphere.obj", "\n".join(lines) + "\n")
        self.check_same_as_render(model, self.camera([2, -3, 1.5], [0, 0, 0], 0.5))

    def painted_camera(self):
        """As fine as it gets: borders in a texture may be off by more than surfaces are."""
        return self.write("camera.json", json.dumps(
            {"position": [0.5, 0.5, 1.6], "target": [0.5, 0.5, 0], "up": [0, 1, 0],
             "vertical_fov": 40, "viewport": [480, 320], "pixels": 0.01}))

    def test_textures_are_there_in_every_mode(self):
        mesh, camera = self.painted(), self.painted_camera()
        model = self.path("painted.crease")
        self.json("build", mesh, "-o", model)
        os.remove(self.path("quarters.png"))  # the file has it
        for mode in ("block", "vertex", "linear"):
            self.check_same_as_render(model, camera, "--mode", mode)
            seen = picture.Picture(self.path("seen.png"))
            colors = [seen.pixel(x, y) for x, y in
                      ((170, 90), (310, 90), (170, 230), (310, 230))]
            red, green, blue, yellow = colors
            self.assertGreater(red[0], 2 * max(red[1:]), (mode, colors))
            self.assertGreater(green[1], 2 * max(green[0], green[2]), (mode, colors))
            self.assertGreater(blue[2], 2 * max(blue[:2]), (mode, colors))
            self.assertGreater(min(yellow[:2]), 2 * yellow[2], (mode, colors))

    def test_a_texture_that_is_missing_is_told_and_waits_for_nobody(self):
        model = self.path("painted.crease")
        self.json("build", self.painted(texture="gone.png"), "-o", model)
        self.check_same_as_render(model, self.painted_camera())

    def test_mesh_file_of_a_city(self):
        self.check_same_as_render(self.city(), self.camera([60, -160, 110], [0, 0, 0]))

    def test_url_streams(self):
        model = self.built(12000)
        handler = lambda *a, **k: Ranges(*a, directory=str(self.folder), **k)  # noqa: E731
        server = http.server.ThreadingHTTPServer(("127.0.0.1", 0), handler)
        threading.Thread(target=server.serve_forever, daemon=True).start()
        self.addCleanup(server.server_close)
        self.addCleanup(server.shutdown)
        url = f"http://127.0.0.1:{server.server_port}/{os.path.basename(model)}"
        camera = self.camera([60, -160, 110], [0, 0, 0])
        from_file, from_url = self.path("file.png"), self.path("url.png")
        self.view(model, "--view", camera, "--screenshot", from_file)
        self.view(url, "--view", camera, "--screenshot", from_url)
        self.assertEqual(pathlib.Path(from_file).read_bytes(), pathlib.Path(from_url).read_bytes())
        done = self.view(url + "no", "--screenshot", from_url, exit_status=2)
        self.assertIn("404", done.stderr)

    def test_without_a_camera_all_of_the_model_is_seen(self):
        out = self.path("all.png")
        self.view(self.built(), "--size", SIZE, "--screenshot", out)
        seen = picture.Picture(out)
        self.assertEqual((seen.width, seen.height), (480, 320))
        self.assertGreater(picture.covered(seen), 0.1)
        for y in range(seen.height):  # with room around it
            self.assertGreater(min(seen.pixel(seen.width - 1, y)), 200)

    def test_flight_is_flown_to_its_end(self):
        camera = json.loads(pathlib.Path(self.camera([60, -160, 110], [0, 0, 0])).read_text())
        far = dict(camera, position=[200, -400, 300])
        flight = self.write("flight.json", json.dumps(
            [{"seconds": 0, "camera": far}, {"seconds": 0.5, "camera": camera}]))
        a, b = self.path("flown.png"), self.path("there.png")
        self.view(self.built(), "--path", flight, "--size", SIZE, "--screenshot", a)
        self.view(self.built(), "--view", self.path("camera.json"), "--screenshot", b)
        self.assertLess(picture.differing(picture.Picture(a), picture.Picture(b), 24), 0.002)

    def halves_differ(self, *options):
        """The share of pixels that differ from those a half picture further right."""
        out = self.path("halves.png")
        camera = self.camera([60, -160, 110], [0, 0, 0])
        self.view(self.built(12000), "--view", camera, "--screenshot", out, *options)
        seen = picture.Picture(out)
        self.assertGreater(picture.covered(seen), 0.05)
        unlike = abs(seen.colors[:, 2:238] - seen.colors[:, 242:478]) > 32
        return unlike.any(axis=2).mean()

    def test_halves_show_what_they_are_set_to(self):
        self.assertEqual(self.halves_differ("--split", "pixels=1"), 0)
        self.assertEqual(self.halves_differ("--split", "mode=block", "--creases", "--degrees", "5",
                                            "--ambient-occlusion", "--bandwidth", "10000"), 0)
        self.assertLess(self.halves_differ("--split", "mode=hybrid", "--pixels", "1"), 0.02)
        self.assertGreater(self.halves_differ("--split", "original", "--triangles", "1000"), 0.01)
        self.assertGreater(self.halves_differ("--split", "creases"), 0.01)
        self.assertGreater(self.halves_differ("--split", "color=kind,mode=linear"), 0.1)

    def names_bytes(self, built):
        """Those of the parts, which end a file without images (docs/format.md)."""
        return int.from_bytes(built[112:120], "little")

    def test_what_cannot_be_opened_is_told_with_its_exit_status(self):
        out = self.path("none.png")
        built = pathlib.Path(self.built()).read_bytes()
        blocks_end = len(built) - self.names_bytes(built)
        broken = [
            ("absent.crease", None, "no such file"),
            ("text.crease", b"no model at all" * 10, ".crease file"),
            ("cut.crease", built[:len(built) // 2], ""),
            ("flipped.crease", built[:blocks_end - 300] + bytes(300) + built[blocks_end:],
             "checksum differs"),
            ("wrong.obj", b"v 0 0 0\nf 1 2 3\n", "wrong.obj:2"),
        ]
        for name, content, words in broken:
            with self.subTest(name):
                path = self.path(name) if content is None else self.write(name, content)
                camera = self.camera([10, -30, 20], [0, 0, 0], 0.01)
                done = self.view(path, "--view", camera, "--screenshot", out, exit_status=2)
                self.assertIn(name, done.stderr)
                self.assertIn(words, done.stderr)
                self.assertFalse(os.path.exists(out))

    def test_names_of_parts_that_are_broken_are_no_matter_for_a_picture(self):
        built = pathlib.Path(self.built()).read_bytes()
        names = self.names_bytes(built)
        self.assertGreater(names, 0)
        broken = self.write("nameless.crease", built[:-names] + bytes(names))
        camera = self.camera([10, -30, 20], [0, 0, 0], 0.01)
        pictures = [self.path("named.png"), self.path("nameless.png")]
        for model, out in zip([self.built(), broken], pictures):
            self.view(model, "--view", camera, "--screenshot", out)
        named, nameless = [pathlib.Path(p).read_bytes() for p in pictures]
        self.assertEqual(named, nameless)

    def test_command_lines_that_cannot_be_meant(self):
        self.view(self.built(), "--screenshot", self.path("a.jpg"), exit_status=3)
        self.view("--screenshot", self.path("a.png"), exit_status=1)
        self.view(self.built(), "--size", "big", exit_status=1)
        self.view(self.built(), "--mode", "magic", exit_status=1)
        for split in ("magic", "pixels=many", "mode=magic", "color=", "creases=1"):
            self.view(self.built(), "--split", split, exit_status=1)
        self.view(self.built(), "--path", self.write("f.json", "[]"), exit_status=2)

    def test_without_a_display_it_says_so(self):
        nowhere = {k: v for k, v in os.environ.items() if k not in ("DISPLAY", "WAYLAND_DISPLAY")}
        done = self.view(self.built(), exit_status=3, environment=nowhere)
        self.assertIn("no window", done.stderr)


if __name__ == "__main__":
    tool.main()
