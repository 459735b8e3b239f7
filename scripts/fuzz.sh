#!/bin/sh
# Runs every fuzzer of a build for some seconds each, six times as many at a time as there are
# processors, starting from its seeds in fuzz/seeds/NAME and, where ../shared/data is there, nothing
# else: seeds are small. A crash leaves its input in build/asan/crashes and fails.
#
#   scripts/fuzz.sh build/asan 60
set -eu
build=$1
seconds=$2
mkdir -p "$build/crashes" "$build/logs"

fuzz_one() {  # NAME
  corpus=$build/corpus/$1
  mkdir -p "$corpus"
  seeds=
  [ -d "fuzz/seeds/$1" ] && seeds=fuzz/seeds/$1
  # shellcheck disable=SC2086  # no seeds, no argument
  if "$build/bin/$1" -max_total_time="$seconds" -timeout=20 -rss_limit_mb=2048 -print_final_stats=1 \
    -artifact_prefix="$build/crashes/$1-" "$corpus" $seeds > "$build/logs/$1.log" 2>&1; then
    echo "fuzz: $1: $(sed -n 's/^stat::number_of_executed_units: *//p' "$build/logs/$1.log") runs, no crash"
  else
    echo "fuzz: $1 FAILED:"
    tail -n 60 "$build/logs/$1.log"
    return 1
  fi
}

if [ $# -gt 2 ]; then  # one fuzzer, called by xargs below
  fuzz_one "$3"
  exit
fi
names=$(cd "$build/bin" && ls fuzz_*)
[ -n "$names" ] || exit 1
echo "$names" | xargs -n 1 -P "$((6 * $(nproc)))" "$0" "$build" "$seconds"
