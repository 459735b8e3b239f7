#!/bin/sh
# Writes sample GLBs and holds them against gltf-validator. Exits 77 (skipped) when npm cannot
# install it: there may be no network.
#
#   run_gltf_validator.sh SOURCE_FOLDER WORK_FOLDER WRITE_SAMPLES_PROGRAM
set -eu
source=$1
work=$2
write_samples=$3

mkdir -p "$work"
cp "$source/package.json" "$source/package-lock.json" "$source/validate_gltf.js" "$work"
if ! cmp -s "$work/package-lock.json" "$work/installed-lock.json"; then
  (cd "$work" && npm ci --no-audit --no-fund --silent) || {
    echo "npm ci failed: gltf-validator is not there"
    exit 77
  }
  cp "$work/package-lock.json" "$work/installed-lock.json"
fi
rm -rf "$work/samples"
mkdir "$work/samples"
"$write_samples" "$work/samples"
cd "$work"
exec node validate_gltf.js samples
