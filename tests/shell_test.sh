#!/usr/bin/env bash
# Completions and manual pages, which are made from the commands: bash completes, zsh and fish take their scripts, and groff
# has no complaint, where these are there.
# Usage: tests/shell_test.sh PROGRAM
set -euo pipefail
program=$(realpath "${1:?usage: shell_test.sh PROGRAM}")
scratch=$(mktemp -d "${TMPDIR:-/tmp}/terrazzo-shell.XXXXXX")
trap 'rm -rf "$scratch"' EXIT
cd "$scratch"
failed=0

complain() {
  echo "$1" >&2
  failed=1
}

"$program" completion bash >completion.bash
source completion.bash
touch wall.json 'white wall.json'
# completes EXPECTED WORD...: what the last word becomes.
completes() {
  local expected=$1
  shift
  COMP_WORDS=(terrazzo "$@")
  COMP_CWORD=$#
  _terrazzo
  [ "$(printf '%s\n' "${COMPREPLY[@]}")" = "$(printf -- "$expected")" ] ||
    complain "terrazzo $*: expected \"$expected\", found \"${COMPREPLY[*]}\""
}
completes 'run' ru
completes 'status' cache st
completes '--progress' run --prog
completes 'json' run --progress js
completes 'plain' run wall.json --progress pl
completes 'wall.json' run wa
completes 'white wall.json' run wh
completes 'wall.json' run --params wa
completes '' run --memory wa
completes 'verify' cache ver
completes 'stock:inpaint' run stock:inp
completes 'stock:inpaint' draw stock:inp
completes 'make_tileable' new --like make_t
completes 'delight' nodes deli
completes 'best' synth wall --quality b
# As bash splits words, at colons.
completes 'inpaint' run stock : inp
completes 'magnify\nmake_tileable\nmasked\nmaterial\nmix' run stock : m
[ "$(COMP_WORDS=(terrazzo run stock :) COMP_CWORD=3; _terrazzo; echo "${#COMPREPLY[@]}")" -gt 10 ] || complain "stock: completes to little"
# And at =.
completes 'normal=dxt5nm' synth wall --interpret normal=dx
completes 'dxt5nm' synth wall --interpret normal = dx
completes 'xy\ndxt5nm\nas_stored' synth wall --interpret normal =
completes 'auto' synth wall --method = au
completes 'wall.json' check wall.json

for shell in zsh fish; do
  "$program" completion $shell >completion.$shell
  if command -v $shell >/dev/null; then
    $shell -n completion.$shell || complain "$shell does not take its script"
  else
    echo "$shell is not installed: its script was not read by it"
  fi
done
grep -q "stock:inpaint" completion.fish || complain "fish gets no stock graphs"
grep -q 'stock\\:inpaint' completion.zsh || complain "zsh gets no stock graphs"
if command -v fish >/dev/null; then
  [ "$(fish -c 'source completion.fish; complete -C "terrazzo run stock:inp"')" = stock:inpaint ] || complain "fish completes no stock graph"
fi
grep -q -- "-l progress -x -a 'auto bar plain json none'" completion.fish || complain "fish gets no choices"
status=0
"$program" completion tcsh >said 2>&1 || status=$?
[ $status = 2 ] || complain "an unknown shell ended with $status"

for page in "" run "cache gc" synth completion; do
  "$program" man $page >page.1
  grep -q '^\.SH SYNOPSIS' page.1 || complain "the page on \"$page\" has no synopsis"
  if command -v groff >/dev/null; then
    groff -man -Tutf8 -ww -z page.1 2>said
    [ ! -s said ] || complain "groff on the page of \"$page\": $(cat said)"
  fi
done
"$program" man run >page.1
grep -q 'fB\\-\\-progress' page.1 || complain "the page on run lacks an option"
exit $failed
