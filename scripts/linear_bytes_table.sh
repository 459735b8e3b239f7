#!/bin/sh
# DB03's claim in numbers: run-time bytes of the three-part arrays beside Hoppe's wedges and beside
# replicated vertices, as a Markdown table. Needs python3 and the tool.
#
#   scripts/linear_bytes_table.sh city.crease ../shared/data/cad/*.zst
#
# Takes .crease files and mesh files; the latter are built first, which is what takes the time.
set -eu
crease=${CREASE:-$(dirname "$0")/../build/release/bin/crease}
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

echo '| model | triangles | SN / FN / NSN | crease | wedges | replicated | of wedges | of replicated |'
echo '|---|--:|--:|--:|--:|--:|--:|--:|'
for model; do
  file=$model
  case $model in
    *.crease) ;;
    *)
      file=$work/model.crease
      "$crease" build "$model" -o "$file" --quiet || continue
      ;;
  esac
  "$crease" info "$file" --json | python3 -c '
import json, os, sys
info, name = json.load(sys.stdin), os.path.basename(sys.argv[1]).split(".")[0]
count, linear = info["triangles"], info["linear_bytes"]
kinds = [100 * info[kind] / count for kind in ("sn_triangles", "fn_triangles", "nsn_triangles")]
three, wedge, replicated = linear["crease"], linear["wedge"], linear["replicated"]
sizes = " | ".join(f"{size / 1e6:.2f} MB" for size in (three, wedge, replicated))
print(f"| {name} | {count:,} | {kinds[0]:.0f} / {kinds[1]:.0f} / {kinds[2]:.0f} % | {sizes} | "
      f"{100 * three / wedge:.0f} % | {100 * three / replicated:.0f} % |")
' "$model"
done
