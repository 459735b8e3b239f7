"""The real models: each is built, or refused with a message that names the file and a reason."""

import os
import subprocess

import tool

# Packed; larger ones are for the benchmarks. A sanitized tool takes ten times as long.
SANITIZED = os.environ.get("CREASE_SANITIZED") == "ON"
BIGGEST_BYTES = 150_000 if SANITIZED else 1_200_000


def models(folder):
    endings = (".obj", ".ply", ".stl", ".off", ".gltf", ".glb", ".b3dm", ".zst", ".xz")
    found = [p for p in (tool.SHARED / folder).rglob("*") if p.name.endswith(endings)]
    return sorted(p for p in found if p.stat().st_size <= BIGGEST_BYTES)


class Nasty(tool.Case):
    def build(self, path, *options):
        out = self.path("model.crease")
        done = subprocess.run([tool.BINARY, "build", str(path), "-o", out, *options],
                              capture_output=True, text=True, errors="replace")
        return done, out

    def test_broken_files_build_or_are_refused(self):
        outcomes = {}
        for path in models("nasty"):
            with self.subTest(path.name):
                done, out = self.build(path)
                outcomes[path.name] = done.returncode
                self.assertIn(done.returncode, (0, 2, 3), done.stderr)
                if done.returncode == 0:
                    self.assertTrue(self.json("validate", out)["ok"])
                else:
                    self.assertRegex(done.stderr, r"crease: .*" + path.name.split(".")[0])
        refused = ("empty.obj", "empty.ply", "empty_header_only.ply", "empty_header_only.stl",
                   "degenerate_only.obj", "values_inf_nan.obj", "values_inf_points.ply",
                   "parse_zero_index.obj", "parse_relative_index_too_far.obj",
                   "parse_huge_count.off", "truncated_chunk.glb", "truncated_ascii.ply",
                   "truncated_after_header.glb", "truncated_by_one.glb", "parse_bad_json.glb",
                   "node_loop_scene.gltf", "index_buffer_oob.gltf", "parse_utf16.obj")
        built = ("topology_moebius.obj", "topology_three_on_an_edge.obj", "topology_soup.stl",
                 "topology_everything_twice.obj", "orientation_mixed.stl", "degenerate_faces.obj",
                 "parse_negative_indices.obj", "parse_concave_64gon.obj",
                 "values_zero_normals.obj", "parse_triangle_strips.gltf",
                 "everything_wrong_station.glb.xz")
        for names, status in ((refused, 2), (built, 0)):
            for name in names:
                if name in outcomes:
                    self.assertEqual(outcomes[name], status, name)

    def test_a_triangle_far_away_from_all_others_is_told_with_what_it_costs(self):
        far = "".join(f"v {x} {y} 900000\n" for x, y in ((0, 0), (1, 0), (0, 1)))
        whole = "".join(f"v {i % 12} {i // 12} 0\n" for i in range(144))
        grid = "".join(f"v {i % 12} {i // 12} {(i % 7) / 3e4}\n" for i in range(144))
        faces = "".join(f"f {i + 4} {i + 5} {i + 16}\n" for i in range(132) if i % 12 < 11)
        stray, out = self.write("stray.obj", far + grid + "f 1 2 3\n" + faces), self.path("a.crease")
        # By default the others get the finest steps that there are with it; bits make them coarse.
        for by_bits in ((), ("--precision", "24bits")):
            notes = self.json("build", stray, "-o", out, *by_bits)["import"]["notes"]
            self.assertEqual(len(notes), 1, notes)
            step = self.json("info", out)["precision"]
            for words in ("3 of 146 vertices", "9e+05", "11 without", f"steps of {step:.4g}"):
                self.assertIn(words, notes[0])
            self.assertEqual("--precision" in notes[0], by_bits != ())
            self.assertEqual(step > 0.01, by_bits != ())
        finest = notes[0].split("--precision ")[1].split(",")[0]
        self.assertLess(float(finest), step / 60)
        self.assertEqual(self.json("build", stray, "-o", out, "--precision", finest)["import"]["notes"],
                         [])
        extracted = self.run_tool("extract", stray, "-o", self.path("a.ply"), "--ratio", "0.5",
                                  "--precision", "24bits")
        self.assertIn(notes[0], extracted.stderr)
        # It costs nothing where all of them are on a grid, of which there are enough steps.
        stray = self.write("whole.obj", far + whole + "f 1 2 3\n" + faces)
        self.assertEqual(self.json("build", stray, "-o", out)["import"]["notes"], [])
        self.assertEqual(self.json("info", out)["precision"], 2 ** -10)

    def test_good_files_build_and_lose_nothing(self):
        for folder in ("cad", "attributes", "scan", "city"):
            for path in models(folder)[:6]:
                with self.subTest(path.name):
                    done, out = self.build(path, "--quiet")
                    self.assertEqual(done.returncode, 0, done.stderr)
                    mesh, file = self.json("info", path), self.json("info", out)
                    for key in ("triangles", "vertices", "parts", "materials"):
                        self.assertEqual(mesh[key], file[key], key)
                    self.assertEqual([(a["name"], a["dimension"]) for a in mesh["attributes"]],
                                     [(a["name"], a["dimension"]) for a in file["attributes"]])


if __name__ == "__main__":
    tool.main()
