#!/bin/sh
# clang-format 14 over the tree, in place; with --check only says which files differ.
set -eu
cd "$(dirname "$0")/.."
mode=-i
[ "${1:-}" = --check ] && mode='--dry-run --Werror'
# shellcheck disable=SC2086  # the mode is words
git ls-files '*.h' '*.cpp' ':!tests/layers/planted' | xargs clang-format-14 $mode
