#!/usr/bin/env bash
# Opens reports from the file system in headless Chromium: nothing goes wrong in their scripts, nothing is wider than
# the window, the material is lit, and without WebGL the page says so. The pages tell by data attributes of their body
# (runner/report/page/page.js). Exit code 77, a skipped test, if there is no Chromium or no Node.js.
# Usage: tests/page_test.sh SOURCE_FOLDER PROGRAM
set -euo pipefail
source=$(realpath "${1:?usage: page_test.sh SOURCE_FOLDER PROGRAM}")
program=$(realpath "${2:?usage: page_test.sh SOURCE_FOLDER PROGRAM}")
browser=$(command -v chromium || command -v chromium-browser || command -v google-chrome || true)
if [ -z "$browser" ] || ! command -v node >/dev/null; then
  echo "skipped: there is no Chromium, or no Node.js to drive it (apt-get install chromium nodejs)"
  exit 77
fi
scratch=$(mktemp -d "${TMPDIR:-/tmp}/terrazzo-page.XXXXXX")
trap 'rm -rf "$scratch"' EXIT
export TERRAZZO_CACHE=$scratch/cache
cd "$scratch"

"$program" run "$source/graphs/generate-exemplar.json" --set type=bricks --set size=64x64 --set out=bricks --progress none
"$program" synth bricks -o out --size 96x96 --quality draft --report run.html --progress none
"$program" compare bricks out --sheet compare.html >compared
"$program" run "$source/graphs/generate-exemplar.json" --set type=gravel --set size=32x32 --sweep seed=1..12 \
  --set "out=='sweep/' + seed" --sheet sweep.html --progress none >swept

"$program" run "$source/graphs/generate-exemplar.json" --set type=gravel --set size=16x16 --sweep seed=1..80 \
  --set "out=='many/' + seed" --report many.html --progress none >swept

cat >test.mjs <<JS
import { Browser, Checks } from '$source/tests/readers/browser.mjs';
JS
cat >>test.mjs <<'JS'
const browser = await Browser.start(process.argv[2]), checks = new Checks();

// Opens a page and returns what it says of itself once it is ready, and lit if it has a material.
async function open(page, width, before = '') {
  checks.about(`${page} at ${width}`);
  await browser.open(`file://${process.cwd()}/${page}`, {
    width, before,
    until: `document.body.dataset.errors ||
      document.body.dataset.ready && (document.body.dataset.lit || !document.getElementById('viewer'))`,
  });
  const told = {...await browser.evaluate('({...document.body.dataset})'), console: browser.console};
  checks.equal(told, {ready: 'yes', errors: '', overflow: '0'});
  return told;
}

for (const page of ['compare.html', 'sweep.html'])
  for (const width of [1400, 800]) checks.equal(await open(page, width), {console: ''});

checks.equal(await open('run.html', 800), {lit: 'yes', console: ''});
checks.equal(await open('run.html', 1400, `
  const Plain = Image;
  globalThis.textures = [];
  globalThis.Image = function() {
    const image = new Plain();
    textures.push(new Promise(done => image.addEventListener('load', done)));
    return image;
  };`), {lit: 'yes', console: ''});
// Drawn once more after all textures are there.
const lit = await browser.evaluate(`Promise.all(textures).then(async () => {
  for (let frame = 0; frame < 2; frame++) await new Promise(requestAnimationFrame);
  return {textures: textures.length, brightness: document.body.dataset.brightness};
})`);
checks.holds(lit.textures >= 4, `the lit material has ${lit.textures} textures`);
checks.holds(lit.brightness > 30, `the lit material is dark: ${lit.brightness}`);

// A click on a node shows its parameters, a click on a picture enlarges it, a click on a head sorts.
const clicked = await browser.evaluate(`(() => {
  document.querySelector('g.node[data-node="7"]').dispatchEvent(new MouseEvent('click', {bubbles: true}));
  document.querySelector('img.picture').click();
  document.querySelector('.stages th').click();
  return {node: document.querySelector('#node h3')?.textContent, enlarged: !!document.querySelector('dialog[open]'),
          sorted: !!document.querySelector('[data-order=up]'), errors: document.body.dataset.errors};
})()`);
checks.equal(clicked, {node: 'layout (synthesize)', enlarged: true, sorted: true, errors: ''});

// Many variations fold: the page stays short, and a search opens what it finds.
checks.equal(await open('many.html', 1400), {lit: 'yes', console: ''});
const searched = await browser.evaluate(`(() => {
  const height = document.documentElement.scrollHeight, field = document.querySelector('input[type=search]');
  field.value = 'seed=77';
  field.dispatchEvent(new Event('input'));
  const open = [...document.querySelectorAll('details[open]')].filter(d => d.querySelector('.stages')).length;
  return {height, open, found: document.body.dataset.found, errors: document.body.dataset.errors};
})()`);
checks.equal(searched, {open: 1, errors: ''});
checks.holds(searched.height < 8000, `the report of 80 variations is ${searched.height} pixels tall`);
checks.holds(parseInt(searched.found) > 0, `a search finds "${searched.found}"`);

checks.equal(await open('many.html', 800, `
  const plain = HTMLCanvasElement.prototype.getContext;
  HTMLCanvasElement.prototype.getContext = function(kind, ...more) {
    return kind.startsWith('webgl') ? null : plain.call(this, kind, ...more);
  };`), {lit: 'no'});
const line = await browser.evaluate(`document.getElementById('viewer-state').textContent`);
checks.holds(line.includes('this browser has no WebGL'), `without WebGL the page says "${line}"`);

browser.close();
process.exit(checks.failed ? 1 : 0);
JS
node test.mjs "$browser"
