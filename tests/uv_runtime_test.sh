#!/usr/bin/env bash
# Makes the page of examples/uv-runtime for a small material and opens it in headless Chromium: at 1:1 the picture sampled
# through the uv map is the resolved one, magnified it differs at seams only, and further away by little; with the
# derivatives of the uv map's values, the well-known mistake, by much. The page measures, and tells by data attributes of
# its body (examples/uv-runtime/page.js). Exit code 77, a skipped test, if there is no Chromium or no Node.js.
# Usage: tests/uv_runtime_test.sh SOURCE_FOLDER PROGRAM
set -euo pipefail
source=$(realpath "${1:?usage: uv_runtime_test.sh SOURCE_FOLDER PROGRAM}")
program=$(realpath "${2:?usage: uv_runtime_test.sh SOURCE_FOLDER PROGRAM}")
browser=$(command -v chromium || command -v chromium-browser || command -v google-chrome || true)
scratch=$(mktemp -d "${TMPDIR:-/tmp}/terrazzo-uv-runtime-test.XXXXXX")
trap 'rm -rf "$scratch"' EXIT
export TERRAZZO_CACHE=$scratch/cache
cd "$scratch"

# The page in the repository has the code as it stands; the embedded maps may be older.
"$program" run "$source/graphs/generate-exemplar.json" --set type=gravel --set size=128x128 --set out=gravel --progress none
OUT=made SIZE=512x512 QUALITY=draft TERRAZZO=$program "$source/examples/uv-runtime/make.sh" gravel >told
code() { grep -vE '^(<img hidden data-map=|<script type="text/plain" id="uv-file">)' "$1"; }
if ! cmp -s <(code made/uv-runtime.html) <(code "$source/examples/uv-runtime/uv-runtime.html"); then
  echo "examples/uv-runtime/uv-runtime.html is older than its template or code: run examples/uv-runtime/make.sh" >&2
  exit 1
fi

if [ -z "$browser" ] || ! command -v node >/dev/null; then
  echo "skipped: there is no Chromium, or no Node.js to drive it (apt-get install chromium nodejs)"
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

cat >test.mjs <<JS
import { Browser, Checks } from '$source/tests/readers/browser.mjs';
JS
cat >>test.mjs <<'JS'
const browser = await Browser.start(process.argv[2]), checks = new Checks(), figures = 'figures=1&pane=128&';
const open = (search, width) =>
  browser.open(`file://${process.cwd()}/page.html?${figures}${search}`, {width, until: 'document.body.dataset.ready'});

// What the page says of itself.
async function told() {
  const data = await browser.evaluate('({...document.body.dataset})');
  checks.equal({...data, console: browser.console}, {ready: 'yes', errors: '', glError: 0, overflow: 0, console: ''});
  return data;
}

// Of another view, on the same page.
async function look(search) {
  checks.about(search);
  await browser.evaluate(`look('${figures}${search}')`);
  return told();
}

// The figures are below the bounds.
function below(data, bounds) {
  for (const [name, bound] of Object.entries(bounds))
    checks.holds(data[name] !== '' && data[name] < bound, `expected ${name} < ${bound}, found ${data[name]}`);
}

// A phone's width, then a screen's.
checks.about('zoom=1 at 400');
await open('zoom=1', 400);
await told();
await open('zoom=0.5&map=normal&tilt=0');
const opened = await told(), looked = await look('zoom=0.5&map=normal&tilt=0');
for (const name of ['mean', 'most', 'changeRuntime', 'meanRuntime']) checks.equal(looked, {[name]: opened[name]});

for (const map of ['base_color', 'normal', 'roughness', 'lit']) {
  const data = await look(`zoom=1&map=${map}`);
  below(data, {most: 1.5});
  checks.equal(data, {resolvedUnequal: 0});
}

// Magnified: the same inside pieces; across seams within a texel, by less than what meets there.
for (const map of ['base_color', 'normal']) {
  const data = await look(`zoom=5.3&map=${map}`);
  below(data, {mostInside: 1.5, mean: 0.5});
  checks.holds(data.shareInside > 0.5, `only ${data.shareInside} of the pixels lie inside pieces`);
  checks.equal(data, {mostPacked: 0});
}

// Further away. Bounds are about a fifth above what was measured; change: what half a pixel's motion changes, for shimmering.
for (const [mean, most, search] of [
  [0.7, 70, 'zoom=0.5'], [1.2, 40, 'zoom=0.35'], [1.45, 76, 'zoom=0.25'], [1.55, 80, 'zoom=0.25&map=normal'],
  [0.16, 2, 'zoom=0.1'], [0.76, 40, 'zoom=0.7&tilt=65'], [1, 40, 'zoom=0.7&tilt=65&probes=8'],
]) {
  const data = await look(search);
  below(data, {mean, most, changeRuntime: 1.1 * data.changeResolved});
  checks.equal(data, {mostPacked: 0});
}

// The mistake shows where the rest does not: at 1:1, at half the size, and at an angle.
for (const search of ['zoom=1', 'zoom=0.5', 'zoom=0.7&tilt=65']) {
  const {mean, most} = await look(`${search}&wrong=1`);
  checks.holds(mean > 1 && most > 60, `the mistake does not show: it changes ${mean} on average, ${most} at most`);
}

browser.close();
process.exit(checks.failed ? 1 : 0);
JS
node test.mjs "$browser"
