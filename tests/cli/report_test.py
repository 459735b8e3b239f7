"""crease report: one page that is whole, well-formed and about the model that was given."""

import base64
import os
import pathlib
import re
import struct
import xml.etree.ElementTree
import zlib

import tool

# Small pictures of few levels: what is tested does not depend on their size.
FAST = ("--levels", "0.5,0.05", "--samples", 500, "--size", "48x36")


def decoded_png(data):
    """Width, height and the unpacked rows; every chunk's checksum is looked at."""
    assert data[:8] == b"\x89PNG\r\n\x1a\n"
    at, size, packed = 8, None, b""
    while at < len(data):
        length, kind = struct.unpack(">I4s", data[at:at + 8])
        content = data[at + 8:at + 8 + length]
        assert struct.unpack(">I", data[at + 8 + length:at + 12 + length])[0] == \
            zlib.crc32(kind + content)
        if kind == b"IHDR":
            size = struct.unpack(">II", content[:8])
        elif kind == b"IDAT":
            packed += content
        at += 12 + length
    return size, zlib.decompress(packed)


class Page(tool.Case):
    def page(self, *arguments):
        out = self.path("page.html")
        made = self.json("report", *arguments, "-o", out)
        text = pathlib.Path(out).read_text()
        self.assertEqual(made["bytes"], len(text.encode()))
        self.assertTrue(text.startswith("<!DOCTYPE html>"))
        return made, text, xml.etree.ElementTree.fromstring(text)

    def test_a_page_has_every_level_with_a_picture_its_errors_and_curves(self):
        model = self.built()
        made, text, tree = self.page(model, *FAST)
        info = self.json("info", model)
        for count in ("triangles", "sn_triangles", "fn_triangles", "nsn_triangles"):
            self.assertEqual(made["levels"][0][count], info[count])
        self.assertEqual([level["name"] for level in made["levels"]], ["original", "50 %", "5 %"])
        for level in made["levels"]:
            self.assertEqual(level["sn_triangles"] + level["fn_triangles"] + level["nsn_triangles"],
                             level["triangles"])
        needed = [level["bytes_needed"] for level in made["levels"]]
        self.assertEqual(needed, sorted(needed, reverse=True))
        self.assertLessEqual(needed[0], info["bytes"])
        self.assertNotIn("error_measured", made["levels"][0])
        self.assertGreater(made["levels"][2]["error_measured"]["surface_max"], 0)
        pictures = [image.get("src") for image in tree.iter("img")]
        self.assertEqual(len(pictures), 3)
        for picture in pictures:
            head, data = picture.split(",")
            self.assertEqual(head, "data:image/png;base64")
            size, rows = decoded_png(base64.b64decode(data, validate=True))
            self.assertEqual(size, (48, 36))
            self.assertGreater(len(set(rows)), 20)  # something is drawn
        plots = [f for f in tree.iter("figure") if f.get("class") == "plot"]
        self.assertEqual(len(plots), 4)
        for plot in plots:
            curves = [line.get("points").split() for line in plot.iter("polyline")]
            # A normal deviation may be 0, which has no place on a logarithmic axis.
            if "Distance" in plot.find("figcaption").text:
                self.assertEqual([len(points) for points in curves[:2]], [2, 2])
            for point in (p for points in curves for p in points):
                x, y = map(float, point.split(","))
                self.assertTrue(0 < x < 480 and 0 < y < 300, point)
        words = "".join(tree.itertext())
        for text_of_model in ("bits a vertex", "wedges (Hoppe)", "container", "triangles"):
            self.assertIn(text_of_model, words)
        self.assertNotIn("Import", words)

    def test_what_levels_carry_besides_is_in_a_table(self):
        hills = pathlib.Path(self.hills_mesh(24)).read_text()
        bare = self.write("bare.obj", hills)
        _, _, tree = self.page(bare, *FAST)
        self.assertNotIn("What is on the surface", "".join(tree.itertext()))

        lines = hills.splitlines()
        places = [line.split()[1:3] for line in lines if line.startswith("v ")]
        corners = ["f " + " ".join(f"{v}/{v}" for v in line.split()[1:])
                   for line in lines if line.startswith("f ")]
        half = len(corners) // 2
        painted = self.write("painted.obj", "\n".join(
            [line for line in lines if line.startswith("v ")] +
            [f"vt {int(x) / 24} {(int(y) / 24) ** 2}" for x, y in places] +
            ["usemtl grass"] + corners[:half] + ["usemtl rock"] + corners[half:]))
        made, _, tree = self.page(painted, *FAST)
        table = next(t for t in tree.iter("table")
                     if [h.text for h in t.iter("th")][1:] == ["uv, mean", "95 % below", "material differs on"])
        rows = [[cell.text for cell in row.iter("td")] for row in table.iter("tr")][1:]
        self.assertEqual([row[0] for row in rows], ["50 %", "5 %"])
        for row, level in zip(rows, made["levels"][1:]):
            uv, material = level["error_measured"]["attributes"]
            self.assertGreater(uv["mean"], 0)
            self.assertEqual(row[1:], ["%.3g" % uv["mean"], "%.3g" % uv["p95"],
                                       "%.3g %%" % (100 * material["mean"])])

    def test_a_page_asks_for_nothing_else(self):
        _, text, _ = self.page(self.built(), *FAST)
        self.assertNotRegex(text, r"<script|<link|<iframe|@import|url\(|https?://")
        self.assertEqual(re.findall(r'(?:src|href)="(?!data:)', text), [])

    def test_a_mesh_is_built_on_the_fly_and_its_import_told(self):
        ugly = self.write("ugly.obj", tool.TETRAHEDRON + "f 1 1 2\nv 9 9 9\n")
        made, _, tree = self.page(ugly, *FAST)
        self.assertEqual(made["levels"][0]["triangles"], 4)
        words = "".join(tree.itertext())
        self.assertIn("1 triangles with two equal corners dropped", words)
        self.assertIn("1 isolated vertices dropped", words)

    def test_names_are_escaped(self):
        name = "a<b>&\"c'.obj"
        odd = self.write(name, "o <script>&\n" + tool.TETRAHEDRON)
        _, text, tree = self.page(odd, *FAST)
        self.assertEqual(tree.find("head/title").text, name)
        self.assertNotIn("<script", text)
        _, _, tree = self.page(odd, "--title", "</title> & <h1>", *FAST)
        self.assertEqual(tree.find("body/main/h1").text, "</title> & <h1>")

    def test_nothing_is_measured_where_that_is_asked(self):
        made, _, _ = self.page(self.built(), "--levels", "0.5", "--samples", 0, "--size", "48x36")
        self.assertTrue(all("error_measured" not in level for level in made["levels"]))

    def test_the_page_is_the_same_for_any_number_of_threads(self):
        model = self.built()
        pages = {self.page(model, *FAST, "--threads", n)[1] for n in (1, 3)}
        self.assertEqual(len(pages), 1)

    def test_failures_leave_no_page(self):
        out = self.path("page.html")
        broken = self.write("broken.crease", pathlib.Path(self.built()).read_bytes()[:5000])
        for arguments, status in ((["report", self.path("none.obj")], 2), (["report", broken], 2),
                                  (["report", self.built(), "--levels", "2"], 1),
                                  (["report", self.built(), "--size", "wide"], 1),
                                  (["report", self.built(), "--view", self.path("no.json")], 2)):
            failed = self.json(*arguments, "-o", out, exit_status=status)
            self.assertEqual(failed["exit_status"], status)
        nowhere = self.path("no_folder/page.html")
        self.assertIn("no_folder", self.json("report", self.built(), "-o", nowhere, *FAST,
                                             exit_status=4)["error"]["message"])
        self.run_tool("report", self.built(), exit_status=1)
        self.assertFalse(os.path.exists(out))
        self.assertEqual([f for f in self.files() if ".part" in f], [])

    def test_quiet(self):
        done = self.run_tool("report", self.built(), "-o", self.path("q.html"), "--quiet", *FAST)
        self.assertEqual((done.stdout, done.stderr), ("", ""))


if __name__ == "__main__":
    tool.main()
