// Curves and levels by hand, values that two tabs change at once, what has no effect, graphs that begin.
import fs from 'node:fs';
import path from 'node:path';
import { assert, Editor, scenario } from './harness.mjs';

const shaped = JSON.stringify({
  terrazzo: 1,
  nodes: {
    stones: {type: 'pattern', kind: 'cobbles', size: 64, seed: 1},
    height: {type: 'get_map', material: '@stones', map: 'height'},
    shaped: {type: 'curve', image: '@height', points: [0, 0, 0.4, 0.2, 1, 1]},
    lifted: {type: 'levels', image: '@shaped'}},
}, null, 2);

const middle = async (place) => { const box = await place.boundingBox(); return {x: box.x + box.width / 2, y: box.y + box.height / 2}; };
const close = (a, b, within = 0.02) => Math.abs(a - b) <= within;

scenario('the points of a curve', async () => {
  const e = await Editor.open(shaped), {page} = e;
  await e.show('shaped');
  const knot = (index) => page.locator('.curve .knot').nth(index);
  await page.locator('.curve .counts').waitFor();
  // The curve is drawn as the node computes it: with two straight ends and slopes in between.
  const heightAt = (x) => page.locator('.curve .line').evaluate((line, at) => {
    const box = line.closest('svg').getBoundingClientRect(), points = line.getAttribute('d').match(/[\d.-]+,[\d.-]+/g).map((p) => p.split(',').map(Number));
    const wanted = 10 + at * (box.width - 20), i = points.findIndex((p) => p[0] >= wanted);
    return (box.height - 10 - points[i][1]) / (box.height - 20);
  }, x);
  assert(close(await heightAt(0.4), 0.2), `${await heightAt(0.4)} at a point`);
  // Fritsch and Butland's slope at 0.4 is 0.5 * 4/3 * 3 / (1.6 / 0.5 + 1.4 / (4 / 3)): worked out by hand.
  const slope = (1.6 + 1.4) / (1.6 / 0.5 + 1.4 / (0.8 / 0.6)), t = 0.5, w = 0.6;
  const expected = 0.2 * 0.5 + 1 * 0.5 + w * (slope * (t ** 3 - 2 * t * t + t) + 0.8 / 0.6 * (t ** 3 - t * t));
  assert(close(await heightAt(0.7), expected), `${await heightAt(0.7)} between, expected ${expected}`);
  // A slow drag is one step of undo.
  const start = await middle(knot(1)), to = {x: start.x + 60, y: start.y - 40};
  await page.mouse.move(start.x, start.y);
  await page.mouse.down();
  for (let step = 1; step <= 5; ++step) {
    await page.mouse.move(start.x + 12 * step, start.y - 8 * step);
    await page.waitForTimeout(step === 3 ? 1200 : 30);
  }
  await page.mouse.up();
  await e.saved(({nodes}) => nodes.shaped.points.length === 6 && close(nodes.shaped.points[2], 0.4 + 60 / 332, 0.05) && nodes.shaped.points[3] > 0.35, `the point is dragged to ${to.x}`);
  assert.match(e.text, /"points": \[/, 'a list as one writes it');
  await e.toCanvas();
  await e.press('Control+z');
  await e.saved(({nodes}) => nodes.shaped.points[2] === 0.4 && nodes.shaped.points[3] === 0.2, 'one step of undo');
  assert.equal(e.text, shaped);
  // By double click, by typing, and by key.
  const box = await page.locator('.curve svg').boundingBox();
  await page.mouse.dblclick(box.x + 10 + 0.75 * (box.width - 20), box.y + 10 + 0.25 * (box.height - 20));
  await e.saved(({nodes}) => nodes.shaped.points.length === 8 && close(nodes.shaped.points[4], 0.75) && close(nodes.shaped.points[5], 0.75), 'a point is added');
  await page.getByLabel('points, y of point 3').click();
  await e.press('Control+a');
  await e.type('0.9');
  await e.press('Enter');
  await e.saved(({nodes}) => nodes.shaped.points[5] === 0.9, 'its height is typed');
  await knot(0).focus();
  await e.press('Tab', 'Tab');
  assert.match(await page.evaluate(() => document.activeElement.getAttribute('aria-label')), /point 3 of 4/);
  await e.press('ArrowUp', 'Shift+ArrowLeft');
  await e.saved(({nodes}) => close(nodes.shaped.points[5], 0.91, 1e-6) && close(nodes.shaped.points[4], 0.65), 'arrows move it');
  await e.press('+');
  await e.saved(({nodes}) => nodes.shaped.points.length === 10, 'a key adds one behind it');
  await e.press('Delete', 'Delete');
  await e.saved(({nodes}) => nodes.shaped.points.length === 6, 'Delete removes them');
  assert.equal(await page.locator('.svelte-flow__node').count(), 4, 'and no node');
  // A point stays between its neighbours.
  await knot(1).focus();
  for (let i = 0; i < 12; ++i) await e.press('Shift+ArrowRight');
  await e.saved(({nodes: {shaped: {points}}}) => points[2] > 0.9 && points[2] < 1, 'it stops before the next');
  await e.accessible('a curve', ['wcag2a', 'wcag2aa']);
  // A list that is no points is shown as numbers.
  fs.writeFileSync(e.file, shaped.replace(/"points": \[[^\]]*\]/, '"points": [0, 0, 1]'));
  await page.getByLabel('points 3').waitFor();
  assert.equal(await page.locator('.curve').count(), 0);
});

scenario('levels on the histogram', async () => {
  const e = await Editor.open(shaped), {page} = e;
  await e.show('lifted');
  const handle = (name) => page.locator(`.levels [aria-label="${name}"]`);
  await page.locator('.levels .counts').waitFor();
  const drag = async (name, by) => { const at = await middle(handle(name)); await e.drag(at, {x: at.x + by, y: at.y}); };
  const width = (await page.locator('.levels svg').boundingBox()).width - 20;
  await drag('black point', 0.25 * width);
  await e.saved(({nodes}) => close(nodes.lifted.in_black[0], 0.25), 'the black point is dragged');
  await drag('white becomes', -0.25 * width);
  await e.saved(({nodes}) => close(nodes.lifted.out_white[0], 0.75), 'white becomes grey');
  // The middle of the range is dragged to where a quarter of it was.
  await drag('gamma', -0.1875 * width);
  await e.saved(({nodes}) => close(nodes.lifted.gamma[0], 2, 0.1), 'gamma follows the middle');
  await handle('white point').focus();
  await e.press('ArrowLeft', 'ArrowLeft');
  await e.saved(({nodes}) => close(nodes.lifted.in_white[0], 0.98, 1e-6), 'the white point by key');
  await page.waitForFunction(() => document.querySelector('[aria-label="in_white 1"]').value === '0.98');
  await page.getByLabel('in_white 1').click();
  await e.press('Control+a');
  await e.type('0.9');
  await e.press('Enter');
  await e.saved(({nodes}) => nodes.lifted.in_white[0] === 0.9, 'typed');
  await page.waitForFunction((e) => e.getAttribute('aria-valuenow') === '0.9', await handle('white point').elementHandle());
  await page.locator('#panel .field', {hasText: 'auto'}).locator('select').selectOption('image');
  await page.getByText('are found from the image').waitFor();
  assert.equal(await handle('black point').count(), 0);
});

scenario('two tabs change the same value at once', async () => {
  const e = await Editor.open(shaped), {page} = e;
  await e.show('stones');
  const other = await e.context.newPage(), pages = [page, other];
  try {
    await other.goto(new URL(page.url()).origin);
    await other.locator('.svelte-flow__node[data-id="stones"] .head').click();
    const seed = (p) => p.locator('#panel .field', {has: p.locator('label', {hasText: /^\s*seed\b/})});
    for (const [p, value] of [[page, '7'], [other, '8']]) await seed(p).locator('input.number').fill(value);
    // Both are under way before either tab hears of the other.
    await Promise.all(pages.map((p) => seed(p).locator('input.number').press('Enter')));
    const asked = (p) => seed(p).getByText('Changed elsewhere to');
    await Promise.any(pages.map((p) => asked(p).waitFor({timeout: 4000})));
    assert.equal((await Promise.all(pages.map((p) => asked(p).count()))).reduce((a, b) => a + b), 1, 'one of them is asked');
    const late = await asked(page).count() ? page : other, mine = late === page ? 7 : 8;
    assert.equal(e.json.nodes.stones.seed, 15 - mine, 'the first stands');
    await seed(late).getByText(`yours is ${mine}`).waitFor();
    await seed(late).getByRole('button', {name: 'keep yours'}).click();
    await e.saved(({nodes}) => nodes.stones.seed === mine, 'until the other is wanted');
    // Both are steps of undo.
    await page.bringToFront();
    await e.toCanvas();
    await e.press('Control+z');
    await e.saved(({nodes}) => nodes.stones.seed === 15 - mine, 'the first can be undone to');
    await e.press('Control+z');
    await e.saved(({nodes}) => nodes.stones.seed === 1, 'and what was before');
  } finally {
    await other.close();
  }
});

scenario('a graph that does not exist yet', async () => {
  const e = await Editor.open(null), {page} = e;
  await page.getByText('An empty graph').waitFor();
  await page.getByText('the first edit writes it').waitFor();
  assert(!fs.existsSync(e.file), 'nothing is written by opening');
  await e.press('Tab');
  await e.type('pattern');
  await e.press('Enter');
  await e.saved(({nodes}) => nodes.pattern.type === 'pattern', 'the first edit writes it');
  await page.locator('.saved', {hasText: /^saved$/}).waitFor();
});

scenario('what has no effect, and parameters that presets set', async () => {
  const inner = {parameters: {make: {type: 'choice', choices: ['larger', 'tileable'], default: 'tileable'}, scale: {type: 'number', default: 2, visible_if: "=make == 'larger'"}},
                 nodes: {grey: {type: 'solid', size: 16, value: '=[scale / 10]'}}, outputs: {image: '@grey'}};
  const e = await Editor.open(JSON.stringify({
    terrazzo: 1,
    parameters: {seed: {type: 'int', default: 1}, size: {type: 'int', default: 32}},
    presets: {late: {set: {seed: 7, size: 64}}, small: {set: {size: 16}}},
    nodes: {stones: {type: 'pattern', size: '$size'}, part: {type: 'inner'}},
    graphs: {inner}}, null, 2), {prepare: (folder) => fs.writeFileSync(path.join(folder, 'graph.presets.json'), JSON.stringify({beside: {set: {seed: 9}}}))});
  const {page} = e;
  await e.show('part');
  const field = (name) => page.locator('#panel .field', {has: page.locator('label', {hasText: new RegExp(`^\\s*${name}\\b`)})});
  await field('make').waitFor();
  assert.equal(await field('scale').count(), 0, 'a parameter of a graph without effect is not shown');
  await page.getByRole('button', {name: 'Show 1 that has no effect now'}).click();
  await field('scale').waitFor();
  await page.getByRole('button', {name: 'Hide 1 that'}).click();
  await field('make').locator('select').selectOption('larger');
  await field('scale').waitFor();
  // Tab goes from a choice to the button that shows only beside the focus, and on.
  const focused = () => page.evaluate(() => document.activeElement.ariaLabel ?? document.activeElement.tagName);
  await field('make').locator('select').focus();
  await e.press('Tab');
  assert.match(await focused(), /^fx, an expression for make/);
  await e.press('Tab');
  assert.doesNotMatch(await focused(), /BODY/);
  // Removing a parameter takes it out of the presets, in the same step.
  await e.toCanvas();
  await e.press('Escape');
  const before = e.text;
  await field('seed').locator('label').click({button: 'right'});
  await page.locator('.menu button', {hasText: 'Remove'}).click();
  await e.saved(({parameters, presets}) => !parameters.seed && !('seed' in presets.late.set) && presets.late.set.size === 64, 'presets follow');
  await e.toast('the preset "late" no longer sets "seed"');
  await e.toast('still sets seed: beside');
  await e.toCanvas();
  await e.press('Control+z');
  await e.saved(({presets}) => presets.late.set.seed === 7, 'and come back');
  assert.equal(e.text, before);
});

scenario('long chains, and wires that go back', async () => {
  const nodes = {stones: {type: 'pattern', size: 16}, height: {type: 'get_map', material: '@stones', map: 'height'}};
  for (let i = 0, last = 'height'; i < 26; ++i) { nodes[`blur${i}`] = {type: 'blur', image: '@' + last}; last = `blur${i}`; }
  const e = await Editor.open(JSON.stringify({terrazzo: 1, nodes}, null, 2), {args: ['--read-only']}), {page} = e;
  await e.press('f');
  await e.settle();
  const boxes = await page.locator('.svelte-flow__node').evaluateAll((all) => all.map((n) => (({x, y, width, height}) => ({x, y, width, height}))(n.getBoundingClientRect())));
  const rows = new Set(boxes.map((b) => b.x).sort((a, b) => a - b).slice(0, 1));
  const width = Math.max(...boxes.map((b) => b.x + b.width)) - [...rows][0], height = Math.max(...boxes.map((b) => b.y + b.height)) - Math.min(...boxes.map((b) => b.y));
  assert(width < 5 * height, `in rows: ${width} by ${height}`);
  assert.deepEqual(await e.hiddenWires(), []);
});

scenario('frames on frames, and bends that follow', async () => {
  const wire = 'height.image > soft.image';
  const layout = {levels: {'': {
    nodes: {stones: [0, 400], height: [60, 120], soft: [380, 120]},
    frames: {f1: {title: 'outer', at: [0, 0], size: [620, 280]}, f2: {title: 'inner', at: [40, 80], size: [220, 140]}},
    wires: {[wire]: [[300, 240]]}}}};
  const e = await Editor.open(JSON.stringify({
    terrazzo: 1, nodes: {stones: {type: 'pattern', size: 16}, height: {type: 'get_map', material: '@stones', map: 'height'}, soft: {type: 'blur', image: '@height'}}}, null, 2),
    {layout: JSON.stringify(layout)}), {page} = e;
  await e.press('f');
  await e.settle();
  const outer = page.locator('.svelte-flow__node[data-id="frame:f1"]'), bend = page.locator('.bend');
  const box = await outer.boundingBox(), before = await middle(bend);
  await page.mouse.move(box.x + box.width - 30, box.y + box.height - 12);
  await page.mouse.down();
  await page.mouse.move(box.x + box.width + 10, box.y + box.height + 18, {steps: 5});
  await page.waitForTimeout(60);
  const during = await middle(bend), moved = await outer.boundingBox();
  assert(close(during.x - before.x, moved.x - box.x, 2) && close(during.y - before.y, moved.y - box.y, 2), 'the bend moves with its nodes');
  await page.mouse.up();
  await e.laidOut(() => {
    const {nodes, frames, wires} = e.layout.levels[''], [dx, dy] = frames.f1.at;
    return dx > 10 && dy > 10 && frames.f2.at[0] === 40 + dx && frames.f2.at[1] === 80 + dy && nodes.height[0] === 60 + dx && nodes.soft[1] === 120 + dy &&
      nodes.stones[0] === 0 && wires[wire][0][0] === 300 + dx && wires[wire][0][1] === 240 + dy;
  }, 'the inner frame, the nodes and the bend moved');
  await e.toCanvas();
  await e.press('Control+z');
  await e.laidOut(() => e.layout.levels[''].frames.f2.at[0] === 40 && e.layout.levels[''].wires[wire][0][0] === 300, 'in one step');
  // Several nodes by keyboard.
  await e.press('Escape');
  await e.card('stones').locator('.head').click();
  await e.press('Shift+ArrowRight', 'Shift+ArrowRight');
  await page.waitForFunction(() => document.querySelectorAll('.svelte-flow__node-card.selected').length === 3);
  await e.press('ArrowLeft');
  await page.waitForFunction(() => document.querySelector('.svelte-flow__node-card.selected')?.dataset.id === 'height');
  assert.equal(await page.locator('.svelte-flow__node-card.selected').count(), 1);
});
