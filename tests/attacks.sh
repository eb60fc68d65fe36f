#!/usr/bin/env bash
# What must never happen: a wrong byte without a word. Each attack is repeated with other random choices; whatever it does,
# a run either gives the bytes of a clean one or fails with a message, and the next clean run gives these bytes.
#   kills      runs killed at any moment
#   cache      entries of the cache altered, cut off, emptied, exchanged or lost
#   removal    the cache removed, or cleared, while a run uses it
#   images     inputs altered or cut off, in formats with checksums
#   disk       files that may not grow, and, for root, a full file system
#   documents  graphs with bytes altered, doubled or lost
#   analyses   saved analyses altered or cut off
#   soak       runs of several processes at once in a cache that is far too small
# Usage: tests/attacks.sh [ROUNDS [NAME...]]   of each, or of these; 50 rounds if not given
# TERRAZZO_PROGRAM: the program, if not build/terrazzo. TERRAZZO_ATTACK_SEED: a number that it told, to do the same again.
set -uo pipefail
all=(kills cache removal images disk documents analyses soak)
rounds=${1:-50}
[[ $rounds =~ ^[0-9]+$ ]] || { sed -n '2,14s/^# //p' "$0"; exit 2; }
attacks=("${@:2}")
[ ${#attacks[@]} -gt 0 ] || attacks=("${all[@]}")
for name in "${attacks[@]}"; do
  [[ " ${all[*]} " == *" $name "* ]] || { echo "there is no attack $name; there are ${all[*]}" >&2; exit 2; }
done
source=$(realpath "$(dirname "$0")/..")
program=$(realpath "${TERRAZZO_PROGRAM:-$source/build/terrazzo}") && [ -x "$program" ] ||
  { echo "there is no program ${TERRAZZO_PROGRAM:-$source/build/terrazzo}; build it, or set TERRAZZO_PROGRAM" >&2; exit 2; }
seed=${TERRAZZO_ATTACK_SEED:-$RANDOM}
scratch=$(mktemp -d "${TMPDIR:-/tmp}/terrazzo-attacks.XXXXXX")
mounted=
trap '[ -z "$mounted" ] || umount "$mounted"; rm -rf "$scratch"' EXIT
cd "$scratch" || exit 2
failed=0
longest=120  # seconds; a run takes less than one

complain() {
  echo "error: $attack, round $round (TERRAZZO_ATTACK_SEED=$seed): $1" >&2
  [ ! -s said ] || tail -n 5 said >&2
  failed=$((failed + 1))
}

# below N: sets `number` to a random one.
below() { number=$(((RANDOM * 32768 + RANDOM) % $1)); }

# one_of WORD...: sets `choice` to one of them.
one_of() { below $#; number=$((number + 1)); choice=${!number}; }

# damage FILE [FROM]: alters a byte, or cuts off the end, behind the first FROM bytes.
damage() {
  local from=${2:-0} size at byte
  size=$(stat -c %s "$1")
  [ "$size" -gt "$from" ] || return 0
  below $((size - from))
  at=$((from + number))
  one_of alter alter cut
  if [ "$choice" = cut ]; then
    truncate --size="$at" "$1"
  else
    byte=$(od -An -tu1 -j "$at" -N 1 "$1")
    below 255
    # shellcheck disable=SC2059
    printf "$(printf '\\x%02x' $((byte ^ (number + 1))))" | dd of="$1" bs=1 seek="$at" conv=notrunc status=none
  fi
}

# run CACHE OUT [ARGUMENT...]: sets `code`; what it says is in the file `said`.
run() {
  code=0
  timeout -k 5 $longest "$program" run walls.json --cache "$1" --set out="$2" --progress none "${@:3}" >said 2>&1 || code=$?
}

# judge OUT [EXPECTED [WHAT]]: after `run`: the right bytes, or an error that is told.
judge() {
  if [ "$code" -eq 0 ]; then
    diff -r "$1" "${2:-clean}" >/dev/null || complain "${3:-}it gave wrong bytes without a word"
  elif [ "$code" -gt 2 ]; then
    complain "it ended with code $code"
  else
    [ -s said ] || complain "it failed without a word"
  fi
}

# clean_run CACHE: whatever is in it, a run now gives the right bytes.
clean_run() {
  rm -rf out
  run "$1" out
  [ "$code" -eq 0 ] && diff -r out clean >/dev/null || complain "the next run does not give the right bytes"
}

entries_of() { find "$1" -type f ! -path '*/leases/*'; }

kills() {
  # Most runs begin with an empty cache, the others with what those before have left.
  one_of empty empty left
  [ "$choice" = left ] || rm -rf cache
  rm -rf out
  "$program" run walls.json --cache cache --set out=out --progress none >said 2>&1 &
  below $((took_ms * 11 / 10))
  sleep "$((number / 1000)).$(printf %03d $((number % 1000)))"
  kill -KILL $! 2>/dev/null
  wait $! 2>/dev/null
  : >said
  clean_run cache
}

cache() {
  rm -rf cache
  cp -r full cache
  local entries other
  mapfile -t entries < <(entries_of cache | sort)
  for _ in 1 2 3; do
    one_of "${entries[@]}"
    local entry=$choice
    [ -f "$entry" ] || continue
    one_of damage damage empty exchange lose
    case $choice in
      damage) damage "$entry" ;;
      empty) : >"$entry" ;;
      lose) rm -f "$entry" ;;
      exchange) one_of "${entries[@]}"; other=$choice; [ ! -f "$other" ] || [ "$other" = "$entry" ] || cp "$other" "$entry" ;;
    esac
  done
  rm -rf out
  run cache out
  [ "$code" -eq 0 ] || complain "a damaged cache ended the run"
  judge out
  clean_run cache
}

removal() {
  rm -rf cache out
  one_of empty full
  [ "$choice" = empty ] || cp -r full cache
  { run cache out; echo "$code" >code; } &
  local running=$!
  below "$took_ms"
  sleep "$((number / 1000)).$(printf %03d $((number % 1000)))"
  one_of all part clear
  case $choice in
    all) rm -rf cache ;;
    part) find cache -type f 2>/dev/null | shuf -n 5 --random-source=<(yes "$number") | xargs -r rm -f ;;
    clear) "$program" cache clear --cache cache >/dev/null 2>&1 ;;
  esac 2>/dev/null
  wait "$running"
  code=$(cat code)
  judge out
  clean_run cache
}

images() {
  one_of png exr tif
  local format=$choice
  rm -rf broken out cache
  cp -r "exemplar-$format" broken
  one_of broken/*
  local file=$choice
  # In PNG everything has a checksum; in the others the pixels, which begin behind the header.
  if [ "$format" = png ]; then damage "$file"; else damage "$file" $(($(stat -c %s "$file") / 3)); fi
  run cache out --set material=broken
  judge out "clean-$format" "$file: "
}

disk() {
  rm -rf cache out
  one_of limit full
  if [ "$choice" = full ] && [ "$(id -u)" -eq 0 ] && mkdir -p small && below 3000 &&
    mount -t tmpfs -o size=$((number + 16))k tmpfs small 2>/dev/null; then
    mounted=$scratch/small
    one_of small/cache cache
    local where=$choice
    run "$where" small/out
    [ ! -d small/out ] || cp -r small/out out
    judge out
    umount small && mounted=
    [ "$where" = cache ] || rm -rf cache
  else
    below 200
    (ulimit -f "$number"; run cache out; echo "$code" >code)
    code=$(cat code)
    judge out
  fi
  clean_run cache
}

documents() {
  one_of "$source"/graphs/*.json
  cp "$choice" mutated.json
  local size at
  for _ in 1 2 3; do
    size=$(stat -c %s mutated.json)
    [ "$size" -gt 8 ] || break
    below $((size - 4)); at=$number
    one_of alter alter lose double
    case $choice in
      alter) damage mutated.json ;;
      lose) { head -c "$at" mutated.json; tail -c +$((at + 4)) mutated.json; } >next && mv next mutated.json ;;
      double) { head -c $((at + 3)) mutated.json; tail -c +$((at + 1)) mutated.json; } >next && mv next mutated.json ;;
    esac
  done
  code=0
  timeout -k 5 $longest "$program" check mutated.json --set material=exemplar-png >said 2>&1 || code=$?
  [ "$code" -le 2 ] || complain "check of $(cat mutated.json) ended with code $code"
  [ "$code" -eq 0 ] || [ -s said ] || complain "check failed without a word"
}

analyses() {
  rm -rf cache out
  cp saved.analysis broken.analysis
  damage broken.analysis
  code=0
  timeout -k 5 $longest "$program" run "$source/graphs/from_analysis.json" --set analysis=broken.analysis --set quality=draft \
    --set material=exemplar-png --set size=64 --set out=out --cache cache --progress none >said 2>&1 || code=$?
  judge out clean-analysis
}

soak() {
  local n waiting=() which=()
  [ -d small-cache ] || mkdir small-cache
  for n in 1 2 3 4; do
    one_of 1 2 3 4
    which+=("$choice")
    rm -rf "out$n"
    one_of 20K 300K 10M
    timeout -k 5 $longest "$program" run walls.json --cache small-cache --cache-size "$choice" --set out="out$n" \
      --set seed="${which[-1]}" --progress none >"said$n" 2>&1 &
    waiting+=($!)
  done
  one_of verify gc none
  [ "$choice" = none ] || "$program" cache "$choice" --cache small-cache >/dev/null 2>&1
  for n in 1 2 3 4; do
    wait "${waiting[n - 1]}" || { cp "said$n" said; complain "one of several runs failed"; continue; }
    diff -r "out$n" "clean-seed-${which[n - 1]}" >/dev/null || complain "one of several runs gave wrong bytes"
  done
}

# What clean runs give, without a cache.
attack=preparing round=0
cp "$source/graphs/material.json" walls.json
sed -i 's/"path", "help": "folder of the exemplar/"path", "default": "exemplar-png", "help": "folder of the exemplar/; s/"scale":\(.*\)"default": 2/"scale":\1"default": 1/; s/"default": "normal"/"default": "draft"/' walls.json
"$program" run "$source/graphs/generate-exemplar.json" --set type=bricks --set size=64 --set out=exemplar --cache first \
  --progress none >said 2>&1 || { complain "no exemplar could be made"; exit 1; }
rm -f exemplar/preview.png
for format in png exr tif; do
  cat >convert.json <<JSON
{"terrazzo": 1, "nodes": {"in": {"type": "load_material", "path": "exemplar"},
  "files": {"type": "export", "material": "@in", "path": "exemplar-$format/{map}.$format"}}}
JSON
  "$program" run convert.json --cache first --progress none >said 2>&1 || { complain "no $format could be made"; exit 1; }
done
clean() { run first "$1" "${@:2}"; [ "$code" -eq 0 ] || { complain "a clean run failed"; exit 1; }; }
for format in png exr tif; do clean "clean-$format" --set material="exemplar-$format"; done
ln -s clean-png clean
for n in 1 2 3 4; do clean "clean-seed-$n" --set seed="$n"; done
start=$(date +%s%N)
run full out
took_ms=$((($(date +%s%N) - start) / 1000000))
judge out
for step in "analyse.json --set material=exemplar-png --set out=saved.analysis" \
  "from_analysis.json --set analysis=saved.analysis --set quality=draft --set material=exemplar-png --set size=64 --set out=clean-analysis"; do
  # shellcheck disable=SC2086
  "$program" run "$source/graphs/"$step --cache first --progress none >said 2>&1 || { complain "$step failed"; exit 1; }
done

for attack in "${attacks[@]}"; do
  before=$failed started=$SECONDS
  for ((round = 1; round <= rounds; round++)); do
    # Each attack and round has choices of its own, whichever others are done.
    RANDOM=$(((seed * 31 + round * 7919 + ${#attack} * 104729 + $(printf %d "'${attack:1:1}")) % 32768))
    : >said
    "$attack"
  done
  echo "$attack: $rounds rounds, $((failed - before)) wrong, $((SECONDS - started)) s"
done
[ "$failed" -eq 0 ]
