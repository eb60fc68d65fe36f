#!/usr/bin/env bash
# CPU seconds (user and system, whole process) of one map made 1024x1024, read to written PNG, for every picture in a
# folder: with nothing cached and with the analysis cached, the least of the repeats. One thread: two that share a core
# take longer each. The table goes into performance.md.
# Needs a build (cmake --preset release), and GNU time.
# Usage: tests/bench/one_map.sh FOLDER [REPEATS]   (3 if not given)
# YARDSTICK=PROGRAM: another program, called with picture, result and side, and timed in turn with terrazzo.
set -euo pipefail
[ -d "${1:-}" ] || { sed -n '2,7s/^# //p' "$0"; exit 2; }
folder=$(realpath "$1") repeats=${2:-3}
cd "$(dirname "$0")/../.."
program=${TERRAZZO:-build/terrazzo}
out=$(mktemp -d "${TMPDIR:-/tmp}/terrazzo-one-map.XXXXXX")
trap 'rm -rf "$out"' EXIT

# timed COMMAND...: prints its CPU seconds.
timed() {
  /usr/bin/time -o "$out/time" -f "%U %S" "$@" >/dev/null 2>&1 || { echo "$* failed" >&2; exit 1; }
  tail -1 "$out/time" | awk '{ print $1 + $2 }'
}
made() {
  timed "$program" run graphs/texture.json --threads 1 --progress none --set size=1024x1024 --set "out=$out/maps" "$@"
}
least() { tr ' ' '\n' <<<"$*" | sort -g | head -1; }

echo "| exemplar | nothing cached | analysis cached |${YARDSTICK:+ yardstick | of it |}"
echo "|---|---|---|${YARDSTICK:+---|---|}"
for picture in "$folder"/*.png; do
  cold=() cached=() yardstick=()
  made --set "image=$picture" --only index --cache "$out/cache" >/dev/null
  for ((i = 1; i <= repeats; i++)); do
    cold+=("$(made --set "image=$picture" --no-cache)")
    cached+=("$(made --set "image=$picture" --set "seed=$i" --cache "$out/cache")")
    [ -z "${YARDSTICK:-}" ] || yardstick+=("$(timed "$YARDSTICK" "$picture" "$out/yardstick" 1024)")
  done
  line="| $(basename "$picture" .png) | $(least "${cold[@]}") | $(least "${cached[@]}") |"
  if [ -n "${YARDSTICK:-}" ]; then
    of=$(awk -v a="$(least "${cold[@]}")" -v b="$(least "${yardstick[@]}")" 'BEGIN { printf "%.2f", a / b }')
    line+=" $(least "${yardstick[@]}") | $of |"
  fi
  echo "$line"
done
