#!/usr/bin/env bash
# Whether materials can be told apart, and one from itself when it is repainted: the table of
# experiments.md#likeness. Builds the bench preset.
# Usage: tests/bench/likeness.sh FOLDER_OF_MAPS...
set -euo pipefail
[ $# -gt 1 ] && [ -d "$1" ] || { sed -n '2,4s/^# //p' "$0"; exit 2; }
folders=()
for folder; do folders+=("$(realpath "$folder")"); done
cd "$(dirname "$0")/../.."
{
  cmake --preset bench
  cmake --build --preset bench --target terrazzo_likeness
} >&2
build-bench/tests/bench/terrazzo_likeness "${folders[@]}"
