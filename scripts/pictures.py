#!/usr/bin/env python3
"""Remakes the pictures of the README from a generated city and an engine: figures 1 and 13 of DB03,
hard edges of machine parts, and what a camera refines, from outside.

    scripts/pictures.py            all of them, into docs/pictures
    scripts/pictures.py buildings  those whose names begin so

Files in between lie in build/pictures. CREASE names another tool than build/release/bin/crease,
CREASE_SHARED_DATA another folder than ../shared/data.
"""

import json
import os
import pathlib
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent
CREASE = os.environ.get("CREASE", str(ROOT / "build/release/bin/crease"))
DATA = pathlib.Path(os.environ.get("CREASE_SHARED_DATA", ROOT.parent / "shared/data"))
FOLDER = ROOT / "build/pictures"
PICTURES = ROOT / "docs/pictures"


def camera(position, target, fov, viewport, pixels=1):
    return {"position": position, "target": target, "up": [0, 0, 1], "vertical_fov": fov,
            "viewport": viewport, "pixels": pixels}


# A picture: its model, its camera, and the options of `crease render` beside them.
FIGURES = {
    # DB03 figure 1: with and without hard edges kept apart, the same triangles.
    "buildings": ("city", camera([-105, -300, 78], [4, -70, 12], 40, [470, 360]),
                  ("--ratio", 0.2, "--control", "--size", "940x390")),
    # DB03 figure 13: part of the city, a million triangles and two hundred thousand.
    "levels": ("city", camera([-260, -330, 120], [10, 40, 0], 32, [450, 320]),
               ("--levels", "1,0.2", "--size", "900x350")),
    "engine": ("engine", None, ("--ratio", 0.15, "--control", "--size", "1120x400")),
    "outside": ("city", camera([-300, -420, 45], [60, 60, 10], 40, [1200, 750], 1.5),
                ("--outside", "--size", "900x500")),
}


def crease(*arguments):
    print("crease", *arguments, file=sys.stderr, flush=True)
    subprocess.run([CREASE, *map(str, arguments), "--quiet"], check=True)


def model(name):
    """The .crease file of a name, made where it is not there."""
    file = FOLDER / f"{name}.crease"
    if file.exists():
        return file
    source = DATA / "cad/2cylinder_engine.glb.xz"
    if name == "city":
        source = FOLDER / "city.glb"
        crease("generate", "city", "-o", source)
    crease("build", source, "-o", file)
    return file


def main():
    FOLDER.mkdir(parents=True, exist_ok=True)
    asked = sys.argv[1:] or [""]
    for name, (of, view, options) in FIGURES.items():
        if not any(name.startswith(a) for a in asked):
            continue
        if view is not None:
            path = FOLDER / f"{name}.json"
            path.write_text(json.dumps(view))
            options = (*options, "--view", path)
        crease("render", model(of), "-o", PICTURES / f"{name}.png", *options)


if __name__ == "__main__":
    main()
