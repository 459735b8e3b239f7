"""crease view --screenshot: what it says of what it shows."""

import json
import os
import pathlib
import sys
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).parents[1] / "cli"))

import tool  # noqa: E402
import picture  # noqa: E402
import screen_case  # noqa: E402


def red_share(path):
    """Of the covered pixels, those of the upper third of the scale of errors."""
    seen = picture.Picture(path)
    red = seen.colors[..., 0] > 1.5 * seen.colors[..., 1:].max(axis=2)
    return red.mean() / picture.covered(seen)


class Answers(screen_case.ScreenCase):
    def camera(self, position, pixels=1):
        return self.write("camera.json", json.dumps(
            {"position": position, "target": [0, 0, 5], "up": [0, 0, 1], "vertical_fov": 50,
             "viewport": [480, 320], "pixels": pixels}))

    def shown(self, model, camera, *options):
        done = tool.run([tool.BINARY, "view", str(model), "--view", str(camera), "--screenshot",
                         str(self.path("seen.png")), "--json", *map(str, options)],
                        self.screen.environment, timeout=600)
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
        return json.loads(done.stdout)

    def test_what_is_seen_is_not_red_by_error(self):
        model = self.built()
        for mode in ("block", "hybrid", "vertex", "linear"):
            for pixels in (1, 20):
                report = self.shown(model, self.camera([-60, -55, 12], pixels), "--mode", mode,
                                    "--color", "error")
                self.assertLessEqual(report["error_pixels"], 1.001 * pixels, mode)
                self.assertLess(red_share(self.path("seen.png")), 0.01, (mode, pixels))

    def test_a_level_from_inside_of_the_model_is_the_full_one(self):
        full = self.json("info", self.built())["triangles"]
        report = self.shown(self.built(), self.camera([0, 0, 0.001]), "--mode", "linear")
        self.assertEqual(report["triangles"], full)
        self.assertEqual(report["error_pixels"], 0)

    def test_no_more_is_read_than_the_file_has(self):
        model = self.built()
        for mode in ("block", "vertex"):
            report = self.shown(model, self.camera([-60, -55, 12], 0.01), "--mode", mode)
            self.assertGreater(report["bytes_read"], 0)
            self.assertLessEqual(report["bytes_read"], os.path.getsize(model))

    def test_original_stands_alone(self):
        done = tool.run([tool.BINARY, "view", str(self.built()), "--split", "original,pixels=3"],
                        self.screen.environment)
        self.assertEqual(done.returncode, 1)
        self.assertIn("stands alone", done.stderr)
        self.assertNotIn("none of", done.stderr)


if __name__ == "__main__":
    tool.main()
