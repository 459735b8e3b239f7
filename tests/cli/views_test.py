"""What a camera asks for: extract and render with --view."""

import json
import os

import tool


class Views(tool.Case):
    def test_extract_for_a_view_is_fine_where_the_camera_looks(self):
        def seen(camera, source):
            return self.json("extract", source, "-o", self.path("seen.ply"), "--view", camera)

        near = self.camera("near.json", [60, -60, 40])
        made = seen(near, self.built())
        self.has(made, "asked", "triangles", "vertices", "stopped_by", "error", "error_measured",
                 "bytes_read", "blocks_read", "seconds")
        self.assertEqual(made["asked"]["view"], str(near))
        self.assertEqual(self.json("info", self.path("seen.ply"))["triangles"], made["triangles"])
        # Its triangles come in another order, so ties between contractions fall otherwise.
        self.assertAlmostEqual(seen(near, self.city())["triangles"], made["triangles"],
                               delta=0.02 * made["triangles"])
        far = seen(self.camera("far.json", [6000, -6000, 4000]), self.city())
        rough = seen(self.camera("rough.json", [60, -60, 40], pixels=20), self.city())
        away = seen(self.camera("away.json", [0.001, 0, -500]), self.city())
        self.assertLess(far["triangles"], made["triangles"])
        self.assertLess(rough["triangles"], made["triangles"])
        self.assertGreater(away["triangles"], 0)
        self.assertLessEqual(made["triangles"], made["full_triangles"])

    def test_what_a_view_may_have_is_spent_where_it_looks(self):
        camera = self.camera("near.json", [60, -60, 40], pixels=0.25)

        def seen(*options, exit_status=0):
            return self.json("extract", self.built(), "-o", self.path("seen.ply"), "--view", camera,
                             "--samples", 0, *options, exit_status=exit_status)

        free = seen()
        self.assertEqual(free["stopped_by"], "view")
        for options in ((), ("--consistent",), ("--degrees", 2)):
            for most in (200, 700):
                made = seen("--triangles", most, *options)
                self.assertLessEqual(made["triangles"], most)
                self.assertGreater(made["triangles"], 0.95 * most)
                self.assertEqual(made["stopped_by"], "triangles")
                self.assertTrue(made["target_met"])
        self.assertEqual(made["asked"], {"view": str(camera), "triangles": 700, "degrees": 2})
        enough = seen("--triangles", free["triangles"])
        self.assertEqual(enough["stopped_by"], "view")
        self.assertEqual(enough["triangles"], free["triangles"])
        self.assertGreaterEqual(seen("--consistent")["triangles"], free["triangles"])
        self.assertGreater(seen("--degrees", 0.5)["triangles"], free["triangles"])
        os.remove(self.path("seen.ply"))
        none = seen("--triangles", 1, "--strict", exit_status=5)
        self.assertEqual(none["stopped_by"], "topology")
        self.assertIsNone(none["output"])
        self.assertFalse(os.path.exists(self.path("seen.ply")))

    def test_of_a_view_with_few_triangles_little_is_read(self):
        hills = self.hills()
        camera = self.write("hills.json", json.dumps(
            {"position": [80, -90, 60], "target": [80, 80, 0], "viewport": [640, 480], "pixels": 0.1}))
        few = self.json("extract", hills, "-o", self.path("hills.stl"), "--view", camera,
                        "--samples", 0, "--triangles", 300)
        self.assertLess(few["bytes_read"], 0.5 * few["file_bytes"])

    def test_what_a_view_reads_gives_the_cut_of_the_whole_file(self):
        hills, out = self.hills(), self.path("hills.png")
        shares = []
        for position, pixels in (([80, -90, 60], 1), ([80, -20, 20], 2), ([80, -300, 200], 2)):
            camera = self.write("hills.json", json.dumps(
                {"position": position, "target": [80, 80, 0], "viewport": [640, 480], "pixels": pixels}))
            whole = self.json("render", hills, "-o", out, "--view", camera, "--color", "error")
            panel = whole["panels"][0]
            camera = self.write("panel.json", json.dumps(panel["camera"]))
            made = self.json("extract", hills, "-o", self.path("hills.stl"), "--view", camera,
                             "--samples", 0)
            shares.append(made["bytes_read"] / made["file_bytes"])
            self.assertAlmostEqual(made["triangles"], panel["triangles"],
                                   delta=0.06 * panel["triangles"])
        self.assertLess(min(shares), 0.75)

    def test_render_for_a_view_draws_what_extract_makes_for_it(self):
        near = self.camera("near.json", [60, -60, 40])
        out = self.path("view.png")
        for source in (self.built(), self.city()):
            seen = self.json("extract", source, "-o", self.path("seen.ply"), "--view", near)
            picture = self.json("render", source, "-o", out, "--view", near, "--no-titles")
            self.assertEqual(tool.png_size(out), (640, 480))
            self.assertEqual(len(picture["panels"]), 1)
            self.assertEqual(picture["panels"][0]["triangles"], seen["triangles"])
            self.assertEqual(picture["panels"][0]["full_triangles"], seen["full_triangles"])
        for options in (("--triangles", 500), ("--triangles", 500, "--outside")):
            few = self.json("render", self.built(), "-o", out, "--view", near, "--no-titles", *options)
            self.assertEqual(few["panels"][0]["stopped_by"], "triangles")
            self.assertTrue(450 < few["panels"][0]["triangles"] <= 500)
        whole = self.json("render", self.built(), "-o", out, "--view", near, "--ratio", 1)
        self.assertEqual(whole["panels"][0]["triangles"], seen["full_triangles"])
        for color in ("shaded", "kind", "level", "error"):
            self.json("render", self.city(), "-o", out, "--view", near, "--color", color, "--control",
                      "--size", "200x100")
            self.assertEqual(tool.png_size(out), (200, 100))

    def test_a_view_is_refined_for_what_its_panel_shows(self):
        near = self.camera("near.json", [60, -60, 40])

        def panel(*options):
            return self.json("render", self.built(), "-o", self.path("view.png"), "--view", near,
                             *options)["panels"][0]

        own = panel("--no-titles")
        self.assertEqual(own["camera"]["viewport"], [640, 480])
        wide = panel("--no-titles", "--size", "1600x480")  # shows more
        self.assertGreater(wide["triangles"], own["triangles"])
        small = panel("--no-titles", "--size", "320x240")  # its pixels are larger
        self.assertLess(small["triangles"], own["triangles"])
        for options in (("--size", "1600x480"), ("--control", "--color", "kind"), ("--control",)):
            shown = panel(*options)
            camera = self.write("panel.json", json.dumps(shown["camera"]))
            self.assertNotEqual(shown["camera"]["viewport"], [640, 480])
            seen = self.json("extract", self.built(), "-o", self.path("seen.ply"), "--view", camera)
            self.assertEqual(shown["triangles"], seen["triangles"], options)

    def test_render_from_outside_shows_the_same_triangles_another_way(self):
        near = self.camera("near.json", [60, -60, 40])
        pictures = {}
        for options in (("--no-titles",), ("--outside",), ("--outside", "--color", "shaded"),
                        ("--outside", "--no-wireframe")):
            out = self.path("picture.png")
            made = self.json("render", self.city(), "-o", out, "--view", near, *options)
            pictures[tool.digest(out)] = made["panels"][0]["triangles"]
        self.assertEqual(len(pictures), 4)
        self.assertEqual(len(set(pictures.values())), 1)
        failed = self.json("render", self.city(), "-o", out, "--view", near, "--outside", "--ratio", 1,
                           exit_status=1)
        self.assertIn("--outside", failed["error"]["message"])
        self.run_tool("render", self.city(), "-o", out, "--outside", exit_status=1)


if __name__ == "__main__":
    tool.main()
