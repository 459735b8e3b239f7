#!/usr/bin/env python3
"""Flights through a city that is larger than the memory it gets, in one run: from disk, from `crease
serve`, and from nginx behind a line of 20 Mbit/s and 50 ms (shaped_line.py); their picture; and time
and bytes until models have their first picture and are right, over that line.

    crease generate city -o city20.glb --triangles 20200000 && crease build city20.glb -o city20.crease
    bench/flights.py city20.crease --picture docs/pictures/flight.png
    bench/flights.py city20.crease --frames 60 --check 30           # to see whether it all runs
    bench/flights.py city20.crease --frames 0 --still city20.crease dragon.crease lucy.crease

Nothing else should run on the machine. A flight is flown twice: once by the clock, which gives the
figures, once with every CHECKth frame against brute force (bench_stream --check), for which the clock
stands still. Exits with 6 if a frame was wrong or the process took more than the budget and
BEYOND_MB.
"""

import argparse
import contextlib
import csv
import os
import pathlib
import socket
import statistics
import subprocess
import sys
import tempfile
import time

HERE = pathlib.Path(__file__).resolve().parent
BUILD = pathlib.Path(os.environ.get("CREASE_BENCH_BUILD", HERE.parent / "build/bench"))
MBIT, ROUND_TRIP_MS = 20, 50
# What a process may take beyond the budget: the program, 1 MiB of payloads, what decoding a block takes
# and eight that wait for the next update, and what the allocator keeps of blocks that were dropped.
BEYOND_MB = 80

NGINX = """daemon off; master_process off; pid {work}/pid; error_log stderr;
events {{ }}
http {{
  client_body_temp_path {work}/body; proxy_temp_path {work}/proxy; fastcgi_temp_path {work}/fastcgi;
  uwsgi_temp_path {work}/uwsgi; scgi_temp_path {work}/scgi;
  access_log off; sendfile on;
  server {{ listen 127.0.0.1:{port}; root "{root}"; }}
}}
"""


def free_port():
    with socket.socket() as s:
        s.bind(("127.0.0.1", 0))
        return s.getsockname()[1]


@contextlib.contextmanager
def running(command, port):
    """While it listens at the port."""
    process = subprocess.Popen([str(word) for word in command], stdout=subprocess.DEVNULL,
                               stderr=subprocess.DEVNULL)
    try:
        while True:
            if process.poll() is not None:
                sys.exit(f"flights: {command[0]} ended at once")
            with contextlib.suppress(OSError), socket.create_connection(("127.0.0.1", port)):
                break
            time.sleep(0.05)
        yield
    finally:
        process.terminate()
        process.wait()


@contextlib.contextmanager
def serve(file):
    port = free_port()
    command = [BUILD / "bin/crease", "serve", file.parent, "--port", port,
               "--limit", f"{MBIT}Mbit", "--delay", ROUND_TRIP_MS]
    with running(command, port):
        yield f"http://127.0.0.1:{port}/{file.name}"


@contextlib.contextmanager
def nginx_behind_line(file):
    with tempfile.TemporaryDirectory() as work:
        port, shaped = free_port(), free_port()
        config = pathlib.Path(work, "nginx.conf")
        config.write_text(NGINX.format(work=work, port=port, root=file.parent))
        nginx = ["/usr/sbin/nginx", "-p", work, "-c", config, "-e", "stderr"]
        line = [sys.executable, HERE / "shaped_line.py", "--listen", shaped,
                "--to", f"127.0.0.1:{port}", "--limit", MBIT, "--round-trip", ROUND_TRIP_MS]
        with running(nginx, port), running(line, shaped):
            yield f"http://127.0.0.1:{shaped}/{file.name}"


@contextlib.contextmanager
def disk(file):
    yield str(file)


WAYS = [
    ("disk", "disk", disk),
    ("serve", f"crease serve, {MBIT} Mbit/s and {ROUND_TRIP_MS} ms", serve),
    ("nginx", f"nginx, {MBIT} Mbit/s and {ROUND_TRIP_MS} ms", nginx_behind_line),
]


def stream(arguments, log):
    """Runs bench_stream, shows what it says and keeps it. False if it failed."""
    environment = dict(os.environ, no_proxy="127.0.0.1")
    done = subprocess.run([str(word) for word in [BUILD / "bin/bench_stream", *arguments]],
                          stdout=subprocess.PIPE, text=True, env=environment, check=False)
    log.write_text(done.stdout)
    print(done.stdout, end="", flush=True)
    return done.returncode == 0


def columns(path):
    with open(path, newline="") as lines:
        rows = list(csv.DictReader(lines))
    return {name: [float(row[name]) for row in rows] for name in rows[0]}


def row(label, path):
    """As the table of docs/streaming.md, and whether memory was kept."""
    data = columns(path)
    return (f"| {label} | {max(data['resident_mb']):.0f} MB | {max(data['process_mb']):.0f} MB "
            f"| {statistics.median(data['update_ms']):.2f} and {max(data['update_ms']):.1f} ms "
            f"| {statistics.median(data['error_pixels']):.0f} px |"), max(data["process_mb"])


def fly(file, arguments, work):
    """All ways; gives plots and whether all was right."""
    rows, plots, is_right = [], [], True
    for name, label, way in WAYS:
        with way(file) as where:
            path = work / f"{name}.csv"
            flight = [where, "--city", "--frames", arguments.frames, "--budget", arguments.budget]
            is_right &= stream([*flight, "--csv", path], work / f"{name}.txt")
            if arguments.check > 0:
                is_right &= stream([*flight, "--check", arguments.check, "--sound", file],
                                   work / f"{name}_checked.txt")
        line, process_mb = row(label, path)
        rows.append(line)
        plots.append(f"{label}={path}")
        if process_mb > arguments.budget + BEYOND_MB:
            print(f"flights: {name}: {process_mb:.0f} MB are more than the budget and {BEYOND_MB} MB")
            is_right = False
    print("\n| from | resident, most | process, most | update(), median and most "
          "| error on screen, median |\n|---|--:|--:|--:|--:|")
    print("\n".join(rows), flush=True)
    return plots, is_right


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n")[0])
    parser.add_argument("city", type=pathlib.Path, help="a .crease")
    parser.add_argument("--frames", type=int, default=1800, help="0: no flight")
    parser.add_argument("--check", type=int, default=200, help="0: none")
    parser.add_argument("--budget", type=float, default=256, help="MB")
    parser.add_argument("--picture", type=pathlib.Path, help="by flight_plot.py")
    parser.add_argument("--still", type=pathlib.Path, nargs="+", default=[],
                        help="files seen whole, over the line")
    parser.add_argument("--work", type=pathlib.Path, default=HERE.parent / "build/flights")
    arguments = parser.parse_args()
    subprocess.run([HERE / "setup.sh", "bench_stream", "crease_cli"], check=True)
    arguments.work.mkdir(parents=True, exist_ok=True)
    is_right = True
    if arguments.frames > 0:
        plots, is_right = fly(arguments.city.resolve(), arguments, arguments.work)
        if arguments.picture:
            subprocess.run([HERE / "flight_plot.py", arguments.picture, *plots], check=True)
    for file in arguments.still:
        with nginx_behind_line(file.resolve()) as url:
            is_right &= stream([url, "--still", "--budget", 1500],
                               arguments.work / f"{file.stem}_still.txt")
    sys.exit(0 if is_right else 6)


if __name__ == "__main__":
    main()
