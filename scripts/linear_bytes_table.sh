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
b, t = info["linear_bytes"], info["triangles"]
kinds = " / ".join(f"{100 * info[k + "_triangles"] / t:.0f}" for k in ("sn", "fn", "nsn"))
def megabytes(n): return f"{n / 1e6:.2f} MB"
print(f"| {name} | {t:,} | {kinds} % | {megabytes(b["crease"])} | {megabytes(b["wedge"])} | "
      f"{megabytes(b["replicated"])} | {100 * b["crease"] / b["wedge"]:.0f} % | "
      f"{100 * b["crease"] / b["replicated"]:.0f} % |")
' "$model"
done
