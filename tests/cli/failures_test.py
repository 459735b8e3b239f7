"""Every way to fail has its exit status, a message that names file, place and reason, and leaves
nothing half done."""

import json
import os
import pathlib
import re
import resource
import signal
import socket
import stat
import subprocess

import tool


def limit_file_size():
    resource.setrlimit(resource.RLIMIT_FSIZE, (10000, 10000))


def limit_memory():
    resource.setrlimit(resource.RLIMIT_DATA, (24 << 20, 24 << 20))


class Failures(tool.Case):
    def fails(self, exit_status, *arguments):
        failed = self.json(*arguments, exit_status=exit_status)
        self.assertEqual(failed["exit_status"], exit_status)
        self.assertTrue(failed["error"]["message"])
        return failed["error"]

    def test_a_length_that_no_grid_has_is_refused_and_the_finest_one_is_not(self):
        model, out = self.write("square.obj", tool.SQUARE.format(z=0.123)), self.path("fine.crease")
        refused = self.fails(1, "build", model, "-o", out, "--precision", "1e-12")
        self.json("build", model, "-o", out, "--precision", refused["message"].split()[-1])
        self.assertAlmostEqual(self.json("info", out)["precision"] * 2**30, 1, delta=0.01)

    def test_1_command_line(self):
        city = self.city()
        for arguments in ([], ["unknown"], ["build"], ["build", city], ["info"],
                          ["extract", city, "-o", "x.ply", "--ratio", "2"],
                          ["extract", city, "-o", "x.ply", "--triangles", "0"],
                          ["extract", city, "-o", "x.ply", "--triangles", "9", "--ratio", "0.5"],
                          ["extract", city, "-o", "x.ply", "--lod-glb"],
                          ["compare", city], ["render", city, "-o", "x.png", "--color", "pink"],
                          ["generate", "castle", "-o", "x.ply"], ["info", city, "--threads", "-1"],
                          ["view", city, "--mode", "magic"], ["serve"]):
            self.assertEqual(self.fails(1, *arguments)["name"], "CommandLine")
        for arguments in (["build", city, "-o", "x.crease", "--precision", "fine"],
                          ["build", city, "-o", "x.crease", "--precision", "31bits"],
                          ["build", city, "-o", "x.crease", "--precision", "-1"],
                          ["build", city, "-o", "x.crease", "--normals", "soft"],
                          ["build", city, "-o", "x.crease", "--normal-bits", "7"],
                          ["build", city, "-o", "x.crease", "--normal-bits", "17"],
                          ["build", city, "-o", "x.crease", "--normal-bits", "13",
                           "--normal-coding", "deering"],
                          ["build", city, "-o", "x.crease", "--texcoord-bits", "many"],
                          ["build", city, "-o", "x.crease", "--color-bits", "8.5"],
                          ["extract", city, "-o", "x.ply", "--error", "1", "--samples", "0"],
                          ["extract", city, "-o", "x.ply", "--ratio", "nan"],
                          ["extract", city, "-o", "x.ply", "--error", "nan"],
                          ["extract", city, "-o", "x.ply", "--error", "inf"],
                          ["build", city, "-o", "x.crease", "--same-normal", "nan"],
                          ["render", city, "-o", "x.png", "--samples", "-1"],
                          ["report", city, "-o", "x.html", "--samples", "-1"],
                          ["compare", city, city, "--samples", "0"],
                          ["extract", city, "-o", "x.ply", "--samples", "-1"],
                          ["extract", city, "-o", "x.ply", "--samples", "1000000001"],
                          ["extract", city, "-o", "x.ply", "--samples", "9" * 20],
                          ["extract", city, "-o", "x.glb", "--levels", "2", "--ratio", "0.5"],
                          ["extract", city, "-o", "x.ply", "--view", "c.json", "--ratio", "0.5"],
                          ["extract", city, "-o", "x.ply", "--triangles", "9", "--degrees", "2"],
                          ["extract", city, "-o", "x.ply", "--consistent"],
                          ["render", city, "-o", "x.png", "--view", "c.json", "--ratio", "1",
                           "--consistent"],
                          ["render", city, "-o", "x.png", "--levels", "1,0,2"],
                          ["render", city, "-o", "x.png", "--size", "10"]):
            self.assertEqual(self.fails(1, *arguments)["name"], "CommandLine")
        # A grid coarser than the model, as one gets who means bits and says a length.
        tiny = self.write("tiny.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n")
        for arguments in (["build", tiny, "-o", self.path("x.crease"), "--precision", "14"],
                          ["extract", tiny, "-o", self.path("x.ply"), "--precision", "14"]):
            self.assertIn("14bits", self.fails(1, *arguments)["message"])
        self.run_tool("build", tiny, "-o", self.path("x.crease"), "--precision", "0.0625")
        self.run_tool("build", tiny, "-o", self.path("x.crease"), "--precision", "0.07",
                      exit_status=1)

    def test_the_wrong_word_is_named(self):
        for words, named in ((["bogus"], "'bogus'"), (["--nosuch"], "'--nosuch'"),
                             (["info", "x.ply", "--nosuch"], "--nosuch"), ([], "command"),
                             (["info"], "FILE"), (["build", "x.ply", "--output"], "--output")):
            done = self.run_tool(*words, exit_status=1)
            self.assertRegex(done.stderr, f"^crease: [^\n]*{named}[^\n]*\n$")

    def test_out_of_memory_is_told(self):
        if os.environ.get("CREASE_SANITIZED") == "ON":
            self.skipTest("a sanitizer has no such limit")
        city = self.city(200_000)
        done = subprocess.run([tool.BINARY, "info", city, "--json"], capture_output=True, text=True,
                              preexec_fn=limit_memory)
        self.assertEqual(done.returncode, 3, done.stderr)
        self.assertEqual(json.loads(done.stdout)["error"]["name"], "OutOfMemory")

    def test_a_number_out_of_range_is_told_with_its_range(self):
        for option, value, wanted in (("--triangles", "0", "of 1 or more"),
                                      ("--ratio", "0", "above 0 and up to 1"),
                                      ("--error", "-1", "of 0 or more"),
                                      ("--error", "inf", "of 0 or more"),
                                      ("--same-normal", "181", "from 0 to 180"),
                                      ("--samples", "-1", "from 0 to 1000000000")):
            done = self.run_tool("extract", self.city(), "-o", "x.ply", option, value,
                                 exit_status=1)
            self.assertIn(f"{option}: '{value}' is no number {wanted}", done.stderr)

    def test_2_input_cannot_be_read(self):
        out = self.path("x.crease")
        self.assertEqual(self.fails(2, "build", self.path("none.obj"), "-o", out)["name"], "NotFound")
        self.assertIn("none.crease", self.fails(2, "info", self.path("none.crease"))["message"])
        bad = self.write("bad.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 9\n")
        message = self.fails(2, "build", bad, "-o", out)["message"]
        self.assertRegex(message, r"bad\.obj:4\b")
        nothing = self.write("nothing.obj", "v 0 0 0\n")
        self.fails(2, "build", nothing, "-o", out)
        text = self.write("text.crease", "this is no model, whatever its name says\n" * 4)
        self.assertEqual(self.fails(2, "info", text)["name"], "NotCrease")
        self.assertEqual(self.fails(2, "validate", self.city())["name"], "NotCrease")
        self.fails(2, "extract", text, "-o", self.path("x.ply"))
        self.fails(2, "extract", self.city(), "-o", self.path("x.ply"), "--view",
                   self.path("none.json"))
        view = self.write("cam.json", "{\"position\": 3}")
        self.assertIn("cam.json", self.fails(2, "render", self.city(), "-o", self.path("x.png"),
                                             "--view", view)["message"])
        self.assertFalse(os.path.exists(out))

    def test_2_a_file_cut_anywhere_is_refused(self):
        whole = pathlib.Path(self.built(1500)).read_bytes()
        for share in (0, 0.01, 0.3, 0.6, 0.9):  # behind its blocks are names alone
            cut = self.write("cut.crease", whole[:int(share * len(whole))])
            self.fails(2, "extract", cut, "-o", self.path("x.ply"))
        cut = self.write("cut.crease", whole[:-1])
        self.fails(2, "info", cut)
        second = tool.SQUARE.format(z=1).replace("1 2 3", "5 6 7").replace("1 3 4", "5 7 8")
        parts = self.write("parts.obj", "o a\n" + tool.SQUARE.format(z=0) + "o b\n" + second)
        self.json("build", parts, "-o", self.path("parts.crease"))
        whole = pathlib.Path(self.path("parts.crease")).read_bytes()
        self.assertIn("part names", self.fails(2, "info", self.write("cut.crease", whole[:-1]))["message"])

    def test_3_not_supported(self):
        self.fails(3, "extract", self.city(), "-o", self.path("x.fbx"))
        self.fails(3, "extract", self.city(), "-o", self.path("x.ply"), "--levels", 2)
        self.fails(3, "generate", "city", "-o", self.path("x.doc"), "--triangles", 500)
        self.fails(3, "render", self.city(), "-o", self.path("x.jpg"))
        self.fails(3, "build", self.built(), "-o", self.path("x.crease"))

    def test_an_output_is_no_other_format_and_no_input(self):
        model = self.write("t.obj", tool.TETRAHEDRON)
        for ending in (".ply", ".obj", ".png", ".glb"):
            self.fails(3, "build", model, "-o", self.path("x" + ending))
            self.fails(3, "report", model, "-o", self.path("x" + ending))
        crease = self.path("t.crease")
        self.run_tool("build", model, "-o", crease)
        os.symlink(model, self.path("link.obj"))
        os.symlink(model, self.path("link.crease"))
        for name in ("t_1.glb", "t.json"):  # which a chain of t.glb would write
            os.symlink(model, self.path(name))
        before = pathlib.Path(model).read_bytes()
        for arguments in (["extract", model, "-o", model],
                          ["extract", model, "-o", self.path("link.obj")],
                          ["build", model, "-o", self.path("link.crease")],
                          ["extract", self.path("t_1.glb"), "-o", self.path("t.glb"), "--levels", 2],
                          ["extract", self.path("t.json"), "-o", self.path("t.glb"),
                           "--levels", 2]):
            self.assertIn("is an input", self.fails(1, *arguments)["message"])
        self.assertEqual(pathlib.Path(model).read_bytes(), before)

    def test_a_material_library_of_the_input_is_not_written_over(self):
        self.write("shared.mtl", "newmtl red\nKd 1 0 0\nKs 1 1 1\n")
        model = self.write("t.obj", "mtllib shared.mtl\nusemtl red\n" + tool.TETRAHEDRON)
        failure = self.fails(1, "extract", model, "-o", self.path("shared.obj"))
        self.assertIn("shared.mtl: is an input", failure["message"])
        self.assertEqual(self.files(), ["shared.mtl", "t.obj"])
        self.assertIn("Ks", pathlib.Path(self.path("shared.mtl")).read_text())
        self.run_tool("extract", model, "-o", self.path("other.obj"))
        self.assertEqual(self.files(), ["other.mtl", "other.obj", "shared.mtl", "t.obj"])

    def test_3_a_crease_in_a_pipe_is_told_from_no_format(self):
        crease = self.path("p.crease")
        self.run_tool("build", self.city(), "-o", crease)
        with open(crease, "rb") as model:
            pipe = subprocess.Popen(["cat"], stdin=model, stdout=subprocess.PIPE)
            done = subprocess.run([tool.BINARY, "info", "/dev/stdin"], stdin=pipe.stdout,
                                  capture_output=True, text=True)
            pipe.stdout.close()
            pipe.wait()
        self.assertEqual(done.returncode, 3)
        self.assertIn("is a .crease file, not a mesh", done.stderr)

    def test_4_cannot_write(self):
        nowhere = self.path("no/such/folder/")
        self.fails(4, "build", self.city(), "-o", nowhere + "x.crease")
        self.fails(4, "extract", self.city(), "-o", nowhere + "x.ply", "--ratio", 0.5)
        self.fails(4, "extract", self.city(), "-o", nowhere + "x.glb", "--levels", 2)
        self.fails(4, "render", self.city(), "-o", nowhere + "x.png", "--size", "64x64")
        self.fails(4, "generate", "city", "-o", nowhere + "x.ply", "--triangles", 500)

    def test_4_where_nothing_can_be_written_is_found_before_any_work(self):
        # A source that is not there would be what stops the work.
        absent = self.path("absent.obj")
        before = self.files()
        for out, reason in ((self.path("no/x"), "No such file or directory"),
                            (absent + "/x", "No such file or directory"),
                            (tool.__file__ + "/x", "Not a directory"),
                            (self.path("long" * 70), "File name too long")):
            for arguments in (["build", absent, "-o", out + ".crease"],
                              ["extract", absent, "-o", out + ".ply"],
                              ["extract", absent, "-o", out + ".glb", "--levels", 2, "--lod-glb"],
                              ["render", absent, "-o", out + ".png"],
                              ["report", absent, "-o", out + ".html"]):
                self.assertEqual(self.fails(4, *arguments)["message"],
                                 f"{arguments[3]}: cannot be written: {reason}")
        for arguments in (["build", "-o", "x.crease"], ["extract", "-o", "x.ply"],
                          ["extract", "-o", "x.glb", "--levels", 2]):
            command, _, out, *more = arguments
            self.fails(2, command, absent, "-o", self.path(out), *more)
        self.assertEqual(self.files(), before)

    def test_4_a_full_disk_leaves_nothing_behind(self):
        # A limit on file sizes stands in for a full disk: every write past it fails.
        city = self.city()
        before = self.files()
        for arguments in (["build", city, "-o", self.path("x.crease")],
                          ["extract", city, "-o", self.path("x.ply"), "--samples", "0"],
                          ["extract", city, "-o", self.path("x.obj"), "--samples", "0"],
                          ["extract", city, "-o", self.path("x.stl"), "--samples", "0"],
                          ["extract", city, "-o", self.path("x.glb"), "--samples", "0"],
                          ["generate", "city", "-o", self.path("y.ply"), "--triangles", "4000"]):
            done = subprocess.run([tool.BINARY, *arguments], capture_output=True, text=True,
                                  preexec_fn=limit_file_size)
            self.assertEqual(done.returncode, 4, done.stderr)
            self.assertEqual(self.files(), before, arguments)

    def test_4_output_that_a_full_disk_loses(self):
        many = self.write("many.obj", tool.TETRAHEDRON * 99)
        for arguments in (["info", many, "--json"], ["--help"], ["extract", "--help"]):
            with open(self.path("full"), "wb", buffering=0) as full:
                full.write(b" " * 19_999)  # of what limit_file_size() allows
                done = subprocess.run([tool.BINARY, *arguments], stdout=full,
                                      stderr=subprocess.PIPE, text=True,
                                      preexec_fn=limit_file_size)
            self.assertEqual(done.returncode, 4, arguments)
            self.assertIn("standard output cannot be written", done.stderr)

    def test_5_target_not_met(self):
        model = self.write("t.obj", tool.TETRAHEDRON)  # levels of 4 and 2 triangles, then none
        out = self.path("x.ply")
        short = self.json("extract", model, "-o", out, "--triangles", 1, "--strict", exit_status=5)
        self.assertEqual((short["exit_status"], short["output"]), (5, None))
        self.assertFalse(os.path.exists(out))
        level = self.json("extract", model, "-o", out, "--triangles", 1)
        self.assertEqual((level["stopped_by"], level["target_met"]), ("topology", False))
        self.assertNotIn("exit_status", level)
        self.assertTrue(os.path.exists(out))

    def test_5_a_chain_that_ends_early(self):
        model = self.write("t.obj", tool.TETRAHEDRON)  # levels of 4 and 2 triangles, then none
        before = self.files()
        for more in ([], ["--lod-glb"]):
            chain = ["extract", model, "-o", self.path("x.glb"), "--levels", 5, *more]
            self.assertEqual(self.json(*chain, "--strict", exit_status=5)["levels"], [])
            self.assertEqual(self.files(), before)
            self.assertFalse(self.json(*chain)["target_met"])
            self.run_tool("extract", model, "-o", self.path("y.glb"), "--levels", 2, *more,
                          "--strict")
            before = self.files()

    def test_6_validation_failed(self):
        whole = bytearray(pathlib.Path(self.built(1500)).read_bytes())
        for share in (0.2, 0.5, 0.9):
            changed = bytearray(whole)
            changed[int(share * len(changed))] ^= 0x10
            result = self.json("validate", self.write("changed.crease", bytes(changed)),
                               exit_status=6)
            self.assertFalse(result["ok"])
            self.assertEqual(result["exit_status"], 6)
            self.assertTrue(result["errors"][0])
        for part in (whole[:-9], whole[:100], whole + b"more"):
            file = self.write("cut.crease", bytes(part))
            result = self.json("validate", file, exit_status=6)
            self.assertFalse(result["ok"])
            self.assertEqual(result["bytes"], len(part))
            text = self.run_tool("validate", file, exit_status=6).stdout
            self.assertEqual(text.count(file), 1)

    def test_a_failed_command_leaves_the_old_output_and_nothing_else(self):
        out = self.write("old.crease", "precious")
        bad = self.write("bad.obj", "v 0 0 0\nf 1 2 3\n")
        before = self.files()
        self.fails(2, "build", bad, "-o", out)
        self.assertEqual(pathlib.Path(out).read_text(), "precious")
        self.assertEqual(self.files(), before)

    def outputs(self):
        """Of every kind of writer: the command, and how what it writes begins."""
        model = self.write("t.obj", tool.TETRAHEDRON)
        return ((["build", model], ".crease", b"\x89CREASE"), (["extract", model], ".glb", b"glTF"),
                (["extract", model], ".obj", b""), (["render", model, "--size", "64x64"], ".png",
                                                    b"\x89PNG"),
                (["report", model, "--size", "64x64"], ".html", b"<!"))

    def test_a_symlink_is_followed_and_stays(self):
        os.mkdir(self.path("there"))
        for command, ending, begin in self.outputs():
            for link, to in (("x" + ending, "there/x" + ending),
                             ("y" + ending, self.path("there/y" + ending)),
                             ("z" + ending, "y" + ending)):
                os.symlink(to, self.path(link))
                self.run_tool(*command, "-o", self.path(link))
                self.assertTrue(os.path.islink(self.path(link)))
                self.assertTrue(pathlib.Path(self.path(link)).read_bytes().startswith(begin))
            self.assertTrue(os.path.isfile(self.path("there/y" + ending)))
        self.assertEqual([f for f in self.files() if ".part" in f], [])

    def test_who_may_read_an_output_may_read_its_next(self):
        for command, ending, _ in self.outputs():
            out = self.write("x" + ending, "before")
            for mode in (0o600, 0o640):
                os.chmod(out, mode)
                self.run_tool(*command, "-o", out)
                self.assertEqual(os.stat(out).st_mode & 0o777, mode, ending)

    def test_what_goes_to_standard_output_is_not_mixed_with_what_is_said(self):
        for command, ending, _ in self.outputs():
            out = self.path("out" + ending)
            self.run_tool(*command, "-o", out)
            if command[0] in ("extract", "report"):
                continue  # has several formats
            piped = subprocess.run([tool.BINARY, *command, "-o", "/dev/stdout"],
                                   capture_output=True, env=tool.leaks.without_check())
            self.assertEqual(piped.returncode, 0, piped.stderr)
            self.assertNotIn(b"/dev/stdout: ", piped.stdout)
            self.assertIn(b"/dev/stdout: ", piped.stderr)
            self.assertEqual(piped.stdout[:4], pathlib.Path(out).read_bytes()[:4])

    def test_a_pipe_is_written_to_and_stays(self):
        for command, ending, begin in self.outputs():
            pipe = self.path("pipe" + ending)
            os.mkfifo(pipe)
            writer = subprocess.Popen([tool.BINARY, *command, "-o", pipe, "--quiet"],
                                      env=tool.leaks.without_check())
            reading = os.open(pipe, os.O_RDONLY | os.O_NONBLOCK)  # waits for no writer
            self.assertEqual(writer.wait(), 0)
            self.assertTrue(os.read(reading, 60_000).startswith(begin))
            os.close(reading)
            self.assertTrue(stat.S_ISFIFO(os.stat(pipe).st_mode))

    def test_4_a_socket_is_refused_and_stays(self):
        for command, ending, _ in self.outputs():
            path = self.path("s" + ending)
            with socket.socket(socket.AF_UNIX) as listener:
                listener.bind(path)
                self.fails(4, *command, "-o", path)
            self.assertTrue(stat.S_ISSOCK(os.stat(path).st_mode))

    def test_messages_are_one_line(self):
        done = self.run_tool("info", self.path("none.ply"), exit_status=2)
        self.assertRegex(done.stderr, re.compile(r"^crease: [^\n]*none\.ply[^\n]*\n$"))
        self.assertEqual(done.stdout, "")


if __name__ == "__main__":
    tool.main()
