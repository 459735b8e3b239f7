#!/bin/sh
# Configures a preset and builds targets of it (all without a name), with ccache when it is there.
#
#   scripts/build.sh release crease_cli
set -eu
cd "$(dirname "$0")/.."
preset=$1
shift
launcher=
command -v ccache > /dev/null && launcher=-DCMAKE_CXX_COMPILER_LAUNCHER=ccache
export CCACHE_SLOPPINESS=pch_defines,time_macros  # else ccache passes over precompiled headers
cmake --preset "$preset" $launcher > "/tmp/crease-configure.$$" 2>&1 || {
  cat "/tmp/crease-configure.$$" >&2
  exit 1
}
rm -f "/tmp/crease-configure.$$"
export CCACHE_BASEDIR="$PWD" CCACHE_NOHASHDIR=1  # so that another checkout finds the same
exec cmake --build --preset "$preset" ${1:+--target} "$@"
