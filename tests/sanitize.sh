#!/usr/bin/env bash
# Runs the tests under the sanitizers: addresses, leaks and undefined behaviour (asan), then races (tsan; tests/tsan/
# describes oneTBB's order to it), then without optimisation (debug). All of them take hours; "short" builds and runs the
# rooms that each finds most in, and under tsan the tests of the synthesis that are about threads.
# Usage: tests/sanitize.sh [short] [asan|tsan|debug]
# A single test, with the options of CMakePresets.json:
#   TSAN_OPTIONS=ignore_noninstrumented_modules=1 build-tsan/tests/terrazzo_tests -tc="*cache*"
set -euo pipefail
cd "$(dirname "$0")/.."

short=
if [ "${1:-}" = short ]; then short=yes; shift; fi
[[ $# -le 1 && ${1:-asan} =~ ^(asan|tsan|debug)$ ]] || { sed -n '5s/^# //p' "$0" >&2; exit 2; }
declare -A rooms
if [ -n "$short" ]; then
  rooms[asan]="core/base;core/file;core/block_file;core/integrity;core/node;core/synthesis;graphs/text;graphs/values;graphs/document;graphs/expression"
  rooms[tsan]="runner/engine;runner/cache;core/synthesis"
  rooms[debug]="core/base;core/file;core/block_file;core/integrity;core/image;core/image_io;core/filter;core/material;core/node;graphs/text;graphs/values;graphs/document;graphs/expression;graphs/tools;runner/plan"
fi

examples/packages.sh doctest-dev
failed=0
for preset in ${1:-asan tsan debug}; do
  cmake --preset "$preset" -DTERRAZZO_TESTS=ON -DTERRAZZO_TEST_ROOMS="${rooms[$preset]:-}"
  cmake --build --preset "$preset"
  if [ -n "$short" ]; then
    if [ "$preset" = tsan ]; then
      ctest --preset tsan -j "$(nproc)" -E core/synthesis || failed=1
      TSAN_OPTIONS=ignore_noninstrumented_modules=1:second_deadlock_stack=1 \
        build-tsan/tests/terrazzo_tests -sf='*tests/core/synthesis/*' -tc='*thread*' || failed=1
    else
      ctest --preset "$preset" -j "$(nproc)" || failed=1
    fi
  else
    ctest --preset "$preset" -j "$(nproc)" || failed=1
  fi
done
exit $failed
