#!/usr/bin/env bash
# A set of maps whose writer is killed between two renames has no description, so that readers can tell, and the next run
# makes it whole: torn_set_test.sh PROGRAM. Exit code 77, skipped, without strace, which kills at a given call.
set -uo pipefail
program=$(realpath "$1")
strace -o /dev/null true 2>/dev/null || { echo "skipped: there is no strace that works here"; exit 77; }
scratch=$(mktemp -d "${TMPDIR:-/tmp}/terrazzo-torn.XXXXXX")
trap 'rm -rf "$scratch"' EXIT
cd "$scratch" || exit 1
export TERRAZZO_CACHE=$scratch/cache
failed=0
complain() { echo "error: $1"; failed=1; }
cat >set.json <<'JSON'
{"terrazzo": 1, "parameters": {"seed": {"type": "int"}}, "nodes": {
  "surface": {"type": "pattern", "kind": "tiles", "size": 32, "seed": "$seed"},
  "files": {"type": "export_preset", "material": "@surface", "preset": "gltf", "path": "out"}}}
JSON
write() { "$program" run set.json --set seed="$1" --progress none; }
descriptions() { find out -name '[!.]*.gltf' -o -name '[!.]*.json' | wc -l; }
write 0 || complain "the first run failed"
maps=$(find out -name '[!.]*.png' | wc -l) all=$(descriptions)
[ "$maps" -gt 2 ] && [ "$all" -eq 2 ] || complain "expected maps and two descriptions, found $(ls out)"
for k in $(seq "$maps"); do
  # Without a cache, all that is renamed is the set's.
  { strace -f -o /dev/null -e trace=rename -e inject=rename:signal=KILL:when="$k" \
    "$program" run set.json --set seed="$k" --no-cache --progress none; } 2>/dev/null && complain "nothing was killed"
  [ "$(descriptions)" -eq 0 ] || complain "a torn set is described: $(ls out)"
  write "$k" || complain "the run after a kill failed"
  [ "$(descriptions)" -eq "$all" ] || complain "the next run leaves out a description: $(ls out)"
  cp -r out "again$k"; rm -rf out; write "$k"
  diff -r out "again$k" || complain "the next run does not make the set whole"
done
exit $failed
