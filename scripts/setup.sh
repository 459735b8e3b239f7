#!/bin/sh
# Installs what crease is built and tested with on Debian 12. The one place that lists packages.
#
#   scripts/setup.sh          compilers, libraries, what the tests run
#   scripts/setup.sh bench    also the peers that bench/ measures against
#
# Needs root or sudo, unless everything is there already.
set -eu

tools="build-essential cmake ninja-build ccache pkg-config git python3 xz-utils zstd
  clang-14 libclang-rt-14-dev libc++-14-dev libc++abi-14-dev clang-format-14 clang-tidy-14"
libraries="libtbb-dev libembree-dev libcli11-dev nlohmann-json3-dev libfast-float-dev libxxhash-dev
  libzstd-dev liblzma-dev libdraco-dev libmeshoptimizer-dev libpng-dev libturbojpeg0-dev libstb-dev libepoxy-dev libegl-dev libgl1-mesa-dri
  libeigen3-dev libcurl4-openssl-dev libmicrohttpd-dev libglfw3-dev libimgui-dev libgl1"
tests="doctest-dev librapidcheck-dev nginx-light openssl xvfb xdotool python3-numpy python3-pil"
peers="libvtk9-dev libcgal-dev libopenmesh-dev python3-matplotlib"

packages="$tools $libraries $tests"
[ "${1:-}" = bench ] && packages="$packages $peers"
# Node runs the glTF validator in one test; any version will do, so one that is there is kept.
command -v node > /dev/null && command -v npm > /dev/null || packages="$packages nodejs npm"

missing=
for package in $packages; do
  dpkg-query -W -f '${db:Status-Status}' "$package" 2> /dev/null | grep -qx installed ||
    missing="$missing $package"
done

if [ -n "$missing" ]; then
  echo "setup: installing$missing" >&2
  as_root=
  if [ "$(id -u)" != 0 ]; then
    command -v sudo > /dev/null || {
      echo "setup: not root and no sudo; as root run: apt-get install --no-install-recommends$missing" >&2
      exit 1
    }
    as_root=sudo
  fi
  $as_root apt-get update -q >&2
  # shellcheck disable=SC2086  # the list is words
  DEBIAN_FRONTEND=noninteractive $as_root apt-get install -q -y --no-install-recommends $missing >&2
fi
