"""Programs under LeakSanitizer, whose own tracer fails now and then while the threads of an OpenGL
driver end: it has looked for no leak then, and ends the process with a status of its own.

    done = leaks.run(["crease", "info", "model.crease"])    once more without it, if that is what failed
    python3 leaks.py PROGRAM ARGUMENTS...                   the same, and exits as it does
"""

import os
import subprocess
import sys

TRACER_FAILED = "LeakSanitizer has encountered a fatal error"


def without_check(environment=None):
    """For who cannot run a command once more."""
    environment = dict(environment or os.environ)
    options = environment.get("ASAN_OPTIONS")
    environment["ASAN_OPTIONS"] = (options + ":" if options else "") + "detect_leaks=0"
    return environment


def run(command, environment=None, timeout=None):
    """The finished command, and what it wrote."""
    environment = dict(environment or os.environ)
    for _ in range(2):
        done = subprocess.run(command, capture_output=True, text=True, errors="replace",
                              env=environment, timeout=timeout)
        if TRACER_FAILED not in done.stderr:
            break
        environment = without_check(environment)
    return done


def run_and_tell(command, environment=None):
    """Its status, once all that it wrote is written."""
    done = run(command, environment)
    print(done.stdout, end="", flush=True)
    print(done.stderr, end="", file=sys.stderr, flush=True)
    return done.returncode


if __name__ == "__main__":
    sys.exit(run_and_tell(sys.argv[1:]))
