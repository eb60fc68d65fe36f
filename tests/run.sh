#!/usr/bin/env bash
# Installs missing packages, builds, and runs every test. Arguments go to ctest: tests/run.sh -R cache
#
# Under the sanitizers, once this script has installed the packages:
#   cmake --preset asan && cmake --build --preset asan && ctest --preset asan -j 2     addresses, leaks, undefined behaviour
#   cmake --preset tsan && cmake --build --preset tsan && ctest --preset tsan -j 2     races; tests/tsan/ describes oneTBB's order
# A single test is quicker without ctest; CMakePresets.json has the options:
#   TSAN_OPTIONS=ignore_noninstrumented_modules=1 build-tsan/tests/terrazzo_tests -tc="*cache*"
set -euo pipefail
cd "$(dirname "$0")/.."

examples/packages.sh doctest-dev
cmake --preset release
cmake --build build
ctest --preset release -j "$(nproc)" "$@"
