"""What every command does when all is well, and the fields that scripts rely on (docs/cli.md)."""

import json
import math
import os
import pathlib
import random
import struct

import tool

COMMANDS = ["build", "info", "extract", "compare", "render", "report", "validate", "generate",
            "serve", "view"]


def glb_json(path):
    data = pathlib.Path(path).read_bytes()
    magic, version, length, size, kind = struct.unpack("<4sIIII", data[:20])
    assert magic == b"glTF" and version == 2 and length == len(data) and kind == 0x4E4F534A
    return json.loads(data[20:20 + size])


class Commands(tool.Case):
    def test_every_command_has_help_with_an_example(self):
        self.assertIn("build", self.run_tool("--help").stdout)
        for command in COMMANDS:
            text = self.run_tool(command, "--help").stdout
            self.assertIn(f"crease {command} ", text)
            self.assertIn("Example", text)
            for option in ("--json", "--threads", "--quiet"):
                self.assertIn(option, text)

    def test_version(self):
        self.assertRegex(self.run_tool("--version").stdout, r"^crease \d+\.\d+\.\d+\n$")

    def test_generate_makes_the_same_city_again_and_another_with_another_seed(self):
        made = self.json("generate", "city", "-o", self.path("a.ply"), "--triangles", 3000)
        self.has(made, "output", "triangles", "vertices", "parts", "seconds")
        self.assertGreater(made["triangles"], 1000)
        self.assertGreater(made["parts"], 1)
        self.json("generate", "city", "-o", self.path("b.ply"), "--triangles", 3000)
        self.json("generate", "city", "-o", self.path("c.ply"), "--triangles", 3000, "--seed", 2)
        self.assertEqual(tool.digest(self.path("a.ply")), tool.digest(self.path("b.ply")))
        self.assertNotEqual(tool.digest(self.path("a.ply")), tool.digest(self.path("c.ply")))

    def test_build(self):
        out = self.path("city.crease")
        built = self.json("build", self.city(), "-o", out, "--precision", "16bits")
        self.has(built, "triangles", "vertices", "seconds", "peak_memory", "bytes",
                 "bits_per_vertex", "bands", "blocks", "import")
        self.assertEqual(built["bytes"], pathlib.Path(out).stat().st_size)
        self.assertAlmostEqual(built["bits_per_vertex"], 8 * built["bytes"] / built["vertices"])
        self.assertGreater(built["peak_memory"], built["bytes"])

    def test_build_is_the_same_to_the_byte_for_any_number_of_threads(self):
        for placement in ("optimal", "endpoint"):
            digests = set()
            for threads in (1, 2, 7):
                out = self.path(f"{placement}_{threads}.crease")
                self.json("build", self.city(), "-o", out, "--threads", threads, "--placement",
                          placement)
                digests.add(tool.digest(out))
            self.assertEqual(len(digests), 1)

    def test_build_of_several_files_makes_a_part_of_each(self):
        a = self.write("a.obj", tool.SQUARE.format(z=0))
        b = self.write("b.obj", tool.SQUARE.format(z=3))
        out = self.path("both.crease")
        self.assertEqual(self.json("build", a, b, "-o", out)["triangles"], 4)
        self.assertEqual(self.json("info", out)["parts"], 2)

    def test_build_prints_what_was_ugly_and_where_normals_come_from(self):
        ugly = self.write("ugly.obj", tool.TETRAHEDRON + "f 1 1 2\nv 9 9 9\n")
        done = self.run_tool("build", ugly, "-o", self.path("ugly.crease"))
        self.assertRegex(done.stderr, r"1 triangles with two equal corners dropped")
        self.assertRegex(done.stderr, r"1 isolated vertices dropped")
        self.assertRegex(done.stderr, r"normals: .*\w")

    def test_normal_policies_change_the_kinds(self):
        model = self.write("t.obj", tool.TETRAHEDRON)
        flat = self.json("info", model, "--normals", "flat")
        self.assertEqual((flat["fn_triangles"], flat["nsn_vertices"]), (4, 4))
        smooth = self.json("info", model, "--normals", "smooth")
        self.assertEqual((smooth["sn_triangles"], smooth["sn_vertices"]), (4, 4))
        self.assertEqual(self.json("info", model, "--normals", "crease:10")["fn_triangles"], 4)

    def test_info_of_a_crease_file(self):
        info = self.json("info", self.built())
        self.has(info, "triangles", "vertices", "sn_vertices", "nsn_vertices", "sn_triangles",
                 "fn_triangles", "nsn_triangles", "attributes", "bytes", "bits_per_vertex", "bands",
                 "blocks", "depth", "linear_bytes")
        self.has(info["bits_per_vertex"], "total", "connectivity", "positions", "attributes")
        self.has(info["linear_bytes"], "crease", "wedge", "replicated")
        self.assertEqual(info["sn_triangles"] + info["fn_triangles"] + info["nsn_triangles"],
                         info["triangles"])
        self.assertEqual(info["sn_vertices"] + info["nsn_vertices"], info["vertices"])
        self.assertEqual(info["attributes"][0]["role"], "normal")
        self.assertEqual(info["bytes"], pathlib.Path(self.built()).stat().st_size)
        self.assertEqual(sum(b["patches"] for b in info["bands"]) + 1, info["blocks"])  # the base
        errors = [b["surface_error"] for b in info["bands"]]
        self.assertEqual(errors, sorted(errors))
        self.assertGreater(info["depth"], 3)
        self.assertLess(info["linear_bytes"]["crease"], info["linear_bytes"]["replicated"])

    def test_what_was_read_of_a_file_is_part_of_it(self):
        model = self.built()
        size = os.path.getsize(model)
        self.assertEqual(self.json("info", model)["bytes_read"], size)
        self.assertEqual(self.json("validate", model)["bytes_read"], size)
        self.assertLess(self.json("info", model, "--head")["bytes_read"], size)
        level = ["extract", model, "-o", self.path("a.ply"), "--triangles", 200]
        read = self.json(*level)["bytes_read"]
        self.assertEqual(read, self.json(*level, "--samples", 0)["bytes_read"])
        self.assertLess(read, size / 2)
        page = ["report", model, "-o", self.path("a.html"), "--levels", "0.1", "--size", "64x64"]
        self.assertEqual(self.json(*page)["bytes_read"], size)

    def test_info_of_a_mesh_file_agrees_with_the_file_built_from_it(self):
        mesh, file = self.json("info", self.city()), self.json("info", self.built())
        self.has(mesh, "import", "bounds")
        for key in ("triangles", "vertices", "sn_vertices", "fn_triangles", "nsn_triangles"):
            self.assertEqual(mesh[key], file[key], key)

    def test_extract_by_count_and_ratio(self):
        full = self.json("info", self.built())["triangles"]
        for option, value, most in (("--triangles", 500, 500), ("--ratio", 0.25, int(full / 4 + 0.5))):
            out = self.path("level.ply")
            level = self.json("extract", self.built(), "-o", out, option, value)
            self.has(level, "asked", "triangles", "vertices", "stopped_by", "error",
                     "error_measured", "bytes_read", "blocks_read", "seconds")
            self.has(level["error"], "surface", "line", "degrees", "texture")
            self.has(level["error_measured"], "surface_mean", "surface_max", "degrees_mean")
            self.assertEqual(level["asked"], {option[2:]: value})
            self.assertEqual(level["stopped_by"], "triangles")
            self.assertTrue(0.9 * most <= level["triangles"] <= most)
            self.assertEqual(self.json("info", out)["triangles"], level["triangles"])

    def test_extract_by_error_keeps_its_promise_when_measured_anew(self):
        full = self.path("full.ply")
        self.json("extract", self.built(), "-o", full)
        counts = []
        for length in (0.05, 0.5, 5):
            out = self.path("level.ply")
            level = self.json("extract", self.built(), "-o", out, "--error", length, "--strict")
            self.assertLessEqual(level["error_measured"]["surface_max"], length)
            # Whatever the samples are: the promise is one for all points.
            again = self.json("compare", full, out, "--samples", 100, "--seed", 7)
            worst = max(again["distance"]["max"].values())
            self.assertLessEqual(worst, length + 1e-8 * again["diagonal"])
            bound = max(again["distance"]["bound"].values())
            self.assertLessEqual(bound, worst * 1.01 + 1e-8 * again["diagonal"])
            self.assertIn(level["stopped_by"], ("error", "base"))
            counts.append(level["triangles"])
        self.assertEqual(counts, sorted(counts, reverse=True))
        self.assertLess(counts[-1], counts[0])

    def test_extract_by_error_zero_loses_nothing(self):
        box = self.write("t.obj", tool.TETRAHEDRON)
        level = self.json("extract", box, "-o", self.path("t.ply"), "--error", 0, "--strict")
        self.assertEqual(level["triangles"], 4)
        self.assertLess(level["error_measured"]["surface_max"], 1e-12)

    def test_extract_by_error_keeps_charts_where_they_are(self):
        # A plane of 16 x 16 squares, each with a chart of its own, anywhere in the texture.
        lines, count = [], 16
        places = list(range(count * count))
        random.Random(1).shuffle(places)
        for j in range(count + 1):
            lines += [f"v {i} {j} {0.01 * ((7 * i + 3 * j) % 5)}" for i in range(count + 1)]
        for place in places:
            u, v = place % count / count, place // count / count
            for x, y in ((0, 0), (1, 0), (1, 1), (0, 1)):
                lines.append(f"vt {u + x / 20:.6f} {v + y / 20:.6f}")
        for j in range(count):
            for i in range(count):
                a, b = j * (count + 1) + i + 1, 4 * (j * count + i)
                c, d = a + count + 2, a + count + 1
                lines.append(f"f {a}/{b + 1} {a + 1}/{b + 2} {c}/{b + 3} {d}/{b + 4}")
        plane = self.write("charts.obj", "\n".join(lines) + "\n")
        level = self.json("extract", plane, "-o", self.path("level.obj"), "--error", 0.05)
        uv = next(a for a in level["error_measured"]["attributes"] if a["name"] == "uv")
        self.assertLess(20 * uv["p95"], 4 * 0.05)
        ratio = self.json("extract", plane, "-o", self.path("level.obj"), "--ratio", 0.5)
        uv = next(a for a in ratio["error_measured"]["attributes"] if a["name"] == "uv")
        self.assertLess(ratio["error_measured"]["surface_max"], 0.05)
        self.assertGreater(20 * uv["p95"], 1)

    def test_extract_by_error_keeps_the_patches_of_another_material(self):
        # A plane of 32 x 32 squares, every eighth one blue: no distance sees them go.
        lines, count = ["mtllib none.mtl"], 32
        lines += [f"v {i} {j} 0" for j in range(count + 1) for i in range(count + 1)]
        for j in range(count):
            for i in range(count):
                a = j * (count + 1) + i + 1
                lines.append("usemtl " + ("blue" if i % 8 == 3 and j % 8 == 3 else "white"))
                lines.append(f"f {a} {a + 1} {a + count + 2} {a + count + 1}")
        plane = self.write("plane.obj", "\n".join(lines) + "\n")
        out = self.path("level.obj")
        level = self.json("extract", plane, "-o", out, "--error", 0.01)
        with open(out, encoding="utf-8") as file:
            faces = {}
            material = None
            for line in file:
                if line.startswith("usemtl"):
                    material = line.split()[1]
                elif line.startswith("f "):
                    faces[material] = faces.get(material, 0) + 1
        self.assertEqual(faces.get("blue"), 2 * 16)
        self.assertLess(level["triangles"], 250)
        self.assertLess(level["error"]["line"], 16 * 0.01)

    def test_streams_are_the_bytes_of_the_blocks(self):
        facts = self.json("info", self.hills())
        blocks = facts["bytes"] - facts["container_bytes"]
        self.assertAlmostEqual(sum(facts["streams"].values()) / 8, blocks, delta=8 * facts["blocks"])

    def test_extract_writes_every_format_and_reads_any_mesh(self):
        for extension in ("obj", "ply", "stl", "glb"):
            out = self.path("level." + extension)
            level = self.json("extract", self.city(), "-o", out, "--ratio", 0.5, "--samples", 0)
            self.assertIsNone(level["error_measured"])
            self.assertEqual(self.json("info", out)["triangles"], level["triangles"], extension)

    def test_an_stl_far_from_the_origin_says_what_it_is_written_less(self):
        def far(extension, *, at=(390000.1, 5820000.2, 0)):
            lines = tool.TETRAHEDRON.splitlines()
            for i, line in enumerate(lines):
                if line.startswith("v "):
                    lines[i] = "v " + " ".join(str(float(x) + o)
                                               for x, o in zip(line.split()[1:], at))
            model = self.write("far.obj", "\n".join(lines) + "\n")
            return self.run_tool("extract", model, "-o", self.path("far" + extension), "--json")

        stl = far(".stl")
        made = json.loads(stl.stdout)
        self.assertEqual(made["origin"], [390001, 5820001, 1])
        self.assertLess(made["rounding"], 1e-6)
        self.assertIn("far.stl: written less 390001 5820001 1,", stl.stderr)
        low = self.json("info", self.path("far.stl"))["bounds"]["low"]
        for x, expected in zip(low, (390000.1, 5820000.2, 0)):
            self.assertAlmostEqual(x, expected, 5)
        for other in (far(".ply"), far(".glb"), far(".stl", at=(2, 3, 4))):
            self.assertEqual(json.loads(other.stdout)["origin"], [0, 0, 0])
            self.assertNotIn("written less", other.stderr)

    def test_numbers_that_are_no_floats_are_told(self):
        model = self.write("ids.ply", "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\n"
                           "property float y\nproperty float z\nelement face 1\n"
                           "property list uchar int vertex_indices\nproperty int id\nend_header\n"
                           "0 0 0\n1 0 0\n0 1 0\n3 0 1 2 123456789\n")
        made = self.run_tool("build", model, "-o", self.path("ids.crease"), "--json")
        note = "1 values of 'id' rounded to floats, by 3 at most"
        self.assertIn(note, json.loads(made.stdout)["import"]["notes"])
        self.assertIn(note, made.stderr)

    def test_what_an_output_leaves_out_is_told(self):
        parts = self.json("info", self.built())["parts"]

        def left_out(name, model=self.built(), *options):
            made = self.run_tool("extract", model, "-o", self.path(name), "--json", *options)
            return json.loads(made.stdout)["left_out"], made.stderr

        for name in ("a.ply", "a.obj", "a.glb"):
            words, log = left_out(name)
            self.assertEqual(words, [])
            self.assertNotIn("leaves out", log)
            self.assertEqual(self.json("info", self.path(name))["parts"], parts)
        words, log = left_out("a.stl")
        self.assertEqual((words[0], words[-1]), ("normals", f"parts ({parts})"))
        self.assertIn("a.stl: leaves out normals, ", log)
        # Part names lie at the end of the file.
        whole = pathlib.Path(self.built()).read_bytes()
        cut = self.write("cut.crease", whole[:-1])
        view = self.camera("near.json", [60, -60, 40])
        for options in (("--triangles", 500, "--samples", 0), ("--view", view, "--samples", 0),
                        ("--levels", 2)):
            words, log = left_out("b.glb", cut, *map(str, options))
            self.assertEqual(words, [f"parts ({parts})"])
            self.assertIn("cut.crease: the names of its parts are missing: the file was cut", log)

    def test_how_many_parts_a_level_has_is_told(self):
        parts = self.json("info", self.built())["parts"]

        def extract(name, *options):
            made = self.run_tool("extract", self.built(), "-o", self.path(name), "--samples", "0",
                                 "--json", *options)
            return json.loads(made.stdout)

        whole = extract("whole.glb")
        self.assertEqual((whole["parts"], whole["full_parts"]), (parts, parts))
        coarse = extract("coarse.glb", "--ratio", "0.02")
        self.assertEqual(coarse["full_parts"], parts)
        self.assertLess(coarse["parts"], parts)
        self.assertEqual(self.json("info", self.path("coarse.glb"))["parts"], coarse["parts"])
        text = self.run_tool("extract", self.built(), "-o", self.path("c.glb"), "--samples", "0",
                             "--ratio", "0.02").stdout
        self.assertIn(f"{coarse['parts']:,} of {parts:,} parts".replace(",", " "), text)
        view = self.camera("far.json", [9000, -9000, 4000])
        seen = extract("seen.glb", "--view", view)
        self.assertEqual((seen["parts"] <= parts, seen["full_parts"]), (True, parts))
        self.assertNotIn("parts", extract("coarse.stl", "--ratio", "0.02"))
        for options in (), ("--lod-glb",):
            levels = extract("chain.glb", "--levels", "2", "--step", "0.02", *options)["levels"]
            self.assertEqual([level["parts"] for level in levels], [parts, coarse["parts"]])
            self.assertEqual(levels[1]["full_parts"], parts)

    def test_an_ending_may_be_in_capitals(self):
        model = self.write("t.obj", tool.TETRAHEDRON)
        for command, name in (("build", "A.CREASE"), ("extract", "A.GLB"), ("extract", "A.Obj"),
                              ("report", "A.HTML"), ("render", "A.PNG")):
            self.run_tool(command, model, "-o", self.path(name))
            self.assertIn(name, self.files())
        self.run_tool("extract", model, "-o", self.path("B.GLB"), "--levels", 2)
        textured = self.json("info", self.painted())["images"]
        self.run_tool("extract", self.path("painted.obj"), "-o", self.path("P.GLB"))
        self.assertEqual(len(self.json("info", self.path("P.GLB"))["images"]), len(textured))

    def test_extract_of_everything_is_the_snapped_model(self):
        out = self.path("all.ply")
        self.json("extract", self.built(), "-o", out)
        c = self.json("compare", self.city(), out, "--samples", 5000)
        step = self.json("info", self.built())["precision"]
        self.assertLess(max(c["distance"]["max"].values()), 2 * step)
        self.assertLess(c["normal_deviation"]["mean"], 0.5)

    def test_extract_writes_a_chain_with_a_manifest(self):
        self.json("extract", self.built(), "-o", self.path("lod.glb"), "--levels", 3)
        manifest = json.loads(pathlib.Path(self.path("lod.json")).read_text())
        counts = [level["triangles"] for level in manifest["levels"]]
        self.assertEqual(len(counts), 3)
        for level, coarser in zip(counts, counts[1:]):
            self.assertTrue(0.4 * level < coarser <= 0.51 * level, counts)
        for level in manifest["levels"]:
            self.has(level["error_measured"], "surface_max", "degrees_mean")
            info = self.json("info", self.path(level["file"]))
            self.assertEqual(info["triangles"], level["triangles"])

    def test_extract_writes_a_chain_as_one_glb(self):
        out = self.path("lod.glb")
        report = self.json("extract", self.built(), "-o", out, "--levels", 3, "--lod-glb")
        gltf = glb_json(out)
        root = gltf["nodes"][gltf["scenes"][0]["nodes"][0]]
        ids = root["extensions"]["MSFT_lod"]["ids"]
        self.assertIn("MSFT_lod", gltf["extensionsUsed"])
        self.assertEqual(len(root["extras"]["MSFT_screencoverage"]), 3)

        def triangles(node):
            node = gltf["nodes"][node]
            own = 0
            if "mesh" in node:
                own = sum(gltf["accessors"][p["indices"]]["count"] // 3
                          for p in gltf["meshes"][node["mesh"]]["primitives"])
            return own + sum(map(triangles, node.get("children", [])))

        counts = [triangles(gltf["scenes"][0]["nodes"][0])] + [triangles(i) for i in ids]
        self.assertEqual(counts, [level["triangles"] for level in report["levels"]])
        # A reader without the extension sees the finest level.
        self.assertEqual(self.json("info", out)["triangles"], counts[0])

    def test_compare_of_parallel_squares_is_their_distance(self):
        a = self.write("a.obj", tool.SQUARE.format(z=0))
        b = self.write("b.obj", tool.SQUARE.format(z=0.5))
        c = self.json("compare", a, b, "--samples", 1000)
        self.has(c, "distance", "normal_deviation", "samples")
        for key in ("mean", "rms", "max"):
            self.assertAlmostEqual(c["distance"][key]["a_to_b"], 0.5, 6)
            self.assertAlmostEqual(c["distance"][key]["b_to_a"], 0.5, 6)
            self.assertAlmostEqual(c["distance"][key + "_relative"]["a_to_b"], 0.5 / 2**0.5, 6)
        self.has(c["normal_deviation"], "mean", "p95", "max")
        self.assertAlmostEqual(c["normal_deviation"]["max"], 0, 3)
        self.assertEqual(c["samples"], 1000)
        self.assertEqual(c["attributes"], [])

    def test_compare_and_extract_say_how_far_colours_and_labels_are_off(self):
        def write(name, blue, label):
            corners = "".join(f"{x} {y} 0 {int(255 * x)} 0 {blue}\n" for y in (0, 1) for x in (0, 1))
            return self.write(name, "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\n"
                              "property float y\nproperty float z\nproperty uchar red\n"
                              "property uchar green\nproperty uchar blue\nelement face 2\n"
                              "property list uchar int vertex_indices\nproperty uchar label\n"
                              f"end_header\n{corners}3 0 1 3 1\n3 0 3 2 {label}\n")
        a, b = write("a.ply", 0, 1), write("b.ply", 51, 2)
        color, label = self.json("compare", a, b, "--samples", 10000)["attributes"]
        self.assertEqual((color["name"], color["unit"]), ("color", "values"))
        for key in ("mean", "p95", "max"):
            self.assertAlmostEqual(color[key], 0.2, 5)
        self.assertEqual((label["name"], label["unit"]), ("label", "share"))
        self.assertAlmostEqual(label["mean"], 0.5, 2)
        self.assertIn("label      differs on 50", self.run_tool("compare", a, b).stdout)
        self.run_tool("build", a, "-o", self.path("a.crease"))
        whole = self.json("extract", self.path("a.crease"), "-o", self.path("whole.ply"))
        self.assertEqual([round(attribute["max"], 9)
                          for attribute in whole["error_measured"]["attributes"]], [0, 0])

    def test_compare_makes_normals_of_both_alike(self):
        # A scan, and a level of it that has too few triangles to look like one.
        chance = random.Random(1)
        def rough(name, n):
            lines = [f"v {x / n} {y / n} {0.45 * chance.random() / n}"
                     for y in range(n + 1) for x in range(n + 1)]
            for y in range(n):
                for x in range(1, n + 1):
                    a, b = y * (n + 1) + x, (y + 1) * (n + 1) + x
                    lines += [f"f {a} {a + 1} {b}", f"f {b} {a + 1} {b + 1}"]
            return self.write(name, "\n".join(lines))
        scan, level = rough("scan.obj", 40), rough("level.obj", 20)
        normals = self.json("compare", scan, level, "--samples", 100)["normals"]
        self.assertIn("smooth (a scan", normals["a"])
        self.assertEqual(normals["b"], "smooth, as asked for")
        normals = self.json("compare", level, level, "--samples", 100)["normals"]
        self.assertIn("hard edges", normals["b"])
        city = self.json("compare", self.city(), self.city(), "--samples", 100)["normals"]
        self.assertEqual(city, {"a": "the file's", "b": "the file's"})

    def test_render(self):
        out = self.path("levels.png")
        view = self.write("cam.json", json.dumps(
            {"position": [300, -300, 200], "target": [0, 0, 0], "up": [0, 0, 1]}))
        picture = self.json("render", self.built(), "-o", out, "--levels", "1,0.2,0.02",
                            "--control", "--size", "330x200", "--view", view)
        self.assertEqual(len(picture["panels"]), 6)
        counts = [p["triangles"] for p in picture["panels"][:3]]
        for count, share in zip(counts, (1, 0.2, 0.02)):
            self.assertLessEqual(count, math.ceil(share * counts[0]))
        self.assertEqual([p["control"] for p in picture["panels"]], [False] * 3 + [True] * 3)
        self.assertEqual(tool.png_size(out), (330, 200))
        for color in ("kind", "level", "error"):
            self.json("render", self.built(), "-o", out, "--ratio", 0.1, "--color", color,
                      "--wireframe", "--size", "160x120")
            self.assertEqual(tool.png_size(out), (160, 120))
        self.json("render", self.city(), "-o", out, "--size", "160x120")
        tetrahedron = self.write("t.obj", tool.TETRAHEDRON)  # levels of 4 and 2 triangles
        told = self.run_tool("render", tetrahedron, "-o", out, "--triangles", 1, "--size", "160x120")
        self.assertIn("target not met: the coarsest level has 2 triangles", told.stderr)

    def test_what_a_build_has_decided_is_not_asked_for_again_in_silence(self):
        out = self.path("level.obj")
        told = self.run_tool("extract", self.built(), "-o", out, "--ratio", 0.1, "--samples", 0,
                             "--normals", "flat", "--precision", 0.01)
        self.assertIn("--normals, --precision of no effect", told.stderr)
        self.assertNotIn("of no effect", self.run_tool("extract", self.built(), "-o", out,
                                                       "--ratio", 0.1, "--samples", 0).stderr)

    def test_validate(self):
        whole = self.json("validate", self.built())
        self.assertEqual(whole["errors"], [])
        self.assertTrue(whole["ok"])
        self.has(whole["hierarchy"], "splits", "bytes", "hard_edges", "seconds")
        edges = whole["hierarchy"]["hard_edges"]
        self.assertGreater(edges["count"], 1000)
        self.assertEqual((edges["soft_at_one_end"], edges["soft_at_both_ends"]), (0, 0))
        file_only = self.json("validate", self.built(), "--file-only")
        self.assertTrue(file_only["ok"])
        self.assertIsNone(file_only["hierarchy"])

    def test_quiet_leaves_standard_error_empty(self):
        done = self.run_tool("build", self.city(), "-o", self.path("q.crease"), "--quiet")
        self.assertEqual((done.stdout, done.stderr), ("", ""))
        answer = self.run_tool("info", self.path("q.crease"), "--quiet")
        self.assertIn("triangles", answer.stdout)
        self.assertEqual(answer.stderr, "")
        answer = self.run_tool("validate", self.path("q.crease"), "--quiet")
        self.assertIn("valid", answer.stdout)
        self.assertEqual(answer.stderr, "")


if __name__ == "__main__":
    tool.main()
