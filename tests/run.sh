#!/usr/bin/env bash
# Installs missing packages, builds, and runs every test: one run of the test program for each room. Arguments go to
# ctest: tests/run.sh -R runner/cache. With -C long it also runs what needs Blender or Godot, 64 variations through Slurm, and
# packages and Blender 4 in bare Debians (as root, with debootstrap). A single test is quicker without it, and -d tells how
# long each takes:
#   build/tests/terrazzo_tests -d -tc="*cache*"
# Under the sanitizers: tests/sanitize.sh.
set -euo pipefail
cd "$(dirname "$0")/.."

examples/packages.sh doctest-dev python3-jsonschema dpkg-dev pybind11-dev python3-dev python3-numpy munge slurm-wlm
cmake --preset release -DTERRAZZO_TESTS=ON -DTERRAZZO_PYTHON=ON
cmake --build build
log=build/Testing/Temporary/LastTest.log
rm -f "$log"
status=0
ctest --preset release -j "$(nproc)" "$@" || status=$?
[ ! -f "$log" ] || awk -f tests/count.awk "$log"
exit "$status"
