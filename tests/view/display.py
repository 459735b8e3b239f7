"""A display for tests that open windows: Xvfb, on a number that is free.

    with display.Display(800, 600) as screen: subprocess.run(..., env=screen.environment)
    python3 display.py PROGRAM ARGUMENTS...     runs a program on one, and exits as it does
"""

import os
import pathlib
import shutil
import subprocess
import sys
import tempfile

sys.path.insert(0, str(pathlib.Path(__file__).parents[1] / "support"))

import leaks  # noqa: E402


class Display:
    def __init__(self, width=1024, height=768):
        read_end, write_end = os.pipe()
        self.folder = tempfile.mkdtemp(prefix="crease_display_")
        self.server = subprocess.Popen(
            ["Xvfb", "-displayfd", str(write_end), "-screen", "0", f"{width}x{height}x24",
             "-nolisten", "tcp", "-noreset"],
            pass_fds=[write_end], stderr=subprocess.PIPE, text=True)
        os.close(write_end)
        with os.fdopen(read_end) as pipe:
            number = pipe.readline().strip()  # it is ready then; nothing if it has ended
        if not number:
            raise RuntimeError("Xvfb: " + self.server.stderr.read())
        # Views are remembered in a place of their own.
        self.environment = dict(os.environ, DISPLAY=":" + number,
                                XDG_STATE_HOME=self.folder, LIBGL_ALWAYS_SOFTWARE="1")
        self.environment.pop("WAYLAND_DISPLAY", None)

    def close(self):
        self.server.terminate()
        self.server.wait()
        self.server.stderr.close()
        shutil.rmtree(self.folder, ignore_errors=True)

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.close()


if __name__ == "__main__":
    with Display() as own:
        sys.exit(leaks.run_and_tell(sys.argv[1:], own.environment))
