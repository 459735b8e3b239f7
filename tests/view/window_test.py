"""A window of crease view, used as people use it: mouse and keys by xdotool, pictures by key P."""

import ctypes
import json
import os
import pathlib
import struct
import subprocess
import sys
import time
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).parents[1] / "cli"))

import tool  # noqa: E402
import display  # noqa: E402
import picture  # noqa: E402

PATIENCE = 240  # seconds until something must have happened; a sanitizer and a busy machine are slow


class Window(tool.Case):
    def setUp(self):
        super().setUp()
        self.screen = display.Display(900, 700)
        self.addCleanup(self.screen.close)
        self.viewer = None

    def start(self, *arguments):
        self.viewer = subprocess.Popen(
            [tool.BINARY, "view", *map(str, arguments), "--json"], cwd=self.folder, text=True,
            stdout=subprocess.PIPE, stderr=subprocess.PIPE, env=self.screen.environment)
        self.addCleanup(self.end)
        self.until(lambda: self.xdotool("search", "--name", "crease", check=False), "a window")
        self.window = self.xdotool("search", "--name", "crease").split()[0]
        before = len(self.pictures())
        self.until(lambda: self.listens(before), "an answer to a key")

    def listens(self, before):
        """A window that has just appeared may have no keyboard yet."""
        self.key("p")
        time.sleep(1)
        if len(self.pictures()) == before:
            return False
        count = -1
        while count != len(self.pictures()):  # it may take several keys late
            count = len(self.pictures())
            time.sleep(1)
        return True

    def end(self):
        if self.viewer.poll() is None:
            self.viewer.kill()
        self.viewer.communicate()

    def xdotool(self, *arguments, check=True):
        done = subprocess.run(["xdotool", *map(str, arguments)], env=self.screen.environment,
                              capture_output=True, text=True)
        if check:
            self.assertEqual(done.returncode, 0, done.stderr)
        return done.stdout if done.returncode == 0 else ""

    def key(self, *names):
        for name in names:
            self.xdotool("key", name)

    def until(self, holds, what):
        begin = time.monotonic()
        while time.monotonic() - begin < PATIENCE:
            self.assertIsNone(self.viewer.poll(), f"the viewer ended before there was {what}")
            found = holds()
            if found:
                return found
            time.sleep(0.1)
        self.fail(f"waited for {what}")

    def pictures(self):
        return sorted(self.folder.glob("*.png"), key=lambda p: int(p.stem.split("-")[-1]))

    def shot(self):
        """What the window shows, by key P: again if nothing comes, as a window that has just been
        mapped may not have the keyboard yet."""
        before, pressed = len(self.pictures()), float("-inf")

        def is_taken():
            nonlocal pressed
            if len(self.pictures()) > before:
                return True
            if time.monotonic() - pressed > 5:
                pressed = time.monotonic()
                self.key("p")
            return False
        self.until(is_taken, "a picture")
        return picture.Picture(self.pictures()[-1])

    def settled(self):
        """The picture when it no longer changes."""
        last = self.shot()

        def is_still():
            nonlocal last
            time.sleep(0.3)
            previous, last = last, self.shot()
            same = (previous.width, previous.height) == (last.width, last.height)
            return same and picture.differing(previous, last, 4) < 0.0005
        self.until(is_still, "a picture that stays")
        return last

    def shown(self):
        """The first one with the model, settled."""
        self.until(lambda: picture.covered(self.shot()) > 0.05, "the model")
        return self.settled()

    def changed(self, before, threshold, share):
        """The picture that more than `share` of `before` differs from: what is pressed may take a
        busy machine a while."""
        self.until(lambda: picture.differing(before, self.shot(), threshold) > share,
                   "another picture")
        after = self.settled()
        self.assertGreater(picture.differing(before, after, threshold), share)
        return after

    def back(self, before, threshold, share=0):
        """The picture when it is `before` again, but for `share` of it."""
        self.until(lambda: picture.differing(before, self.shot(), threshold) <= share,
                   "the picture of before")
        after = self.settled()
        self.assertLessEqual(picture.differing(before, after, threshold), share)
        return after

    def title(self):
        return self.xdotool("getwindowname", self.window)

    def close(self, exit_status=0):
        self.key("F10")
        out, err = self.viewer.communicate(timeout=PATIENCE)
        self.check_status(exit_status, out, err)
        return json.loads(out)

    def check_status(self, exit_status, out, err):
        self.assertNotIn("OpenGL: ", err)  # with CREASE_GL_DEBUG
        if tool.leaks.TRACER_FAILED in err:
            self.assertNotIn("ERROR: ", err)  # of the other checkers
        else:
            self.assertEqual(self.viewer.returncode, exit_status, out + err)

    def close_by_its_button(self):
        """What a window manager sends."""
        x = ctypes.CDLL("libX11.so.6")
        x.XOpenDisplay.restype = ctypes.c_void_p
        x.XInternAtom.restype = ctypes.c_ulong
        display_of_x = ctypes.c_void_p(x.XOpenDisplay(self.screen.environment["DISPLAY"].encode()))
        atom = [x.XInternAtom(display_of_x, name, 0) for name in (b"WM_PROTOCOLS",
                                                                  b"WM_DELETE_WINDOW")]
        event = ctypes.create_string_buffer(struct.pack(
            "@i4xLiPLLi4xLLLLL", 33, 0, 1, 0, int(self.window), atom[0], 32, atom[1], 0, 0, 0, 0),
            192)
        x.XSendEvent(display_of_x, ctypes.c_ulong(int(self.window)), 0, ctypes.c_long(0), event)
        x.XCloseDisplay(display_of_x)
        out, err = self.viewer.communicate(timeout=PATIENCE)
        self.check_status(0, out, err)

    def drag(self, button, right, down):
        self.xdotool("mousemove", "--window", self.window, 450, 300, "mousedown", button)
        for _ in range(6):
            self.xdotool("mousemove_relative", "--", right // 6, down // 6)
        self.xdotool("mouseup", button)

    def test_mouse_and_keys(self):
        self.start(self.built(), "--size", "640x480")
        first = self.shown()
        self.assertIn("city.crease", self.title())

        self.drag(1, 120, 30)
        orbited = self.changed(first, 16, 0.05)
        self.drag(3, 90, 60)
        panned = self.changed(orbited, 16, 0.05)
        self.xdotool("mousemove", "--window", self.window, 450, 300)
        for _ in range(3):
            self.xdotool("click", 4)
        zoomed = self.changed(panned, 16, 0.05)
        self.key("Home")
        fitted = self.back(first, 16, 0.02)

        self.key("x")
        self.changed(fitted, 16, 0.01)
        self.key("x", "c")
        self.changed(fitted, 24, 0.1)
        self.key("c", "c", "c", "c")
        self.back(fitted, 8)

        self.key("F1")  # over the picture, which stays
        self.back(fitted, 8)
        self.key("F1")
        for _ in range(2):  # by vertex in blocks, by vertex: the same to the eye
            self.key("m")
            self.back(fitted, 48, 0.02)
        self.key("m", "m")

        report = self.close()
        self.assertGreater(report["frames"], 10)
        self.assertGreater(report["median_frame_ms"], 0)
        self.assertGreater(report["bytes_read"], 0)

    def halves(self, shot):
        """The columns left and right of the divider, which is dark from top to bottom."""
        for x in range(shot.width):
            if all(max(shot.pixel(x, y)) < 160 for y in (0, shot.height // 2, shot.height - 1)):
                return x, shot.width - x
        self.fail("no divider")

    def move_divider(self, to):
        x = self.halves(self.shot())[0]
        self.xdotool("mousemove", "--window", self.window, x, 440, "mousedown", 1)
        for step in range(1, 5):
            self.xdotool("mousemove", "--window", self.window, x + (to - x) * step // 4, 440)
        self.xdotool("mouseup", 1)

    def test_crease_lines_and_halves(self):
        self.start(self.built(), "--size", "640x480")
        first = self.shown()
        self.key("l")
        self.changed(first, 32, 0.01)
        self.key("l")
        self.back(first, 8)

        self.key("v")  # beside the original
        left, right = self.halves(self.settled())
        self.assertLess(abs(left - right), 6)
        self.move_divider(400)
        divided = self.settled()
        self.assertLess(abs(self.halves(divided)[0] - 400), 6)
        self.drag(1, 60, 0)
        moved = self.changed(divided, 16, 0.02)

        self.key("v", "Tab", "c")  # two settings, and colours of the right one
        colored = self.settled()
        _, changed = picture.unlike(moved, colored, 40).nonzero()
        self.assertGreater(changed.size, 150)
        self.assertGreater(changed.min(), 395)
        self.key("v")
        with self.assertRaises(AssertionError):
            self.halves(self.settled())
        self.close()

    def press(self, x, y):
        self.xdotool("mousemove", "--window", self.window, x, y, "mousedown", 1)
        time.sleep(0.3)
        self.xdotool("mouseup", 1)
        self.shot()  # or, where frames take long, the next press would still be this one

    def test_what_panels_set(self):
        """Sliders are pressed at their ends."""
        self.start(self.built(12000), "--size", "640x660")
        first = self.shown()
        self.press(252, 389)  # error: 64 pixels
        coarse = self.changed(first, 16, 0.005)
        self.press(133, 314)  # creases
        self.changed(coarse, 16, 0.005)
        self.press(133, 314)
        self.back(coarse, 16)
        self.press(26, 581)  # bandwidth: as little as can be
        self.press(26, 389)  # error: as little as can be
        self.press(252, 581)
        self.changed(coarse, 16, 0.005)
        self.press(252, 389)
        self.back(coarse, 16)
        self.close()

    def test_frozen_the_cut_stays_while_the_camera_moves(self):
        self.start(self.built(), "--size", "640x480")
        first = self.shown()
        self.key("o")
        outside = self.changed(first, 16, 0.05)
        self.drag(1, 60, 0)
        self.changed(outside, 16, 0.05)
        self.key("z")
        self.settled()
        self.close()

    def test_flying_moves_the_camera_and_escape_ends_it(self):
        self.start(self.built(), "--size", "640x480")
        first = self.shown()
        self.key("f")
        self.xdotool("keydown", "w")
        time.sleep(1)
        self.xdotool("keyup", "w")
        self.key("Escape")
        self.changed(first, 16, 0.05)
        self.close()

    def test_a_recorded_flight_can_be_played(self):
        self.start(self.built(), "--size", "640x480")
        self.shown()
        self.key("r")
        self.drag(1, 120, 0)
        end = self.settled()
        self.key("r")
        flights = self.until(lambda: list(self.folder.glob("*-flight-*.json")), "a flight")
        self.close()
        out = self.path("end-1.png")
        subprocess.run([tool.BINARY, "view", self.path("city.crease"), "--size", "640x480",
                        "--path", flights[0], "--screenshot", out], check=True,
                       env=self.screen.environment, timeout=PATIENCE)
        self.assertLess(picture.differing(end, picture.Picture(out), 24), 0.01)

    def test_the_window_takes_other_sizes(self):
        self.start(self.built(), "--size", "640x480")
        self.shown()
        self.xdotool("windowsize", self.window, 500, 600)
        taller = self.settled()
        self.assertEqual((taller.width, taller.height), (500, 600))
        self.assertGreater(picture.covered(taller), 0.05)
        self.close()

    def test_a_file_is_seen_again_from_where_it_was_seen_last(self):
        self.start(self.built(), "--size", "640x480")
        self.shown()
        self.drag(1, 120, 30)
        moved = self.settled()
        self.close()
        self.start(self.built(), "--size", "640x480")
        self.assertLess(picture.differing(moved, self.shown(), 16), 0.01)
        self.close()

    def test_a_broken_file_is_told_in_the_window_and_when_it_ends(self):
        self.start(self.write("broken.crease", b"nothing" * 100), "--size", "640x480")
        self.settled()
        report = self.close(exit_status=2)
        self.assertIn("broken.crease", report["error"]["message"])

    def test_nothing_to_open_waits_and_ends_well(self):
        self.start("--size", "640x480")
        self.assertEqual(picture.covered(self.settled()), 0)
        self.assertEqual(self.close()["triangles"], 0)

    def test_the_window_closes_by_its_button(self):
        self.start(self.built(), "--size", "640x480")
        self.shown()
        self.close_by_its_button()

    def test_the_end_of_a_session_ends_the_viewer(self):
        self.start(self.built(), "--size", "640x480")
        self.shown()
        self.viewer.terminate()
        self.viewer.communicate(timeout=PATIENCE)
        self.assertEqual(self.viewer.returncode, 130)


if __name__ == "__main__":
    tool.main()
