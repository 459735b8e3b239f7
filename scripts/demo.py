#!/usr/bin/env python3
"""The city of DB03 or a model of one's own, at 100, 20 and 2 %: a picture of the levels beside a
control that ignores shading discontinuities, and a table of what they cost and are off by.

    scripts/demo.py                 a generated city of about a million triangles
    scripts/demo.py house.obj       one's own

Everything it makes lies in build/demo. CREASE names another tool than build/release/bin/crease.
"""

import json
import os
import pathlib
import subprocess
import sys
import time

ROOT = pathlib.Path(__file__).resolve().parent.parent
CREASE = os.environ.get("CREASE", str(ROOT / "build/release/bin/crease"))
FOLDER = ROOT / "build/demo"
RATIOS = (1, 0.2, 0.02)
CITY_TRIANGLES = os.environ.get("DEMO_TRIANGLES", "1000000")


def crease(*arguments):
    """Runs the tool and returns its JSON; shows what it logs."""
    done = subprocess.run([CREASE, *map(str, arguments), "--json"], stdout=subprocess.PIPE, text=True)
    if done.returncode != 0:
        sys.exit(done.returncode)
    return json.loads(done.stdout)


def say(text):
    print(text, file=sys.stderr, flush=True)


# Over the river towards the cathedral, from low enough to see walls, arches and domes.
CLOSE_UP = {"position": [-105, -300, 78], "target": [4, -70, 12], "up": [0, 0, 1],
            "vertical_fov": 40, "viewport": [800, 675]}


def megabytes(count):
    return f"{count / 1e6:8.1f} MB"


def main():
    FOLDER.mkdir(parents=True, exist_ok=True)
    own = pathlib.Path(sys.argv[1]) if len(sys.argv) > 1 else None
    model, file = own, FOLDER / "model.crease"
    if own is None:
        model = FOLDER / "city.glb"
        say("demo: generating a city")
        crease("generate", "city", "-o", model, "--triangles", CITY_TRIANGLES)
    say(f"demo: building {file}")
    built = crease("build", model, "-o", file)
    info = crease("info", file)

    levels = []
    for ratio in RATIOS[1:]:
        out = FOLDER / f"level_{ratio * 100:g}_percent.glb"
        say(f"demo: extracting and measuring {ratio * 100:g} %")
        levels.append((out, crease("extract", file, "-o", out, "--ratio", ratio)))

    pictures = []
    share_list = ",".join(f"{r:g}" for r in RATIOS)

    def picture(name, *options):
        start = time.monotonic()
        crease("render", file, "-o", FOLDER / name, "--levels", share_list, *options)
        pictures.append((FOLDER / name, time.monotonic() - start))

    say("demo: drawing")
    picture("demo.png", "--control", "--size", "2400x1350", *view(own))
    picture("demo_whole.png", "--size", "2400x460")
    picture("demo_kinds.png", "--size", "2400x675", "--color", "kind", "--wireframe",
            *view(own))

    print_tables(model, built, info, levels, pictures)


def view(own):
    """A model of one's own is shown whole: nobody knows where to look."""
    if own is not None:
        return ()
    path = FOLDER / "close.json"
    path.write_text(json.dumps(CLOSE_UP))
    return ("--view", path)


def print_tables(model, built, info, levels, pictures):
    print(f"\n{model}: {info['triangles']:,} triangles, {info['vertices']:,} vertices; "
          f"{info['sn_triangles']:,} SN, {info['fn_triangles']:,} FN, {info['nsn_triangles']:,} NSN")
    print(f"built in {built['build_seconds']:.1f} s (import {built['import_seconds']:.1f} s), "
          f"{built['bytes'] / 1e6:.1f} MB, peak memory {built['peak_memory'] / 1e6:.0f} MB\n")
    print("level       triangles   surface mean    surface max   normals mean   seconds")
    print(f"{'original':9} {info['triangles']:12,}")
    for (_, level), ratio in zip(levels, RATIOS[1:]):
        m = level["error_measured"]
        print(f"{ratio * 100:6g} %  {level['triangles']:12,} {m['surface_mean']:14.4g} "
              f"{m['surface_max']:14.4g} {m['degrees_mean']:10.2f} deg {level['seconds']:9.1f}")
    linear = info["linear_bytes"]
    print("\nrun-time arrays at full resolution")
    print(f"  crease (DB03, three parts)   {megabytes(linear['crease'])}")
    print(f"  wedges (Hoppe)               {megabytes(linear['wedge'])}")
    print(f"  a vertex for every normal    {megabytes(linear['replicated'])}")
    print(f"  records that switch levels   {megabytes(linear['records'])}\n")
    for path, seconds in pictures:
        print(f"{path}   ({seconds:.1f} s)")


if __name__ == "__main__":
    main()
