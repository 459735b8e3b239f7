#!/usr/bin/env python3
"""Makes docs/quality.md from what bench/quality measured.

  bench/quality --peers update,vtk --csv build/quality.csv
  bench/quality_table.py build/quality.csv > docs/quality.md
"""
import csv
import sys

HEAD = """# Quality beside the peers

Written by `bench/quality_table.py` from `bench/quality --peers update,vtk --csv build/quality.csv`;
[bench/README.md](../bench/README.md) says what is compared and how.

Mean distance in millionths of the diagonal / mean normal deviation in degrees, at 50, 10 and 1 % of
the triangles, default settings, 200,000 samples each way. *update* is meshoptimizer's
`simplifyWithUpdate`; crease is taken at the count that it reached, which is the number in the table:
where it stops short of the ratio, both stand where it stopped. *vtk* is at the ratio, with normals
made from its result.
"""

RATIOS = ("50", "10", "1")


def cell(row):
    if row is None:
        return "–"
    return f"{float(row['mean_ppm']):.3g} / {float(row['normal_mean_deg']):.2g}"


def main():
    models = {}
    with open(sys.argv[1], newline="", encoding="utf-8") as file:
        for row in csv.DictReader(file):
            models.setdefault(row["model"], {})[row["ratio_percent"], row["method"]] = row
    print(HEAD)
    columns = [f"{m}, {r} %" for r in RATIOS for m in ("count", "crease", "update", "vtk")]
    print("| model | " + " | ".join(columns) + " |")
    print("|---|" + "--:|" * len(columns))
    above = []
    for name, rows in models.items():
        cells = []
        for ratio in RATIOS:
            crease, update = rows[ratio, "crease"], rows[ratio, "update"]
            cells += [f"{int(update['triangles']):,}", cell(crease), cell(update),
                      cell(rows.get((ratio, "vtk")))]
            if any(float(crease[k]) > max(float(update[k]), 1e-4)
                   for k in ("mean_ppm", "normal_mean_deg")):
                above.append(f"{name} ({ratio} %)")
        print(f"| {name} | " + " | ".join(cells) + " |")
    print(f"\nAbove *update* in distance or normals: {', '.join(above) if above else 'none'}.")


main()
