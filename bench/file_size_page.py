#!/usr/bin/python3
"""Puts what was measured into docs/file-size.md and draws docs/pictures/progressive.png.

  bench/sizes --csv build/sizes.csv
  bench/resident --csv build/resident.csv
  bench/progressive --csv build/progressive.csv
  bench/file_size_page.py build

A CSV that is not there leaves its tables as they are. In the page a table is what stands between
<!-- NAME --> and <!-- end -->. Needs python3-matplotlib (Debian's) for the picture.
"""
import csv
import math
import pathlib
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent
PAGE = ROOT / "docs" / "file-size.md"
PICTURE = ROOT / "docs" / "pictures" / "progressive.png"
PLACEMENTS = ("endpoint", "optimal")


def rows_of(path):
    """The rows of a CSV with numbers as floats; none where it is not there."""
    if not path.exists():
        return []
    with open(path, newline="", encoding="utf-8") as file:
        return [{k: number(v) for k, v in row.items()} for row in csv.DictReader(file)]


def number(text):
    try:
        return float(text)
    except ValueError:
        return text


def table(head, rows):
    aligned = [":--" if i == 0 else "--:" for i in range(len(head))]
    lines = [head, aligned] + rows
    return "\n".join("| " + " | ".join(line) + " |" for line in lines)


def mean(values):
    """Geometric."""
    return math.exp(sum(map(math.log, values)) / len(values)) if values else float("nan")


def ratio(row, placement):
    return row[f"{placement}_bytes"] / row["draco_bytes"]


def ratio_cell(row, placement):
    """Bold where it is above its limit."""
    value = ratio(row, placement)
    return f"**{value:.2f}**" if row["limit"] and value > row["limit"] else f"{value:.2f}"


def by_model(rows):
    models = {}
    for row in rows:
        models.setdefault(row["model"], {})[int(row["normals"])] = row
    return {name: pair for name, pair in models.items() if len(pair) == 2}


def sizes_table(rows):
    head = ["model", "class", "vertices"]
    for what in ("", "normals, "):
        head += [f"{what}endpoint", "optimal", "Draco", "ratio", "ratio, optimal"]
    lines = []
    for name, pair in by_model(rows).items():
        line = [name, pair[0]["class"], f"{pair[0]['vertices']:,.0f}"]
        for row in (pair[0], pair[1]):
            line += [f"{8 * row[who + '_bytes'] / row['vertices']:.2f}"
                     for who in (*PLACEMENTS, "draco")]
            line += [ratio_cell(row, placement) for placement in PLACEMENTS]
        lines.append(line)
    return table(head, lines)


def musts_table(rows):
    head = ["what", "at most", "mean, endpoint", "met by", "mean, optimal", "met by"]
    groups = {}
    for row in rows:
        if row["limit"]:
            what = "10-bit normals" if row["normals"] else "no normals"
            kind = "Berlin and Linz" if row["class"] == "city" else row["class"]
            groups.setdefault((f"{kind}, {what}", row["limit"]), []).append(row)
    lines = []
    for (what, limit), members in sorted(groups.items(), reverse=True):
        line = [what, f"{limit:.2f}"]
        for placement in PLACEMENTS:
            ratios = [ratio(row, placement) for row in members]
            met = sum(r <= limit for r in ratios)
            line += [f"{mean(ratios):.2f}", f"{met} of {len(ratios)}"]
        lines.append(line)
    return table(head, lines)


def streams_table(rows):
    names = ("container", "roots", "flags", "shapes", "positions", "categories", "values",
             "labels")
    lines = [[r["model"]] + [f"{r[n]:.2f}" for n in names] for r in rows if r["normals"]]
    return table(["model", *names], lines)


def speed_table(rows):
    head = ["model", "normals", "decoded", "blocks alone", "Draco decodes", "of Draco", "encoded",
            "Draco encodes", "of Draco", "memory to decode", "Draco"]
    lines = []
    for row in rows:
        rate = lambda key: row["triangles"] / row[key] / 1e6
        decoded, encoded = rate("optimal_decode_s"), rate("optimal_encode_s")
        lines.append([
            row["model"], "10 bits" if row["normals"] else "none", f"{decoded:.2f}",
            f"{rate('optimal_blocks_s'):.2f}", f"{rate('draco_decode_s'):.1f}",
            f"{decoded / rate('draco_decode_s'):.2f}", f"{encoded:.2f}",
            f"{rate('draco_encode_s'):.2f}", f"{encoded / rate('draco_encode_s'):.2f}",
            f"{row['optimal_decode_peak'] / row['triangles']:.0f}",
            f"{row['draco_decode_peak'] / row['triangles']:.0f}"])
    return table(head, lines)


def speed_means_table(rows):
    head = ["", "decoded, of Draco", "blocks alone, of Draco", "encoded, of Draco"]
    lines = []
    for normals in (0, 1):
        for placement in PLACEMENTS:
            chosen = [row for row in rows if int(row["normals"]) == normals]
            times = [mean([row["draco_" + draco] / row[f"{placement}_{ours}"] for row in chosen])
                     for ours, draco in (("decode_s", "decode_s"), ("blocks_s", "decode_s"),
                                         ("encode_s", "encode_s"))]
            what = "10-bit normals" if normals else "no normals"
            lines.append([f"{what}, {placement}"] + [f"{t:.3f}" for t in times])
    return table(head, lines)


def resident_table(rows, sizes):
    small = {row["model"]: row["endpoint_bytes"] for row in sizes if row["normals"]}
    head = ["model", "class", "vertices", "file", "small file", "hierarchy", "meta-nodes",
            "hierarchy / file", "meta-nodes / file", "meta-nodes / small file"]
    rows = [row | {"small_bytes": small[row["model"]]} for row in rows if row["model"] in small]
    ratios = (("hierarchy_bytes", "file_bytes"), ("meta_node_bytes", "file_bytes"),
              ("meta_node_bytes", "small_bytes"))
    lines = []
    for row in rows:
        lines.append([row["model"], row["class"], f"{row['vertices']:,.0f}"]
                     + [f"{row[k] / row['vertices']:.1f}" for k in
                        ("file_bytes", "small_bytes", "hierarchy_bytes", "meta_node_bytes")]
                     + [f"{row[a] / row[b]:.1f}" for a, b in ratios])
    means = [mean([row[a] / row[b] for row in rows]) for a, b in ratios]
    lines.append(["geometric mean"] + [""] * 6 + [f"{m:.1f}" for m in means])
    return table(head, lines)


METHODS = {
    "crease_endpoint": ("model.crease, endpoint", "tab:blue"),
    "crease_optimal": ("model.crease, optimal", "tab:cyan"),
    "meshopt": ("GLB levels, meshopt", "tab:red"),
    "meshopt_gzip": ("GLB levels, meshopt and gzip", "tab:orange"),
    "draco": ("Draco", "black"),
}


def progressive_table(rows):
    head = ["model", "file", "read", "kB", "triangles", "distance, ppm", "normals, degrees"]
    lines = []
    for row in rows:
        if "Draco" in row["step"]:
            continue
        step = {"1/1": "all"}.get(row["step"], row["step"].replace("%", " %"))
        lines.append([row["model"], METHODS[row["method"]][0], step,
                      f"{row['bytes'] / 1000:,.1f}", f"{row['triangles']:,.0f}",
                      f"{row['mean_ppm']:,.0f}" if row["mean_ppm"] >= 100 else
                      f"{row['mean_ppm']:.3g}", f"{row['normal_mean_deg']:.2g}"])
    return table(head, lines)


def shown_at(rows, model, method, budget):
    """The last thing that a method shows within so many bytes."""
    shown = None
    for row in sorted(rows, key=lambda row: row["bytes"]):
        if (row["model"], row["method"]) == (model, method) and row["bytes"] <= budget + 1:
            shown = row
    return shown


def equal_bytes_table(rows):
    """What each method shows of the bytes that Draco needs for everything."""
    shares = (0.02, 0.05, 0.1, 0.2, 0.5, 1.0)
    methods = ("crease_endpoint", "crease_optimal", "meshopt_gzip")
    head = ["model", "file"] + [f"{100 * s:.0f} %" for s in shares]
    lines = []
    for draco in (row for row in rows if row["method"] == "draco"):
        for method in methods:
            line = [draco["model"], METHODS[method][0]]
            for share in shares:
                row = shown_at(rows, draco["model"], method, share * draco["bytes"])
                line.append(f"{row['mean_ppm']:,.0f} / {row['normal_mean_deg']:.2g}" if row
                            else "–")
            lines.append(line)
    return table(head, lines)


def draw(rows):
    import matplotlib
    matplotlib.use("Agg")
    from matplotlib import pyplot

    models = list(dict.fromkeys(row["model"] for row in rows))
    quantities = (("mean_ppm", "mean distance, millionths of the diagonal"),
                  ("normal_mean_deg", "mean normal deviation, degrees"))
    figure, axes = pyplot.subplots(2, len(models), figsize=(3.6 * len(models), 7), squeeze=False)
    for column, model in enumerate(models):
        end = 1.6 * max(row["bytes"] for row in rows if row["model"] == model) / 1000
        for line, (key, words) in enumerate(quantities):
            axis = axes[line][column]
            for method, (name, color) in METHODS.items():
                points = sorted((row["bytes"] / 1000, row[key]) for row in rows
                                if (row["model"], row["method"]) == (model, method))
                x, y = zip(*points)
                axis.step(x + (end,), y + (y[-1],), where="post", color=color, label=name,
                          linewidth=1.4)
                axis.plot(x, y, "o", color=color, markersize=3.5)
            axis.set(xscale="log", yscale="log")
            axis.grid(True, which="major", alpha=0.3)
            if line == 0:
                axis.set_title(model)
            else:
                axis.set_xlabel("kB read")
            if column == 0:
                axis.set_ylabel(words)
    handles, labels = axes[0][0].get_legend_handles_labels()
    figure.legend(handles, labels, loc="lower center", ncol=len(METHODS), frameon=False)
    figure.tight_layout(rect=(0, 0.05, 1, 1))
    figure.savefig(PICTURE, dpi=80)


def put(page, name, text):
    begin = page.index(f"<!-- {name} -->") + len(f"<!-- {name} -->")
    end = page.index("<!-- end -->", begin)
    return page[:begin] + "\n" + text + "\n" + page[end:]


def main():
    folder = pathlib.Path(sys.argv[1] if len(sys.argv) > 1 else ROOT / "build")
    page = PAGE.read_text(encoding="utf-8")
    tables = {"sizes": (sizes_table, musts_table, streams_table, speed_table, speed_means_table),
              "resident": (resident_table,),
              "progressive": (progressive_table, equal_bytes_table)}
    for name, makers in tables.items():
        rows = rows_of(folder / f"{name}.csv")
        if not rows:
            continue
        for maker in makers:
            more = (rows_of(folder / "sizes.csv"),) if maker is resident_table else ()
            text = maker(rows, *more)
            page = put(page, maker.__name__.removesuffix("_table").replace("_", "-"), text)
        if name == "progressive":
            draw(rows)
    PAGE.write_text(page, encoding="utf-8")


main()
