#!/bin/sh
# Configures build/bench (or $CREASE_BENCH_BUILD), builds the programs named, and gets meshoptimizer
# from npm once. Needs libvtk9-dev libcgal-dev libopenmesh-dev libeigen3-dev libdraco-dev nodejs npm
# (scripts/setup.sh bench).
#
#   bench/setup.sh bench_quality peer_vtk peer_cgal peer_openmesh
set -eu
cd "$(dirname "$0")/.."
build=${CREASE_BENCH_BUILD:-build/bench}
mkdir -p "$build"
if [ ! -f "$build/build.ninja" ]; then
  launcher=
  command -v ccache > /dev/null && launcher=-DCMAKE_CXX_COMPILER_LAUNCHER=ccache
  cmake -G Ninja -S . -B "$build" -DCMAKE_BUILD_TYPE=Release -DCREASE_BENCH=ON -DCREASE_TESTS=OFF \
    $launcher > "$build/setup.log" 2>&1 || { cat "$build/setup.log" >&2; exit 1; }
fi
cmake --build "$build" --target "$@" > "$build/setup.log" 2>&1 || {
  cat "$build/setup.log" >&2
  exit 1
}
if [ ! -d "$build/bench_cache/node_modules/meshoptimizer" ]; then
  mkdir -p "$build/bench_cache"
  npm install --silent --no-audit --no-fund --prefix "$build/bench_cache" meshoptimizer@1.3.0 >&2
fi
