#!/usr/bin/env bash
# Opens reports from the file system in headless Chromium: nothing goes wrong in their scripts, nothing is wider than
# the window, the material is lit, and without WebGL the page says so. The pages tell by data attributes of their body
# (runner/report/page/page.js). Exit code 77, a skipped test, if there is no Chromium.
# Usage: tests/page_test.sh SOURCE_FOLDER PROGRAM
set -euo pipefail
source=$(realpath "${1:?usage: page_test.sh SOURCE_FOLDER PROGRAM}")
program=$(realpath "${2:?usage: page_test.sh SOURCE_FOLDER PROGRAM}")
browser=$(command -v chromium || command -v chromium-browser || command -v google-chrome || true)
if [ -z "$browser" ]; then
  echo "skipped: there is no Chromium (apt-get install chromium)"
  exit 77
fi
scratch=$(mktemp -d "${TMPDIR:-/tmp}/terrazzo-page.XXXXXX")
trap 'rm -rf "$scratch"' EXIT
export TERRAZZO_CACHE=$scratch/cache
cd "$scratch"
failed=0

complain() {
  echo "$1" >&2
  failed=1
}

# A browser that hangs is tried again once.
browse() {
  timeout -k 5 60 "$browser" --headless=new --no-sandbox --disable-breakpad --use-gl=angle --use-angle=swiftshader \
    --enable-unsafe-swiftshader --virtual-time-budget=8000 --user-data-dir="$scratch/profile" --enable-logging=stderr \
    "$@" >dom 2>log
}

# open PAGE WIDTH [OPTION...]: what the page says of itself in `body`, and messages of the console in `console`.
open() {
  local page=$1 width=$2
  shift 2
  local options=(--window-size="$width,900" "$@" --dump-dom "file://$PWD/$page")
  browse "${options[@]}" || browse "${options[@]}" || complain "$page: the browser failed"
  body=$(grep -o '<body[^>]*>' dom || true)
  console=$(grep ':CONSOLE' log | grep -v 'GL Driver Message (OpenGL, Performance' || true)
}

# says NAME VALUE: the page's data attribute has that value.
says() {
  [[ $body == *"data-$1=\"$2\""* ]] || complain "$page at $width: expected data-$1=\"$2\", found $body"
}

"$program" run "$source/graphs/generate-exemplar.json" --set type=bricks --set size=64x64 --set out=bricks --progress none
"$program" synth bricks -o out --size 96x96 --quality draft --report run.html --progress none
"$program" compare bricks out --sheet compare.html >compared
"$program" run "$source/graphs/generate-exemplar.json" --set type=gravel --set size=32x32 --sweep seed=1..12 \
  --set "out=='sweep/' + seed" --sheet sweep.html --progress none >swept

"$program" run "$source/graphs/generate-exemplar.json" --set type=gravel --set size=16x16 --sweep seed=1..80 \
  --set "out=='many/' + seed" --report many.html --progress none >swept

for page in run.html compare.html sweep.html many.html; do
  for width in 1400 800; do
    open "$page" "$width"
    says ready yes
    says errors ""
    says overflow 0
    [ -z "$console" ] || complain "$page at $width: $console"
    [[ $page != run.html && $page != many.html ]] || says lit yes
  done
done

page=run.html width=1400
open "$page" "$width"
brightness=$(sed -nE 's/.*data-brightness="([0-9]+).*/\1/p' <<<"$body")
[ "${brightness:-0}" -gt 30 ] || complain "the lit material is dark: $body"

# A click on a node shows its parameters, a click on a picture enlarges it, a click on a head sorts.
sed 's#</body>#<script>document.querySelector("g.node[data-node=\\"7\\"]").dispatchEvent(new MouseEvent("click", {bubbles: true}));document.querySelector("img.picture").click();document.querySelector(".stages th").click()</script></body>#' \
  run.html >clicked.html
open clicked.html "$width"
says errors ""
grep -q '<h3>layout (synthesize)</h3>' dom || complain "a click on a node does not show it"
grep -q '<dialog' dom || complain "a click on a picture does not enlarge it"
grep -q 'data-order="up"' dom || complain "a click on a head does not sort"

# Many variations fold: the page stays short, and a search opens what it finds.
sed 's#</body>#<script>document.body.dataset.height = document.documentElement.scrollHeight; const field = document.querySelector("input[type=search]"); field.value = "seed=77"; field.dispatchEvent(new Event("input")); document.body.dataset.open = [...document.querySelectorAll("details[open]")].filter((d) => d.querySelector(".stages")).length</script></body>#' \
  many.html >searched.html
page=searched.html
open "$page" "$width"
says errors ""
says open 1
height=$(sed -nE 's/.*data-height="([0-9]+).*/\1/p' <<<"$body")
[ "${height:-99999}" -lt 8000 ] || complain "the report of 80 variations is $height pixels tall"
[[ $body == *'data-found="'[1-9]* ]] || complain "a search finds nothing: $body"
page=run.html

open "$page" "$width" --disable-gpu --disable-3d-apis
says ready yes
says errors ""
says lit no
grep -q 'this browser has no WebGL' dom || complain "without WebGL the page does not say why it shows a still picture"

exit $failed
