#!/usr/bin/env bash
# Makes the guide's pictures of the graph editor, and a recording: pictures/editor-*.webp. Needs a build, Chromium, npm
# with its registry, and Debian's package webp.
# Usage: examples/guide/editor_pictures.sh [PROGRAM]
set -euo pipefail
cd "$(dirname "$0")"
here=$PWD
program=$(realpath "${1:-../../build/terrazzo}")
browser=$(command -v chromium || command -v chromium-browser || command -v google-chrome) ||
  { echo "there is no Chromium (apt-get install chromium)" >&2; exit 1; }
command -v img2webp >/dev/null || { echo "there is no img2webp (apt-get install webp)" >&2; exit 1; }
scratch=$(mktemp -d "${TMPDIR:-/tmp}/terrazzo-editor-pictures.XXXXXX")
trap 'rm -rf "$scratch"' EXIT
cd "$scratch"
cp "$here"/../../tests/editor/package.json "$here"/../../tests/editor/package-lock.json .
npm ci --silent --no-audit --no-fund
"$program" run "$here/../../graphs/generate-exemplar.json" --set type=cobbles --set size=512x512 --set out="$scratch/cobbles" \
  --progress none
"$program" new cobbles -o wall.json
# The material that the editor shows, lit, for the picture of both.
cat >lit.json <<'END'
{"terrazzo": 1, "nodes": {
  "wall": {"type": "load_material", "path": "out"},
  "lit": {"type": "preview", "material": "@wall", "size": 1024},
  "file": {"type": "export", "material": "@lit", "path": "result.png"}}}
END
"$program" run wall.json --progress none
"$program" run lit.json --progress none
node "$here/editor_pictures.mjs" "$program" "$browser"
for picture in dark light result; do
  cwebp -quiet -q 86 -m 6 "editor-$picture.png" -o "$here/pictures/editor-$picture.webp"
done
# frames.txt: for each frame "-d MILLISECONDS FILE".
xargs -a frames.txt img2webp -loop 0 -lossy -q 55 -m 5 -o "$here/pictures/editor.webp" >/dev/null
ls -l "$here"/pictures/editor*.webp
