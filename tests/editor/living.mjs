// What happens while the page is open: runs, other editors, a broken text, a server that dies.
import fs from 'node:fs';
import { assert, Editor, scenario, stock } from './harness.mjs';

const withSubgraph = JSON.stringify({
  terrazzo: 1,
  graphs: {soften: {summary: 'Soft heights', inputs: {material: {type: 'material', help: 'any'}},
    nodes: {height: {type: 'get_map', material: '@material', map: 'height'}, soft: {type: 'blur', image: '@height', radius: 3}},
    outputs: {image: '@soft'}}},
  nodes: {stones: {type: 'pattern', kind: 'cobbles', size: 64}, softer: {type: 'soften', material: '@stones'}},
}, null, 2);

// Large enough to take some seconds.
const slow = JSON.stringify({
  terrazzo: 1,
  nodes: {stones: {type: 'pattern', kind: 'cobbles', size: 256}, weighted: {type: 'weight', material: '@stones'},
    space: {type: 'pca', features: '@weighted'}, index: {type: 'index', appearance: '@space'},
    layout: {type: 'synthesize', index: '@index', size: 2048, quality: 'best'},
    result: {type: 'resolve_uv', uv: '@layout', material: '@stones'}, files: {type: 'export', material: '@result', path: 'out/{map}.png'}},
}, null, 2);

scenario('step into a subgraph', async () => {
  const e = await Editor.open(withSubgraph), {page} = e;
  await e.card('softer').locator('.head').dblclick();
  await e.card('soft').waitFor();
  await page.locator('.crumbs button', {hasText: 'softer'}).waitFor();
  await e.settle();
  await e.card('soft').click();
  const radius = page.locator('#panel .field', {hasText: 'radius'}).locator('input.number');
  await radius.fill('7');
  await radius.press('Enter');
  await e.saved(({graphs}) => graphs.soften.nodes.soft.radius === 7, 'a node of the subgraph is edited');
  await page.locator('.crumbs button').first().click();
  await e.card('stones').waitFor();
  await page.keyboard.press('Control+z');
  await e.saved(({graphs}) => graphs.soften.nodes.soft.radius === 3, 'undo reaches into the subgraph');
  await e.card('softer').click();
  await e.press('Enter');
  await e.card('soft').waitFor();
  await e.press('u');
  await e.card('stones').waitFor();
});

scenario('edit on disk meanwhile', async () => {
  const e = await Editor.open(withSubgraph), {page} = e;
  const changed = e.json;
  changed.nodes.more = {type: 'blur', image: '@softer'};
  fs.writeFileSync(e.file, JSON.stringify(changed, null, 2));
  await e.card('more').waitFor();
  await e.card('stones').click();
  await page.locator('#panel .field', {hasText: 'seed'}).locator('input.number').first().fill('9');
  await page.keyboard.press('Enter');
  await e.saved(({nodes}) => nodes.more && nodes.stones.seed === 9, 'both edits are kept');
});

scenario('run and cancel', async () => {
  const e = await Editor.open(slow), {page} = e;
  assert.ok(!fs.existsSync(e.folder + '/out'), 'opening a graph writes nothing');
  await page.getByRole('button', {name: '▶ Run'}).click();
  await page.getByRole('button', {name: 'Cancel'}).click({timeout: 4000});
  await page.locator('#bar', {hasText: 'cancelled after'}).waitFor();
  assert.ok(!fs.existsSync(e.folder + '/out'), 'a cancelled run writes nothing');
});

scenario('a text that is no JSON', async () => {
  const e = await Editor.open('{\n  "terrazzo": 1,\n  "nodes": {\n    "stones": {"type": "pattern",, "size": 64}\n  }\n}\n'), {page} = e;
  await page.locator('.text-panel .problem', {hasText: /Line 4/}).waitFor();
  const area = page.getByLabel('the document as text');
  await area.fill((await area.inputValue()).replace(',,', ','));
  await area.press('Control+s');
  await e.card('stones').waitFor();
  await page.waitForFunction(() => !document.querySelector('.text-panel .problem'));
});

scenario('paint a mask', async () => {
  const e = await Editor.open(JSON.stringify({terrazzo: 1, nodes: {
    stones: {type: 'pattern', kind: 'cobbles', size: 64}, weighted: {type: 'weight', material: '@stones'}}}, null, 2)), {page} = e;
  await e.card('stones').click();
  const picture = page.locator('#view .flat canvas').last();
  await picture.waitFor();
  await page.waitForTimeout(400);
  await page.getByRole('button', {name: 'Paint', exact: true}).click();
  const box = await picture.boundingBox(), middle = {x: box.x + box.width / 2, y: box.y + box.height / 2};
  await e.drag({x: middle.x - 30, y: middle.y}, {x: middle.x + 30, y: middle.y + 8});
  await page.getByLabel('what takes the mask').selectOption({label: 'mask of weighted'});
  await page.locator('.paint').getByRole('button', {name: 'Save'}).click();
  await e.saved(({nodes}) => nodes.mask?.type === 'load_map' && nodes.weighted.mask === '@mask', 'the mask is connected');
  const {path} = e.json.nodes.mask;
  assert.match(path, /mask.*\.png$/);
});

scenario('the server dies and comes back', async () => {
  const e = await Editor.open(withSubgraph), {page} = e;
  await page.locator('#tab-text').click();
  const area = page.getByLabel('the document as text');
  await area.fill((await area.inputValue()).replace('"radius": 3', '"radius": 4'));
  await e.kill();
  await page.locator('.banner', {hasText: 'lost'}).waitFor();
  await e.start(e.portNumber);
  await page.locator('.banner', {hasText: 'Open the address that it has printed'}).waitFor({timeout: 12000});
  // The address that the new one prints lets this browser in again; the old page then goes on.
  const other = await e.context.newPage();
  await other.goto(e.address);
  await page.waitForFunction(() => !document.querySelector('.banner'), null, {timeout: 15000});
  assert.match(await area.inputValue(), /"radius": 4/, 'what was typed is still there');
  await area.press('Control+s');
  await e.saved(({graphs}) => graphs.soften.nodes.soft.radius === 4, 'and can be applied');
  // Two tabs stay in step.
  await other.locator('.svelte-flow__node[data-id="stones"]').click();
  await other.locator('#panel .field', {hasText: 'seed'}).locator('input.number').first().fill('5');
  await other.keyboard.press('Enter');
  await page.waitForFunction(() => document.querySelector('textarea')?.value.includes('"seed": 5'));
  await other.close();
});

scenario('accessible', async () => {
  const e = await Editor.open(stock('material')), {page} = e;
  // Everything in the dark; in the light only colours are others.
  const check = async (where) => {
    await e.accessible(where);
    await page.emulateMedia({colorScheme: 'light'});
    await e.accessible(where + ', light', ['color-contrast']);
    await page.emulateMedia({colorScheme: 'dark'});
  };
  await e.press('f');
  await e.settle();
  await e.card('layout').click();
  await e.settle();
  await check('a node');
  await page.locator('#tab-text').click();
  await check('the text');
  await page.locator('#tab-problems').click();
  await e.accessible('the problems');
  await page.locator('#canvas').focus();
  await e.press('Tab');
  await check('the palette');
  await e.press('Escape', '?');
  await e.accessible('the keys');
  await e.press('Escape');
  await e.card('index').click({button: 'right'});
  await e.accessible('a menu');
});
