#!/usr/bin/env bash
# What README.md, examples/guide and tests/bench say is true: every ```sh block runs, every link leads somewhere, every room
# is listed. Blocks that have placeholders, build, or take long are marked ```text and do not run.
# Usage: tests/guide_test.sh SOURCE_FOLDER PROGRAM
set -euo pipefail
source=$(realpath "${1:?usage: guide_test.sh SOURCE_FOLDER PROGRAM}")
program=$(realpath "${2:?usage: guide_test.sh SOURCE_FOLDER PROGRAM}")
scratch=$(mktemp -d "${TMPDIR:-/tmp}/terrazzo-guide.XXXXXX")
trap 'rm -rf "$scratch"' EXIT
export TERRAZZO_CACHE=$scratch/cache TERRAZZO_LIBRARY=$scratch/library
failed=0

complain() {
  echo "$1" >&2
  failed=1
}

cd "$source"
pages=(README.md $(find examples/guide tests/bench -name '*.md' | sort))

# blocks PAGE FOLDER: writes each ```sh block to FOLDER/<line of the page>.
blocks() {
  awk -v folder="$2" '
    /^```/ { if (file) { close(file); file = "" } else if (open) open = 0
             else { open = 1; if ($0 == "```sh") { open = 0; file = sprintf("%s/%05d", folder, NR) } } next }
    file { print > file }' "$1"
}

for page in "${pages[@]}"; do
  tree=$scratch/tree
  rm -rf "$tree"
  mkdir -p "$tree/build" "$scratch/blocks"
  cp -r graphs examples "$tree"
  ln -s "$program" "$tree/build/terrazzo"
  rm -f "$scratch"/blocks/*
  blocks "$page" "$scratch/blocks"
  for block in "$scratch"/blocks/*; do
    [ -e "$block" ] || continue
    (cd "$tree" && bash -euo pipefail "$block") >"$scratch/said" 2>&1 ||
      complain "$page, the block from line $((10#$(basename "$block"))) on failed:
$(cat "$block")
$(tail -20 "$scratch/said")"
  done
done

# anchors PAGE: the names by which its headings can be linked to.
anchors() {
  sed -nE '/^```/,/^```/d; s/^#+ //p' "$1" | tr '[:upper:]' '[:lower:]' | sed -E 's/[^a-z0-9 _-]//g; s/ /-/g'
}

# check_link FROM TARGET: TARGET is relative to the folder of FROM.
check_link() {
  local file=${2%%#*} anchor=
  [[ $2 != *#* ]] || anchor=${2#*#}
  file=${file:+$(dirname "$1")/$file}
  file=${file:-$1}
  [ -e "$file" ] || { complain "$1 links to $2, which does not exist"; return; }
  [ -z "$anchor" ] || anchors "$file" | grep -xF -- "$anchor" >/dev/null || complain "$1 links to $2, which has no such heading"
}

for page in "${pages[@]}"; do
  while read -r target; do check_link "$page" "$target"; done < <(
    grep -oE '\]\([^) ]+\)' "$page" | sed -E 's/^\]\((.*)\)$/\1/' | grep -vE '^[a-z]+:' || true)
done

# Constants cite the experiment that they come from.
while IFS=: read -r file target; do
  anchors tests/bench/experiments.md | grep -xF -- "${target#*#}" >/dev/null ||
    complain "$file cites $target, which has no such heading"
done < <(grep -roE 'experiments\.md#[a-z0-9-]+' --include='*.h' --include='*.cpp' core nodes graphs runner || true)

# Fields of descriptors and rows have the names that the page on adding them gives.
while read -r field; do
  grep -qw -- "$field" core/node/node.h core/synthesis/steps.h ||
    complain "examples/guide/adding-a-node.md lists the field $field, which neither node.h nor steps.h has"
done < <(grep -E '^\| `' examples/guide/adding-a-node.md | cut -d'|' -f2 | grep -oE '[a-z_]+')

while IFS=$'\t' read -r room _; do
  grep -qF "\`$room\`" README.md || complain "README.md does not list the room $room of tests/rooms.txt"
done < <(cat tests/rooms.txt)

exit $failed
