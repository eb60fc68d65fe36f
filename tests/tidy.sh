#!/usr/bin/env bash
# clang-tidy over as much of the tree as it can in a number of minutes (default 10; 0: all of it, a quarter of an hour). What the last commit
# changed comes first; the rest starts elsewhere after every commit, so that all files get their turn.
# Usage: tests/tidy.sh [MINUTES] [FILE...]      (given files, no others)
set -euo pipefail
cd "$(dirname "$0")/.."
minutes=${1:-10}
[[ $minutes =~ ^[0-9]+$ ]] || { sed -n '4s/^# //p' "$0" >&2; exit 2; }
files=("${@:2}")

examples/packages.sh clang-tidy doctest-dev pybind11-dev python3-dev
# GCC's precompiled headers mean nothing to clang, and files are looked at one by one.
cmake --preset develop -B build-tidy -DCMAKE_DISABLE_PRECOMPILE_HEADERS=ON >/dev/null

if [ ${#files[@]} -eq 0 ]; then
  mapfile -t all < <(git ls-files 'core/*.cpp' 'nodes/*.cpp' 'graphs/*.cpp' 'runner/*.cpp')
  mapfile -t files < <(git diff --name-only --diff-filter=d HEAD~1 -- 'core/*.cpp' 'nodes/*.cpp' 'graphs/*.cpp' 'runner/*.cpp' 2>/dev/null || true)
  first=$(($(git rev-list --count HEAD) * 40 % ${#all[@]}))
  mapfile -t files < <(printf '%s\n' "${files[@]}" "${all[@]:first}" "${all[@]:0:first}" | awk 'NF && !seen[$0]++')
fi

export started=$(date +%s) limit=$((minutes * 60)) looked_at=build-tidy/looked-at
: >"$looked_at"
# check FILE: unless the time is over.
check() {
  [ "$limit" -eq 0 ] || [ $(($(date +%s) - started)) -lt "$limit" ] || return 0
  echo "$1" >>"$looked_at"
  clang-tidy -p build-tidy --quiet --warnings-as-errors='*' --extra-arg=-Wno-unknown-warning-option "$1" 2>/dev/null
}
export -f check
status=0
printf '%s\n' "${files[@]}" | xargs -P "$(nproc)" -I{} bash -c 'check {}' || status=1
echo "clang-tidy has looked at $(wc -l <"$looked_at") of ${#files[@]} files"
exit $status
