#!/usr/bin/env bash
# Small exemplars: squares of 64, 96 and 128 pixels out of the middle of larger ones, at half and a quarter of their size,
# are made four times as large and scored. The table goes into quality.md. Uses the build folder.
# Usage: tests/bench/small_exemplars.sh OUT IMAGE...
# SEEDS="1 2 3": one run for each. SETTINGS="now= even=layout.evenness=0": what to compare, NAME=SETTING,SETTING...
# PROGRAM: the terrazzo to run, build/terrazzo if none is given. Results that are there already are not made again.
# PEER: a program to compare with, called with IN.ppm OUT.ppm SIDE; needs OpenImageIO's oiiotool.
# OUT/SIDE/SCALE/NAME holds the exemplar and OUT/SIDE/SCALE/NAME/SETTING-SEED the result, to look at.
set -euo pipefail
[ $# -gt 1 ] && [ -f "$2" ] || { sed -n '2,8s/^# //p' "$0"; exit 2; }
out=$(realpath -m "$1")
shift
images=()
for image; do images+=("$(realpath "$image")"); done
cd "$(dirname "$0")/../.."
export TERRAZZO_CACHE=$out/cache

# The name of an exemplar: of the folder, if it is one of maps.
name_of() {
  case $(basename "$1") in
    base*color.*) basename "$(dirname "$1")" ;;
    *) basename "${1%.*}" ;;
  esac
}

# Scores OUT/base_color.png against EXEMPLAR, once.
score() {
  [ -f "$2/score.json" ] || build/terrazzo compare "$1" "$2/base_color.png" --json >"$2/score.json"
}

# Makes and scores what one exemplar gives. make EXEMPLAR FOLDER SIDE
make() {
  local setting changes to
  for seed in ${SEEDS:-1}; do
    for setting in ${SETTINGS:-now= uneven=layout.evenness=0}; do
      to=$2/${setting%%=*}-$seed
      changes=${setting#*=}
      mkdir -p "$to"
      [ -f "$to/base_color.png" ] || "${PROGRAM:-build/terrazzo}" run graphs/texture.json --progress none --force --set "image=$1" --set "scale=4" \
        --set "seed=$seed" --set "out=$to" ${changes:+$(sed 's/^\|,/ --set /g' <<<"$changes")} 2>"$to/log.txt"
      score "$1" "$to"
    done
  done
  [ -n "${PEER:-}" ] || return 0
  to=$2/peer-1
  mkdir -p "$to"
  [ -f "$to/base_color.png" ] || peer "$1" "$to" "$3"
  score "$1" "$to"
}

# What the other program makes. peer EXEMPLAR FOLDER SIDE
peer() {
  local to=$2
  oiiotool "$1" --ch R,G,B -o "$to/in.ppm"
  "$PEER" "$to/in.ppm" "$to/out.ppm" $((4 * $3)) >"$to/log.txt" 2>&1
  oiiotool "$to/out.ppm" -o "$to/base_color.png"
}

for side in 64 96 128; do
  for scale in 0.5 0.25; do
    for image in "${images[@]}"; do
      folder=$out/$side/$scale/$(name_of "$image")
      [ -f "$folder/exemplar.png" ] || build/terrazzo run tests/bench/small_exemplars.json --progress none --force --set "image=$image" \
        --set "scale=$scale" --set "side=$side" --set "out=$folder" 2>/dev/null ||
        { echo "$image: too small for $side pixels at a scale of $scale" >&2; continue; }
      make "$folder/exemplar.png" "$folder" "$side"
    done
  done
done
python3 - "$out" <<'P'
import collections, json, pathlib, sys
figures = ("swd", "coherence", "completeness", "acf", "broken", "verbatim", "repeat")
scores = collections.defaultdict(list)
for path in sorted(pathlib.Path(sys.argv[1]).glob("*/*/*/*/score.json")):
    side, what = path.parts[-5], path.parts[-2].rsplit("-", 1)[0]
    found = {f["name"]: f["value"] for f in json.loads(path.read_text())["figures"]}
    scores[int(side), what].append([found[name] for name in figures])
print("| side | exemplars and seeds | what | swd | coherence | complete | acf | broken | verbatim | repeat |")
print("|---|---|---|---|---|---|---|---|---|---|")
for (side, what), rows in sorted(scores.items()):
    means = [f"{sum(column) / len(rows):.4f}" for column in zip(*rows)]
    print("| " + " | ".join([str(side), str(len(rows)), what] + means) + " |")
P
