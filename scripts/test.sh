#!/bin/sh
# Everything that must hold before a commit, in stages; without names, all of them.
#
#   scripts/test.sh                     all
#   scripts/test.sh release layers      these two
#
#   format    clang-format changes nothing
#   release   build with warnings as errors, all tests, the layers and the install test among them
#   asan      all tests under the address and undefined-behaviour sanitizers, with clang
#   tsan      the tests that use threads, under the thread sanitizer
#   libcxx    crease_runtime with clang 14 and libc++, without exceptions and RTTI
#   fuzz      each fuzzer of asan's build for FUZZ_SECONDS (60)
#   tidy      clang-tidy (not among all: it takes longer than the rest together)
set -eu
cd "$(dirname "$0")/.."
jobs=$(nproc)
tests=$((jobs + 1)) # at a time, since some wait for a window or a host

run_stage() {
  case $1 in
    format)
      scripts/format.sh --check
      ;;
    release)
      scripts/build.sh release
      ctest --preset release -j "$tests"
      ;;
    asan)
      scripts/build.sh asan
      # LeakSanitizer sees the driver's own leaks once a GL context has been made.
      LSAN_OPTIONS=suppressions=$PWD/scripts/leaks.supp:print_suppressions=0 \
        ctest --preset asan -j "$tests"
      ;;
    tsan)
      scripts/build.sh tsan threaded_tests
      TSAN_OPTIONS=suppressions=$PWD/scripts/threads.supp:halt_on_error=1 \
        ctest --preset tsan -L threads -j "$tests"
      ;;
    libcxx)
      scripts/build.sh libcxx crease_runtime
      ;;
    fuzz)
      scripts/build.sh fuzz
      scripts/fuzz.sh build/asan "$FUZZ_SECONDS"
      ;;
    tidy)
      scripts/build.sh release
      git ls-files 'src/*.cpp' 'apps/*.cpp' |
        xargs -n 1 -P "$jobs" clang-tidy-14 --quiet -p build/release
      ;;
    *)
      echo "test: no stage is called $1" >&2
      exit 1
      ;;
  esac
}

FUZZ_SECONDS=${FUZZ_SECONDS:-60}
[ $# -gt 0 ] || set -- format release asan tsan libcxx fuzz
for stage; do
  start=$(date +%s)
  echo "== $stage" >&2
  run_stage "$stage"
  echo "== $stage passed, $(($(date +%s) - start)) s" >&2
done
