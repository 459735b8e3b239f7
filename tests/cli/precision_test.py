"""What `build` rounds: positions to a grid, normals, texture coordinates and colours to bits."""

import tool


class Precision(tool.Case):
    def test_precision_is_a_length_or_bits(self):
        model = self.write("square.obj", tool.SQUARE.format(z=0.123))
        for text, step in (("0.0625", 0.0625), ("3bits", None)):
            out = self.path("square.crease")
            self.json("build", model, "-o", out, "--precision", text)
            got = self.json("info", out)["precision"]
            if step is not None:
                self.assertEqual(got, step)
            else:
                self.assertTrue(1 / 8 <= got <= 1 / 6, got)

    def deviation_at_full(self, *options):
        out, full = self.path("bits.crease"), self.path("bits.ply")
        built = self.json("build", self.city(), "-o", out, *options)
        self.json("extract", out, "-o", full)
        return built, self.json("compare", self.city(), full, "--samples", 5000)["normal_deviation"]

    def test_by_default_a_model_keeps_its_decimals(self):
        def corners(path):
            with open(path) as lines:
                return sorted(line for line in lines if line.startswith("v "))

        hills, built = self.hills_mesh(20), self.path("hills.crease")
        self.assertLess(self.json("build", hills, "-o", built)["position_error_max"], 1e-13)
        self.assertEqual(self.json("info", built)["precision"], 0.00001)
        self.run_tool("extract", built, "-o", self.path("again.obj"))
        numbers = [[float(x) for x in line.split()[1:]] for line in corners(hills)]
        self.assertEqual([[float(x) for x in line.split()[1:]] for line in corners(self.path("again.obj"))],
                         numbers)
        rounded = self.json("build", hills, "-o", built, "--precision", "14bits")
        self.assertEqual(rounded["precision"], 19 / 2 ** 14)
        self.assertEqual(self.json("info", built)["precision"], 19 / 2 ** 14)
        self.assertTrue(0.1 * rounded["precision"] < rounded["position_error_max"] < rounded["precision"])

    def test_normal_bits_bound_the_deviation_at_full_resolution(self):
        for options, words, most in (([], "octahedral, 12 bits", 0.04),
                                     (["--normal-bits", 10], "octahedral, 10 bits", 0.16),
                                     (["--normal-bits", 8], "octahedral, 8 bits", 0.65),
                                     (["--normal-bits", 16], "octahedral, 16 bits", 0.003),
                                     (["--normal-coding", "deering"], "Deering, 6 bits", 0.65),
                                     (["--normal-coding", "deering", "--normal-bits", 9],
                                      "Deering, 9 bits", 0.081)):
            built, deviation = self.deviation_at_full(*options)
            layer = built["snapped"][0]
            self.assertIn(words, layer["precision"])
            self.assertLess(layer["error_max"], most)
            self.assertGreater(layer["error_mean"], 0)
            self.assertLess(deviation["max"], most + 0.02)

    def test_exact_normals_are_kept(self):
        for options in (("--normal-bits", "exact"), ("--normal-bits", 0)):
            built, deviation = self.deviation_at_full(*options)
            self.assertEqual(built["snapped"][0]["precision"], "exact")
            self.assertEqual(built["snapped"][0]["error_max"], 0)
            # Where a sample lies in a sliver is known to float barycentrics alone.
            self.assertLess(deviation["max"], 0.01)
            self.assertEqual(deviation["p95"], 0)

    def test_texture_coordinates_and_colours_have_bits_of_their_own(self):
        rows = "".join(f"v {x} {y} 0 {(x + y / 77) / 40:.5f} {x * y / 777:.5f} 0.3\n"
                       f"vt {(x + y / 77) / 39:.6f} {(y + x / 77) / 38:.6f}\n" for y in range(20) for x in range(20))
        faces = "".join(f"f {i}/{i} {i + 1}/{i + 1} {i + 21}/{i + 21}\n"
                        for i in (20 * y + x + 1 for y in range(19) for x in range(19)))
        model = self.write("patch.obj", rows + faces)
        for bits, steps in (((12, 8), (2**-13, 2**-9)), ((6, 4), (2**-7, 2**-5))):
            options = ("--texcoord-bits", bits[0], "--color-bits", bits[1])
            built = self.json("build", model, "-o", self.path("patch.crease"), *options)
            errors = {s["layer"]: s["error_max"] for s in built["snapped"]}
            texture = next(errors[name] for name in errors if name.startswith("uv"))
            self.assertTrue(0 < texture <= steps[0] * 2**0.5, errors)
            self.assertTrue(0 < errors["color"] <= steps[1] * 3**0.5, errors)
        built = self.json("build", model, "-o", self.path("patch.crease"), "--texcoord-bits", "exact",
                          "--color-bits", "exact", "--normal-bits", "exact")
        self.assertEqual([s["precision"] for s in built["snapped"]], ["exact"] * 3)


if __name__ == "__main__":
    tool.main()
