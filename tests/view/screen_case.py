"""Tests of programs that open windows: one display for all of a class."""

import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).parents[1] / "cli"))

import tool  # noqa: E402
import display  # noqa: E402


class ScreenCase(tool.Case):
    @classmethod
    def setUpClass(cls):
        cls.screen = display.Display()

    @classmethod
    def tearDownClass(cls):
        cls.screen.close()
