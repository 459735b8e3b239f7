"""A model keeps its textures from build to pictures and meshes; what is wrong with one is told."""

import pathlib
import unittest

import tool
from tool import quarters_png


def words(json):
    return "\n".join(json["import"]["notes"])


class Textures(tool.Case):
    def crease(self, **options):
        out = self.path("painted.crease")
        return out, self.json("build", self.painted(**options), "-o", out)

    def test_build_stores_images_and_info_lists_them(self):
        out, built = self.crease()
        image = quarters_png()
        self.assertEqual(built["image_bytes"], len(image))
        self.assertEqual(built["bytes"], pathlib.Path(out).stat().st_size)
        self.assertAlmostEqual(built["bits_per_vertex"],
                               8 * (built["bytes"] - len(image)) / built["vertices"])
        self.assertTrue(pathlib.Path(out).read_bytes().endswith(image))
        info = self.json("info", out)
        self.assertEqual(info["version"], 11)
        self.assertEqual(info["images"], [{"name": "quarters.png", "bytes": len(image)}])
        self.assertAlmostEqual(info["bits_per_vertex"]["total"], built["bits_per_vertex"])
        self.assertEqual(self.json("info", out, "--head")["image_bytes"], len(image))
        self.assertEqual(self.json("info", self.painted())["images"], info["images"])
        self.assertIn("image quarters.png", self.run_tool("info", out).stdout)
        self.assertTrue(self.json("validate", out)["ok"])

    def test_extract_gives_the_images_back(self):
        out, _ = self.crease()
        image = quarters_png()
        (self.folder / "quarters.png").unlink()
        glb, obj = self.path("level.glb"), self.path("level.obj")
        self.json("extract", out, "-o", glb, "--ratio", 0.3)
        self.assertIn(image, pathlib.Path(glb).read_bytes())
        self.json("extract", out, "-o", obj, "--ratio", 0.3)
        self.assertEqual((self.folder / "level_quarters.png").read_bytes(), image)
        self.assertIn("map_Kd level_quarters.png", (self.folder / "level.mtl").read_text())
        ply = self.path("other.ply")
        self.json("extract", out, "-o", ply, "--ratio", 0.3)
        self.assertEqual((self.folder / "other_quarters.png").read_bytes(), image)
        for mesh in (glb, obj, ply):
            info = self.json("info", mesh)
            self.assertEqual([i["bytes"] for i in info["images"]], [len(image)])
            self.assertEqual(words(info), "")
            again = self.json("build", mesh, "-o", self.path("again.crease"))
            self.assertEqual(again["image_bytes"], len(image))
        # A chain as one file has them once, as separate files each.
        self.json("extract", out, "-o", self.path("lod.glb"), "--levels", 3, "--lod-glb")
        self.assertEqual((self.folder / "lod.glb").read_bytes().count(image), 1)
        self.json("extract", out, "-o", self.path("lod.glb"), "--levels", 2)
        self.assertEqual((self.folder / "lod_1.glb").read_bytes().count(image), 1)

    def test_a_missing_image_is_a_note_and_found_beside_the_file_later(self):
        out, built = self.crease(texture="gone.png")
        self.assertIn("no file 'gone.png'", words(built))
        self.assertEqual(built["image_bytes"], 0)
        self.assertEqual(self.json("info", out)["version"], 10)
        glb, picture = self.path("level.glb"), self.path("x.png")
        done = self.run_tool("render", out, "-o", picture, "--size", "80x60")
        self.assertIn("no file 'gone.png'", done.stderr)
        self.run_tool("extract", out, "-o", glb)
        self.assertEqual(self.json("info", glb)["images"], [])
        self.write("gone.png", quarters_png())
        done = self.run_tool("render", out, "-o", picture, "--size", "80x60")
        self.assertNotIn("gone.png", done.stderr)
        self.run_tool("extract", out, "-o", glb)
        self.assertEqual([i["name"] for i in self.json("info", glb)["images"]], ["gone.png"])

    def test_a_broken_image_is_told_and_drawn_without(self):
        mesh = self.painted()
        self.write("quarters.png", quarters_png()[:70])
        out = self.path("painted.crease")
        self.json("build", mesh, "-o", out)
        for model in (mesh, out):
            done = self.run_tool("render", model, "-o", self.path("x.png"), "--size", "80x60")
            self.assertIn("texture 'quarters.png' is not drawn: PNG: ", done.stderr)

    def test_validate_names_an_image_that_was_changed(self):
        out, _ = self.crease()
        data = bytearray(pathlib.Path(out).read_bytes())
        data[-5] ^= 1
        done = self.json("validate", self.write("bad.crease", bytes(data)), exit_status=6)
        self.assertIn("image 'quarters.png'", done["errors"][0])
        self.assertIn("checksum differs", done["errors"][0])
        # Cut within the images: the geometry is all there, and nothing that has no place for them
        # misses them.
        cut = self.write("cut.crease", bytes(data[:-20]))
        self.json("extract", cut, "-o", self.path("x.stl"))
        for command in (("info", cut), ("extract", cut, "-o", self.path("x.glb"))):
            self.assertEqual(self.run_tool(*command, exit_status=2).stdout, "")


if __name__ == "__main__":
    unittest.main()
