#!/usr/bin/env python3
"""Large real models, built, measured and pictured: two cities, CAD parts and a terrain of one to
three million triangles. Writes docs/large-models.md and docs/pictures/.

    scripts/large_models.py                    all of them, from ../shared/data
    scripts/large_models.py DATA berlin_mitte  those whose names begin so; prints the tables only

Files in between lie in build/large. CREASE names another tool than build/release/bin/crease.
"""

import json
import os
import pathlib
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent
CREASE = os.environ.get("CREASE", str(ROOT / "build/release/bin/crease"))
FOLDER = ROOT / "build/large"
DOCS = ROOT / "docs"
SAMPLES = 100_000

# A model: its file, the levels (triangles, or a share of them), and its pictures: caption, eye,
# target, vertical angle of view, height in pixels. z is up.
MODELS = {
    "berlin_mitte_1253k": ("city/berlin_mitte_1253k.obj.xz", (960_000, 200_000), {
        "whole": ("All of Berlin-Mitte from the south-west",
                  (-3600, -6400, 4200), (-700, 1050, 0), 28, 360),
        "tower": ("The television tower and Marienkirche",
                  (1500, -350, 260), (1950, 130, 90), 46, 480),
        "houses": ("Blocks of houses; 200,000 triangles are ten a building, a box has twelve",
                   (1250, 700, 190), (1500, 1150, 0), 36, 480)}),
    "linz_south_1918k": ("city/linz_south_1918k.obj.xz", (0.2,), {
        "whole": ("All of Linz south of the Danube",
                  (-3200, -13500, 6500), (1000, -1500, 250), 28, 440),
        "houses": ("Houses on a slope; 20 % are nine triangles a building",
                   (-2950, 1150, 480), (-2750, 1450, 330), 40, 480)}),
    "so100_arm_parts_1400k": ("cad/so100_arm_parts_1400k.obj.xz", (0.2,), {
        "whole": ("All parts", (330, -260, 230), (160, 118, 35), 30, 480),
        "fillets": ("Fillets, holes and flat faces", (230, -60, 160), (235, 60, 30), 30, 480)}),
    "terrain_white_mountains": ("scan/terrain_white_mountains.ply.xz", (0.2,), {
        "whole": ("The whole sheet", (-62000, -118000, 62000), (-2000, -12000, 600), 30, 440),
        "ridges": ("Ridges from low above", (-2000, -44000, 3500), (4000, -36000, 900), 40, 440)}),
}


def crease(*arguments):
    """Runs the tool and returns its JSON; shows what it logs."""
    print("crease", *arguments, file=sys.stderr, flush=True)
    command = [CREASE, *map(str, arguments), "--json"]
    done = subprocess.run(command, stdout=subprocess.PIPE, text=True)
    if done.returncode != 0:
        sys.exit(done.returncode)
    return json.loads(done.stdout)


def measure(source, file, level, full):
    """One level of `file` beside the `source` it came from."""
    out = file.with_name(f"{file.stem}_{level}.glb")
    asked = level if level > 1 else round(level * full)
    option = ("--triangles", level) if level > 1 else ("--ratio", level)
    extracted = crease("extract", file, "-o", out, *option, "--samples", 0)
    measured = crease("compare", source, out, "--samples", SAMPLES)
    ppm = {}
    for kind in ("mean", "max"):
        ways = measured["distance"][f"{kind}_relative"]
        ppm[kind] = [1e6 * ways["a_to_b"], 1e6 * ways["b_to_a"]]
    return {"asked": asked, "achieved": extracted["triangles"], "ppm": ppm,
            "degrees": measured["normal_deviation"]["mean"], "share": extracted["triangles"] / full,
            "seconds": extracted["seconds"]}


def picture(name, key, file, levels, view):
    _, eye, target, angle, height = view
    shares = [1.0] + [level["share"] + 1e-9 for level in levels]
    width = 1500 // len(shares)
    camera = FOLDER / "camera.json"
    camera.write_text(json.dumps({"position": eye, "target": target, "up": [0, 0, 1],
                                  "vertical_fov": angle, "viewport": [width, height]}))
    out = DOCS / "pictures" / f"{name.split('_')[0]}_{key}.png"
    crease("render", file, "-o", out, "--levels", ",".join(f"{s:.9f}" for s in shares),
           "--view", camera, "--size", f"{width * len(shares)}x{height + 40}")
    return out


def process(data, name, with_pictures):
    path, asked, views = MODELS[name]
    file = FOLDER / f"{name}.crease"
    built = crease("build", data / path, "-o", file)
    levels = [measure(data / path, file, level, built["triangles"]) for level in asked]
    keys = views if with_pictures else ()
    pictures = [(views[k][0], picture(name, k, file, levels, views[k])) for k in keys]
    return {"name": name, "path": path, "built": built, "info": crease("info", file),
            "levels": levels, "pictures": pictures}


def tables(models):
    yield "| model | triangles | build | of it import | peak memory | file | bits a vertex |"
    yield "|---|--:|--:|--:|--:|--:|--:|"
    for m in models:
        b = m["built"]
        yield (f"| {m['name']} | {b['triangles']:,} | {b['seconds']:.0f} s | "
               f"{b['import_seconds']:.0f} s | {b['peak_memory'] / 1e6:.0f} MB | "
               f"{b['bytes'] / 1e6:.1f} MB | {b['bits_per_vertex']:.0f} |")
    yield ""
    yield "| model | asked for | triangles | mean distance | max distance | normals, mean |"
    yield "|---|--:|--:|--:|--:|--:|"
    for m in models:
        for level in m["levels"]:
            (mean, mean_back), (far, far_back) = level["ppm"]["mean"], level["ppm"]["max"]
            yield (f"| {m['name']} | {level['asked']:,} | {level['achieved']:,} | "
                   f"{mean:.3g} / {mean_back:.3g} | {far:.3g} / {far_back:.3g} | "
                   f"{level['degrees']:.2g}° |")
    yield ""
    yield "| model | three-part arrays | wedges | replicated | records |"
    yield "|---|--:|--:|--:|--:|"
    for m in models:
        sizes = [m["info"]["linear_bytes"][k] for k in ("crease", "wedge", "replicated", "records")]
        yield f"| {m['name']} | " + " | ".join(f"{size / 1e6:.1f} MB" for size in sizes) + " |"


HEAD = f"""# Large models

Written by `scripts/large_models.py`, which builds, measures and draws them again.

Build times are wall clock on two cores, the whole sequence down to a handful of triangles.
Distances are in millionths of the diagonal, from the original to the level / back, by {SAMPLES:,}
points on each surface; normals are compared at the corners. The last table has the run-time bytes
of the arrays at full resolution and, apart from them, of the records that switch levels.
[memory.md](memory.md) builds with less memory than that.
"""


def main():
    FOLDER.mkdir(parents=True, exist_ok=True)
    data = pathlib.Path(sys.argv[1]) if len(sys.argv) > 1 else ROOT.parent / "shared/data"
    chosen = [n for n in MODELS if n.startswith(tuple(sys.argv[2:]) or "")]
    models = [process(data, name, len(chosen) == len(MODELS)) for name in chosen]
    if len(chosen) < len(MODELS):
        print("\n".join(tables(models)))
        return
    lines = [HEAD, *tables(models)]
    for m in models:
        lines += ["", f"## {m['name']}"]
        for caption, path in m["pictures"]:
            lines += ["", f"{caption}:", "", f"![{caption}](pictures/{path.name})"]
    (DOCS / "large-models.md").write_text("\n".join(lines) + "\n")


if __name__ == "__main__":
    main()
