"""Ctrl-C while a build runs, and the bar that shows it running."""

import os
import pty
import re
import select
import signal
import subprocess

import tool


class Interrupt(tool.Case):
    def start_on_terminal(self, *arguments):
        """Standard error is a terminal, so the tool draws its bar there."""
        ours, theirs = pty.openpty()
        process = subprocess.Popen([tool.BINARY, *arguments], stderr=theirs,
                                   stdout=subprocess.PIPE)
        os.close(theirs)
        self.addCleanup(os.close, ours)
        self.addCleanup(process.stdout.close)
        return process, ours

    def read_until(self, terminal, pattern):
        text = ""
        while not re.search(pattern, text):
            if not select.select([terminal], [], [], 300)[0]:
                break
            try:
                data = os.read(terminal, 4096)
            except OSError:  # the other end is closed
                break
            if not data:
                break
            text += data.decode(errors="replace")
        return text

    def test_an_interrupted_build_leaves_nothing_and_exits_with_130(self):
        city = self.city(150000)
        for number in (signal.SIGINT, signal.SIGTERM):
            out = self.path("city.crease")
            process, terminal = self.start_on_terminal("build", city, "-o", out)
            text = self.read_until(terminal, r"simplif\w* +\[[#.]+\] +\d+ %")
            self.assertRegex(text, r"\[[#.]+\] +\d+ %")
            process.send_signal(number)
            text += self.read_until(terminal, r"interrupted")
            self.assertEqual(process.wait(), 130)
            self.assertRegex(text, r"interrupted")
            self.assertEqual(self.files(), ["city.ply"])

    def test_a_comparison_can_be_interrupted(self):
        city = self.city(1000)
        process, terminal = self.start_on_terminal("compare", city, city, "--samples", "10000000")
        text = self.read_until(terminal, r"compare +\[[#.]+\] +\d+ %")
        process.send_signal(signal.SIGINT)
        self.assertEqual(process.wait(), 130)
        self.assertRegex(text + self.read_until(terminal, r"interrupted"), r"interrupted")

    def test_no_bar_where_nobody_looks(self):
        done = self.run_tool("build", self.city(), "-o", self.path("city.crease"))
        self.assertNotIn("[#", done.stderr)
        self.assertNotIn("\r", done.stderr)

    def test_the_bar_is_wiped_when_done(self):
        process, terminal = self.start_on_terminal("build", self.city(), "-o",
                                                   self.path("city.crease"))
        text = self.read_until(terminal, r"never")
        self.assertEqual(process.wait(), 0)
        self.assertRegex(text, r"%")
        self.assertRegex(text, r"\r\x1b\[K[^%]*$")


if __name__ == "__main__":
    tool.main()
