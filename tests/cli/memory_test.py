"""build --memory: the same file with less memory, the rest in a file that nobody sees, and clean
failures when there is no room for that."""

import hashlib
import os
import pathlib
import re
import resource
import signal
import subprocess
import time
import unittest

import tool

SANITIZED = os.environ.get("CREASE_SANITIZED") == "ON"
MB = 1000 * 1000


class Memory(tool.Case):
    def digest(self, path):
        return hashlib.sha256(pathlib.Path(path).read_bytes()).hexdigest()

    def start(self, *arguments, **options):
        process = subprocess.Popen([tool.BINARY, "build", *arguments, "--json"], text=True,
                                   stdout=subprocess.PIPE, stderr=subprocess.PIPE, **options)
        self.addCleanup(process.stdout.close)
        self.addCleanup(process.stderr.close)
        return process

    def spill_folder(self, process):
        """Where the process has a file without a name, as soon as it has grown; None if it ends."""
        while process.poll() is None:
            try:
                for number in os.listdir(f"/proc/{process.pid}/fd"):
                    path = f"/proc/{process.pid}/fd/{number}"
                    if os.readlink(path).endswith(" (deleted)") and os.stat(path).st_size > 0:
                        return os.path.dirname(os.readlink(path))
            except OSError:
                pass  # it was closed meanwhile
            time.sleep(0.001)
        return None

    def without_tmpdir(self):
        return {name: value for name, value in os.environ.items() if name != "TMPDIR"}

    def test_the_file_is_the_same_and_memory_is_less(self):
        city = self.city(4000 if SANITIZED else 200000)
        free, bound = self.path("free.crease"), self.path("bound.crease")
        before = self.json("build", city, "-o", free)
        self.assertEqual((before["memory_limit"], before["spilled_bytes"]), (0, 0))
        after = self.json("build", city, "-o", bound, "--memory", "48MB")
        self.assertEqual(self.digest(free), self.digest(bound))
        self.assertEqual(self.files(), ["bound.crease", "city.ply", "free.crease"])
        if SANITIZED:
            self.assertEqual((after["memory_limit"], after["spilled_bytes"]), (0, 0))
            return
        self.assertEqual(after["memory_limit"], 48 * MB)
        self.assertGreater(after["spilled_bytes"], 30 * MB)
        self.assertLess(after["peak_memory"], before["peak_memory"])

    def test_enough_memory_needs_no_file(self):
        done = self.run_tool("build", self.city(), "-o", self.path("x.crease"), "--memory", "4 GiB")
        said = "sanitizer" if SANITIZED else r"within 4\.29 GB, nothing in a file"
        self.assertRegex(done.stderr, said)

    def test_sizes_that_cannot_be_meant(self):
        city = self.city()
        for size in ("much", "-1", "4XB", "GB", "1e30GB"):
            failed = self.json("build", city, "-o", self.path("x.crease"), f"--memory={size}",
                               exit_status=1)
            self.assertIn("--memory", failed["error"]["message"])
        self.assertEqual(self.json("build", city, "-o", self.path("x.crease"), "--memory",
                                   "0")["memory_limit"], 0)

    @unittest.skipIf(SANITIZED, "keeps the sanitizer's own memory")
    def test_the_file_is_beside_the_output_or_in_tmpdir_and_gone_after_an_interrupt(self):
        kind = tool.run(["stat", "-f", "-c", "%T", str(self.folder)]).stdout.strip()
        if kind in ("tmpfs", "ramfs"):
            self.skipTest("temporary files are in memory here, where the file does not go")
        city = self.city(150000)
        other = pathlib.Path(self.path("other"))
        other.mkdir()
        before = self.files()
        for tmpdir, folder in ((None, self.folder), (str(other), other)):
            environment = self.without_tmpdir()
            if tmpdir:
                environment["TMPDIR"] = tmpdir
            process = self.start(city, "-o", self.path("x.crease"), "--memory", "16MB",
                                 env=environment)
            self.assertEqual(self.spill_folder(process), str(folder))
            self.assertEqual(list(other.iterdir()), [])  # it has no name while it is used either
            process.send_signal(signal.SIGINT)
            self.assertEqual(process.wait(), 130, process.stderr.read())
            self.assertEqual(self.files(), before)
            self.assertEqual(list(other.iterdir()), [])

    @unittest.skipIf(SANITIZED, "keeps the sanitizer's own memory")
    def test_a_full_disk_is_a_failure_that_names_the_folder(self):
        # A limit on file sizes stands in for a full disk.
        city = self.city(150000)
        before = self.files()
        for room in (0, 1, 8, 20, 40):
            process = self.start(
                city, "-o", self.path("x.crease"), "--memory", "16MB", env=self.without_tmpdir(),
                preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (room * MB, -1)))
            out, err = process.communicate()
            self.assertEqual(process.returncode, 4, err)
            self.assertRegex(err, re.escape(str(self.folder)) + r": no memory in a file there: \w+")
            self.assertIn('"name": "WriteFailed"', out)
            self.assertEqual(self.files(), before)

    @unittest.skipIf(SANITIZED, "keeps the sanitizer's own memory")
    def test_no_folder_for_the_file(self):
        failed = self.json("build", self.city(), "-o", self.path("no/such/x.crease"), "--memory",
                           "64MB", exit_status=4)
        self.assertIn("no/such", failed["error"]["message"])


if __name__ == "__main__":
    tool.main()
