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
#   cancel     Ctrl-C at any moment while large, flat pictures are looked at
#   limits     hardly any stack, hardly any threads
#   links      folders exchanged for links that lead out of the sandbox in which a run works
#   soak       runs of several processes at once in a cache that is far too small
#   packs      the unpacked copy of a pack altered, cut off, lost or added to
#   expansion  short graphs that stand for very much: bounded in time and memory
#   library    one name added twice at once, on a slow disk
#   frozen     the files of a farm's job altered, cut off or lost
# Usage: tests/attacks.sh [ROUNDS [NAME...]]   of each, or of these; 50 rounds if not given
# TERRAZZO_PROGRAM: the program, if not build/terrazzo. TERRAZZO_ATTACK_SEED: a number that it told, to do the same again.
set -uo pipefail
all=(kills cache removal images disk documents analyses cancel limits links soak packs expansion library frozen)
rounds=${1:-50}
[[ $rounds =~ ^[0-9]+$ ]] || { sed -n '2,21s/^# //p' "$0"; exit 2; }
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

# A picture that is large and flat is small as a file. What it takes to look at it must not grow faster than its area.
cancel() {
  if [ ! -d flat ]; then
    cat >flat.json <<JSON
{"terrazzo": 1, "nodes": {"grey": {"type": "solid", "size": [6000, 6000], "value": [0.5, 0.5, 0.5], "semantic": "base_color"},
  "files": {"type": "export", "material": "@grey", "path": "flat/base_color.png"}}}
JSON
    clean_flat=$("$program" run flat.json --no-cache --progress none 2>&1) || { complain "no flat picture: $clean_flat"; return; }
  fi
  rm -rf cache out
  "$program" run walls.json --cache cache --set out=out --set material=flat --progress none >said 2>&1 &
  local waiting=$!
  below 3000
  sleep "$((number / 1000)).$(printf %03d $((number % 1000)))"
  # Of a shell in the background SIGINT is ignored; the program takes both alike.
  kill -TERM $waiting 2>/dev/null
  local sent=$SECONDS
  wait $waiting
  code=$?
  [ "$code" -eq 130 ] || complain "exit $code after Ctrl-C"
  # It takes a second on a machine that is idle.
  [ $((SECONDS - sent)) -le 20 ] || complain "Ctrl-C took $((SECONDS - sent)) seconds"
  [ ! -e out ] || complain "a cancelled run has left files"
}

limits() {
  one_of stack threads
  rm -rf cache out
  if [ "$choice" = stack ]; then
    one_of 48 64 128 256
    (ulimit -s "$choice"; run cache out; echo "$code" >code)
    code=$(cat code)
    judge out
  else
    # The limit does not hold for root.
    below 8
    local as=()
    if [ "$(id -u)" -eq 0 ]; then
      as=(setpriv --reuid 65534 --clear-groups)
      chmod 777 . && chmod -R a+rX . && "${as[@]}" "$program" --version >/dev/null 2>&1 || return 0
    fi
    timeout -s KILL "$longest" "${as[@]}" bash -c "ulimit -u $((number + 1)); exec '$program' run walls.json --cache cache \
      --set out=out --set material=exemplar-exr --progress none" >said 2>&1
    code=$?
    judge out clean-exr
  fi
}

links() {
  rm -rf cell outside
  mkdir -p cell/out outside
  cp -r exemplar-png cell/maps
  cat >cell/graph.json <<'JSON'
{"terrazzo": 1, "nodes": {"in": {"type": "load_material", "path": "maps"},
  "large": {"type": "resize", "material": "@in", "size": [700, 700]},
  "one": {"type": "export", "material": "@large", "path": "out/{map}.png"},
  "two": {"type": "export", "material": "@in", "path": "out/deep/{map}.tif"},
  "three": {"type": "export", "material": "@in", "path": "out/{map}.exr"}}}
JSON
  while :; do
    mv -T cell/out cell/aside && ln -s ../outside cell/out
    rm -f cell/out && mv -T cell/aside cell/out
  done 2>/dev/null &
  local switching=$!
  code=0
  timeout -k 5 $longest "$program" run cell/graph.json --sandbox cell --no-cache --progress none >said 2>&1 || code=$?
  kill "$switching"
  wait "$switching" 2>/dev/null
  [ "$code" -le 2 ] || complain "it ended with code $code"
  [ "$code" -eq 0 ] || [ -s said ] || complain "it failed without a word"
  [ -z "$(find outside -mindepth 1)" ] || complain "it wrote outside: $(find outside -mindepth 1)"
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

packs() {
  local files
  rm -rf out
  mapfile -t files < <(find first/packs -type f)
  [ ${#files[@]} -gt 0 ] || { complain "the pack has no copy"; return; }
  one_of "${files[@]}"
  local file=$choice
  one_of damage lose add link
  case $choice in
    damage) damage "$file" ;;
    lose) rm "$file" ;;
    add) cp "$file" "${file%/*}/more_normal.${file##*.}" ;;
    link) cp "$file" aside && damage aside && ln -sf "$PWD/aside" "$file" ;;
  esac
  code=0
  timeout -k 5 $longest "$program" run walls.tzpack --cache first --set out=out --progress none >said 2>&1 || code=$?
  [ "$code" -eq 0 ] || complain "the copy was not mended"
  judge out
}

# in_bounds WORD...: the program with these words ends soon, in little memory, and says what is wrong if anything is.
in_bounds() {
  code=0
  (
    "$program" --version | grep -q sanitizers || ulimit -v 3000000
    timeout -k 5 60 "$program" "$@"
  ) >said 2>&1 || code=$?
  [ "$code" -le 2 ] || complain "\`$*\` of a graph of the kind $kind ended with code $code"
  [ "$code" -eq 0 ] || [ -s said ] || complain "\`$*\` failed without a word"
}

# many N FORMAT: FORMAT with each number up to N in place of every %d, between commas.
many() {
  awk -v n="$1" -v format="$2" 'BEGIN { for (i = 1; i <= n; i++) { item = format; gsub(/%d/, i, item); printf "%s%s", (i > 1 ? "," : ""), item } }'
}

expansion() {
  local kinds=(texts named parameters values presets maps loops chain settings equal) kind
  kind=${kinds[(round - 1) % ${#kinds[@]}]}
  local nodes='"n": {"type": "noise", "size": 16}, "f": {"type": "export", "material": "@n", "path": "o.png"}' parameters='' more=''
  local words=(check big.json)
  case $kind in
    texts)
      parameters='"t0": {"type": "text", "default": "0123456789"}'
      local i
      for ((i = 1; i <= 24; i++)); do parameters+=", \"t$i\": {\"type\": \"text\", \"default\": \"=t$((i - 1)) + t$((i - 1))\"}"; done
      nodes='"n": {"type": "noise", "size": 16}, "f": {"type": "export", "material": "@n", "path": "$t24.png"}'
      ;;
    named)
      parameters="\"t\": {\"type\": \"text\", \"default\": \"$(printf '%0100000d' 0)\"}"
      nodes="$(many 30000 "\"n%d\": {\"type\": \"load_map\", \"path\": \"x.png\", \"layer\": \"\$t\$t\$t\$t\$t\$t\$t\$t\"}")"
      ;;
    parameters) parameters=$(many 100000 '"p%d": {"type": "int", "default": %d}') ;;
    values) words+=(--sweep "n.seed=$(many 15000 1)") && words[0]=run && words+=(--dry-run) ;;
    presets)
      parameters=$(many 10000 '"p%d": {"type": "int", "default": %d}')
      more=", \"presets\": {$(many 10000 '"s%d": {"set": {"p%d": 2}}')}"
      ;;
    maps) nodes=$(many 30000 '"n%d": {"type": "load_map", "path": "exemplar-png/base_color.png"}') ;;
    loops)
      parameters=$(many 5000 '"p%d": {"type": "int", "default": %d}')
      nodes='"n": {"type": "noise", "size": 16, "foreach": {"values": "1..10000"}, "seed": "$item"}, "m": {"type": "merge", "foreach": {"values": "1..10000"}, "materials": "@n"}'
      ;;
    chain)
      parameters=$(many 5000 '"p%d": {"type": "path", "default": "exemplar-png/base_color.png"}')
      nodes="$(many 5000 '"n%d": {"type": "load_map", "path": "$p%d"}'), \"m1\": {\"type\": \"blend\", \"a\": \"@n1\", \"b\": \"@n1\"}, "
      nodes+=$(awk 'BEGIN { for (i = 2; i <= 5000; i++) printf "%s\"m%d\": {\"type\": \"blend\", \"a\": \"@m%d\", \"b\": \"@n%d\"}", (i > 2 ? "," : ""), i, i - 1, i }')
      ;;
    settings)
      nodes="$(many 20000 '"n%d": {"type": "noise", "size": 16}')"
      echo "{$(many 20000 '"n%d.seed": %d')}" >settings.json
      words+=(--params settings.json)
      ;;
    equal) words=(run big.json --dry-run --sweep "n.seed=$(many 9000 7)") ;;
  esac
  echo "{\"terrazzo\": 1, \"parameters\": {$parameters}, \"nodes\": {$nodes}$more}" >big.json
  in_bounds "${words[@]}"
  [ "$kind" != texts ] || grep -q "longer than 1 MiB" said || complain "texts that double one another are not bounded"
  [ "$kind" != values ] || grep -q "more than 10000 variations" said || complain "a sweep of so many values is not refused"
}

library() {
  [ -f slow_sync.so ] || "${CC:-cc}" -shared -fPIC -O1 -o slow_sync.so "$source/tests/slow_sync.c" 2>said ||
    { complain "there is no C compiler, or it fails"; return; }
  rm -rf library
  local first=saved.analysis second=other.analysis waiting=() adding added=0
  one_of same other
  [ "$choice" = same ] || { first=other.analysis; second=saved.analysis; }
  "$program" library add wall "$first" --library library >said 2>&1 || complain "nothing could be added"
  # One of them brings what the other replaces.
  for adding in "$first" "$second"; do
    LD_PRELOAD=$scratch/slow_sync.so "$program" library add wall "$adding" --library library --force >"said-$adding" 2>&1 &
    waiting+=($!)
    below 100
    sleep "0.$(printf %03d "$number")"
  done
  for adding in "${waiting[@]}"; do wait "$adding" && added=$((added + 1)); done
  cat said-*.analysis >said
  [ "$added" = 2 ] || complain "one of two could not be added"
  "$program" library check --library library >said 2>&1 || complain "the entry is neither of the two"
}

frozen() {
  rm -rf farm-cache farm-out
  cp -r farm-clean farm-cache
  local files
  mapfile -t files < <(find farm-cache/farm/jobs farm-cache/farm/inputs -type f | sort)
  one_of "${files[@]}"
  local file=$choice
  one_of damage damage lose
  if [ "$choice" = lose ]; then rm "$file"; else damage "$file"; fi
  code=0
  timeout -k 5 $longest "$program" task "$job" "${units[@]}" >said 2>&1 || code=$?
  judge farm-out clean "$file: "
  [ "$code" -eq 0 ] || grep -q "submit the same again" said ||
    complain "$file: it is not said what mends it"
  rm -rf farm-out
  submit_to farm-cache || complain "$file: the job could not be submitted again"
  code=0
  timeout -k 5 $longest "$program" task "$job" "${units[@]}" >said 2>&1 || code=$?
  [ "$code" -eq 0 ] && diff -r farm-out clean >/dev/null || complain "$file: submitting again does not mend it"
}

submit_to() {
  "$program" submit walls.json --set out=farm-out --openjd template.json --cache "$1" >said 2>&1
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

"$program" pack walls.json -o walls.tzpack >said 2>&1 && "$program" run walls.tzpack --cache first --set out=out --progress none \
  >said 2>&1 || { complain "no pack could be made"; exit 1; }
"$program" run "$source/graphs/analyse.json" --set material=exemplar-png --set weighted.weights.height=2 \
  --set out=other.analysis --cache first --progress none >said 2>&1 || { complain "another analysis failed"; exit 1; }
submit_to farm-clean || { complain "nothing could be submitted"; exit 1; }
job=$(echo farm-clean/farm/jobs/*)
mapfile -t units < <("$program" task "$job" --list | python3 -c 'import json, sys
for unit in json.load(sys.stdin)["units"]: print(unit["name"])')
job=${job/farm-clean/farm-cache}

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
