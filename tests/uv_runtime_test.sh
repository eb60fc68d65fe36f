#!/usr/bin/env bash
# Makes the page of examples/uv-runtime for a small material and opens it in headless Chromium: at 1:1 the picture sampled
# through the uv map is the resolved one, magnified it differs at seams only, and further away by little; with the
# derivatives of the uv map's values, the well-known mistake, by much. The page measures, and tells by data attributes of
# its body (examples/uv-runtime/page.js). Exit code 77, a skipped test, if there is no Chromium.
# Usage: tests/uv_runtime_test.sh SOURCE_FOLDER PROGRAM
set -euo pipefail
source=$(realpath "${1:?usage: uv_runtime_test.sh SOURCE_FOLDER PROGRAM}")
program=$(realpath "${2:?usage: uv_runtime_test.sh SOURCE_FOLDER PROGRAM}")
browser=$(command -v chromium || command -v chromium-browser || command -v google-chrome || true)
scratch=$(mktemp -d "${TMPDIR:-/tmp}/terrazzo-uv-runtime-test.XXXXXX")
trap 'rm -rf "$scratch"' EXIT
export TERRAZZO_CACHE=$scratch/cache
cd "$scratch"
failed=0

complain() {
  echo "$1" >&2
  failed=1
}

# The page in the repository has the code as it stands; the embedded maps may be older.
"$program" run "$source/graphs/generate-exemplar.json" --set type=gravel --set size=128x128 --set out=gravel --progress none
OUT=made SIZE=512x512 QUALITY=draft TERRAZZO=$program "$source/examples/uv-runtime/make.sh" gravel >told
code() { grep -vE '^(<img hidden data-map=|<script type="text/plain" id="uv-file">)' "$1"; }
cmp -s <(code made/uv-runtime.html) <(code "$source/examples/uv-runtime/uv-runtime.html") ||
  complain "examples/uv-runtime/uv-runtime.html is older than its template or code: run examples/uv-runtime/make.sh"

if [ -z "$browser" ]; then
  [ $failed = 0 ] || exit 1
  echo "skipped: there is no Chromium (apt-get install chromium)"
  exit 77
fi

# The page compares the maps that it resolves with those that terrazzo resolved.
{
  for map in made/resolved/*.png; do
    printf '<img hidden data-resolved="%s" src="data:image/png;base64,%s">\n' "$(basename "$map" .png)" "$(base64 -w0 "$map")"
  done
} >resolved
sed '/^<img hidden data-map/{
  r resolved
  :rest
  n
  b rest
}' made/uv-runtime.html >page.html

# A browser that hangs is tried again once.
browse() {
  timeout -k 5 120 "$browser" --headless=new --no-sandbox --disable-breakpad --use-gl=angle --use-angle=swiftshader \
    --enable-unsafe-swiftshader --virtual-time-budget=8000 --user-data-dir="$scratch/profile" --enable-logging=stderr \
    "$@" >dom 2>log
}

# open QUERY [WIDTH]: what the page says of itself in `body`.
open() {
  view=$1
  local options=(--window-size="${2:-1000},900" --dump-dom "file://$PWD/page.html?figures=1&pane=128&$view")
  browse "${options[@]}" || browse "${options[@]}" || complain "$view: the browser failed"
  body=$(grep -o '<body[^>]*>' dom || true)
  says ready yes
  says errors ""
  says gl-error 0
  says overflow 0
  ! grep ':CONSOLE' log | grep -v 'GL Driver Message (OpenGL, Performance' >&2 || complain "$view: messages in the console"
}

says() {
  [[ $body == *"data-$1=\"$2\""* ]] || complain "$view: expected data-$1=\"$2\", found $body"
}

figure() { sed -nE "s/.* data-$1=\"([-0-9.]+)\".*/\1/p" <<<"$body"; }

# holds NAME OPERATOR BOUND
holds() {
  local value
  value=$(figure "$1")
  [ -n "$value" ] && awk "BEGIN { exit !($value $2 $3) }" || complain "$view: expected $1 $2 $3, found ${value:-nothing}"
}

for map in base_color normal roughness lit; do
  open "zoom=1&map=$map"
  holds most '<=' 1
  says resolved-unequal 0
done

# Magnified: the same inside pieces; across seams within a texel, by less than what meets there.
for map in base_color normal; do
  open "zoom=5.3&map=$map"
  holds most-inside '<=' 1
  holds share-inside '>' 0.5
  holds mean '<' 0.5
  says most-packed 0
done

# Further away. Bounds are about a fifth above what was measured; change: what half a pixel's motion changes, for shimmering.
while read -r mean most query; do
  open "$query"
  holds mean '<' "$mean"
  holds most '<' "$most"
  holds change-runtime '<' "1.1 * $(figure change-resolved)"
  says most-packed 0
done <<'end'
0.95 70 zoom=0.5
1.35 40 zoom=0.35
1.8 60 zoom=0.25
2 80 zoom=0.25&map=normal
0.2 2 zoom=0.1
0.9 40 zoom=0.7&tilt=65
1.05 40 zoom=0.7&tilt=65&probes=8
end

# The mistake shows where the rest does not: at 1:1, at half the size, and at an angle.
for query in zoom=1 zoom=0.5 "zoom=0.7&tilt=65"; do
  open "$query&wrong=1"
  holds mean '>' 1
  holds most '>' 60
done

open "zoom=1" 400
exit $failed
