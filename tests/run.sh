#!/usr/bin/env bash
# Installs what is missing, builds, and runs every test. Arguments go to ctest: tests/run.sh -R cache
set -euo pipefail
cd "$(dirname "$0")/.."

examples/packages.sh doctest-dev
cmake --preset release
cmake --build build
ctest --preset release -j "$(nproc)" "$@"
