// The canvas: selecting, wires that are bent or get a node, frames, groups, subgraphs' inputs and outputs.
import { assert, Editor, scenario, scenarioWithClipboard } from './harness.mjs';

const line = (positions = {}) => ({
  text: JSON.stringify({terrazzo: 1, nodes: {
    stones: {type: 'pattern', kind: 'cobbles', size: 64},
    height: {type: 'get_map', material: '@stones', map: 'height'},
    soft: {type: 'blur', image: '@height', radius: 3},
    spare: {type: 'blur'}}}, null, 2),
  layout: JSON.stringify({levels: {'': {nodes: {stones: [0, 0], height: [260, 0], soft: [520, 0], spare: [330, 240], ...positions}}}}),
});

const open = ({text, layout}) => Editor.open(text, {layout});
const position = (e, name) => {
  const {nodes} = e.layout.levels[''], at = nodes[name];
  return Array.isArray(at) ? at : at.at;
};
const focused = (e, id) => e.page.waitForFunction((name) => document.activeElement?.dataset.id === name, id);

scenario('select, align and frame', async () => {
  const e = await open(line()), {page} = e;
  await e.press('f');
  await e.settle();
  // A click on one of several selected nodes selects it alone; a drag moves all of them.
  await e.press('Control+a');
  assert.equal(await page.locator('.svelte-flow__node.selected').count(), 4);
  await e.card('height').locator('.head').click();
  await page.waitForFunction(() => document.querySelectorAll('.svelte-flow__node.selected').length === 1);
  await e.press('Control+a');
  const head = await e.card('spare').locator('.head').boundingBox();
  await e.drag({x: head.x + 40, y: head.y + 10}, {x: head.x + 70, y: head.y + 40});
  await e.laidOut(() => position(e, 'soft')[0] !== 520 && position(e, 'soft')[1] - position(e, 'stones')[1] === 0, 'all are moved');
  // From the menu: tops in a row, then side by side.
  await e.card('spare').locator('.head').click({button: 'right'});
  await page.locator('.menu button', {hasText: 'Align'}).click();
  await page.locator('.menu button', {hasText: 'Tops'}).click();
  await e.laidOut(() => position(e, 'spare')[1] === position(e, 'stones')[1], 'tops are aligned');
  await e.press('Shift+F10');
  await page.locator('.menu').waitFor();
  await e.press('a', 'Enter');
  await page.locator('.menu button:focus', {hasText: 'Left sides'}).waitFor();
  await e.press('s', 'Enter');
  await e.laidOut(() => new Set(['stones', 'height', 'soft', 'spare'].map((n) => position(e, n)[0])).size === 4, 'they stand side by side');
  // A frame around two of them carries them along.
  await e.settle();
  await e.card('stones').locator('.head').click();
  await e.card('height').locator('.head').click({modifiers: ['Shift']});
  await e.press('Shift+F');
  await e.type('sources');
  await e.press('Enter');
  await e.laidOut(() => e.layout.levels[''].frames.f1.title === 'sources', 'a frame is made');
  await e.settle();
  const before = {stones: position(e, 'stones'), soft: position(e, 'soft')};
  const title = await page.locator('.svelte-flow__node-frame').boundingBox();
  await e.drag({x: title.x + title.width - 12, y: title.y + title.height - 6}, {x: title.x + title.width - 12, y: title.y + title.height + 60});
  await e.laidOut(() => position(e, 'stones')[1] > before.stones[1] + 20, 'the frame carries its content');
  assert.deepEqual(position(e, 'soft'), before.soft, 'others stay');
  await page.locator('.frame-title').click();
  await e.type('the stones');
  await e.press('Enter');
  await e.laidOut(() => e.layout.levels[''].frames.f1.title === 'the stones', 'a frame has another title');
  // By keyboard: found, moved, removed.
  await e.press('Control+f');
  await e.type('the stones');
  await e.press('Enter');
  await page.locator('.svelte-flow__node-frame.selected').waitFor();
  const at = e.layout.levels[''].frames.f1.at;
  await e.press('Alt+ArrowDown');
  await e.laidOut(() => e.layout.levels[''].frames.f1.at[1] === at[1] + 16, 'keys move a frame');
  await e.press('Delete');
  await e.laidOut(() => !e.layout.levels[''].frames?.f1, 'Delete removes a frame');
  assert.equal(e.json.nodes.stones.type, 'pattern');
});

scenario('bend a wire', async () => {
  const e = await open(line()), {page} = e, bends = () => e.layout.levels[''].wires ?? {};
  await e.settle();
  const key = 'height.image > soft.image';
  const from = await e.port('height', 'image', 'source').boundingBox(), to = await e.port('soft', 'image', 'target').boundingBox();
  const middle = {x: (from.x + to.x) / 2 + 5, y: (from.y + to.y) / 2 + 5};
  await page.mouse.dblclick(middle.x, middle.y);
  await e.laidOut(() => bends()[key]?.length === 1, 'a double click bends');
  await page.locator('.bend').waitFor();
  const [, y] = bends()[key][0];
  await e.drag(page.locator('.bend'), {x: middle.x, y: middle.y + 90});
  await e.laidOut(() => bends()[key][0][1] > y + 60, 'a bend is dragged');
  // By keyboard: W takes a wire, B bends it, Alt and arrows move, Delete removes.
  await e.press('Escape');
  await e.card('soft').locator('.head').click();
  await e.press('w', 'b');
  await e.laidOut(() => bends()[key].length === 2, 'B bends');
  await page.locator('.bend.picked').waitFor();
  const before = JSON.stringify(bends()[key]);
  await e.press('Alt+ArrowUp');
  await e.laidOut(() => JSON.stringify(bends()[key]) !== before, 'keys move a bend');
  await e.settle();
  await e.press('Delete');
  await e.laidOut(() => bends()[key].length === 1, 'Delete removes a bend');
  // Names are followed; nodes that move together take the bend along.
  await e.card('height').locator('.head').click();
  await e.press('F2');
  await e.type('relief');
  await e.press('Enter');
  await e.laidOut(() => bends()['relief.image > soft.image']?.length === 1, 'bends follow a new name');
  await e.settle();
  await page.locator('.bend').dblclick();
  await e.laidOut(() => !bends()['relief.image > soft.image'], 'a double click on a bend removes it');
  assert.equal(e.json.nodes.soft.image, '@relief', 'the wire stays');
});

scenario('drop a node on a wire', async () => {
  const e = await open(line()), {page} = e;
  await e.settle();
  assert.deepEqual(await e.hiddenWires(), []);
  const from = await e.port('height', 'image', 'source').boundingBox(), to = await e.port('soft', 'image', 'target').boundingBox();
  const head = await e.card('spare').locator('.head').boundingBox(), card = await e.card('spare').boundingBox();
  const middle = {x: (from.x + to.x) / 2 + 5, y: (from.y + to.y) / 2 + 5};
  await e.drag({x: head.x + head.width / 2, y: head.y + 12}, {x: middle.x, y: middle.y - card.height / 2 + 12});
  await e.saved(({nodes}) => nodes.spare.image === '@height' && nodes.soft.image === '@spare', 'the node is in the wire');
  await e.settle();
  const boxes = await Promise.all(['stones', 'height', 'spare', 'soft'].map((name) => e.card(name).boundingBox()));
  for (const [at, box] of boxes.slice(1).entries()) assert.ok(box.x >= boxes[at].x + boxes[at].width, 'no card covers another');
  await e.press('Control+z');
  await e.saved(({nodes}) => !nodes.spare.image && nodes.soft.image === '@height', 'it is one step');
});

scenarioWithClipboard('group, cut, find and the palette by help', async () => {
  const e = await open(line()), {page} = e;
  await e.press('f');
  await e.settle();
  await e.card('height').locator('.head').click();
  await e.card('soft').locator('.head').click({modifiers: ['Shift']});
  await e.press('Control+g');
  await e.type('no name');
  await e.press('Enter');
  await page.locator('.dialog [role=alert]', {hasText: 'expected a name of letters'}).waitFor();
  await page.locator('.dialog input').fill('relief');
  await e.press('Enter');
  await e.saved(({nodes, graphs}) => nodes.relief && graphs.relief && !nodes.soft, 'two nodes are grouped');
  await focused(e, 'relief');
  await e.press('Enter');
  await e.card('@inputs').waitFor();
  await e.settle();
  // The boxes stand beside the nodes that they lead to.
  const [inputs, first] = [await e.card('@inputs').boundingBox(), await e.card('height').boundingBox()];
  assert.ok(first.x - inputs.x - inputs.width < 120 && first.x > inputs.x + inputs.width, 'the inputs are near');
  // Another output, by mouse; another input, by keyboard.
  await e.drag(e.port('height', 'image', 'source'), e.port('@outputs', '@new', 'target'));
  await page.locator('.dialog input').fill('raw');
  await e.press('Enter');
  await e.saved(({graphs}) => Object.keys(graphs.relief.outputs).includes('raw'), 'a subgraph has one more output');
  await e.settle();
  await page.locator('#canvas').focus();
  await e.press('Tab');
  await e.type('crop');
  await e.press('Enter');
  await e.card('crop').waitFor();
  await e.settle();
  await page.getByRole('button', {name: 'where material of crop comes from'}).click();
  await page.locator('.picker .row', {hasText: 'new input'}).click();
  await page.locator('.dialog input').fill('other');
  await e.press('Enter');
  await e.saved(({graphs}) => graphs.relief.inputs.other.type === 'material' && graphs.relief.nodes.crop.material === '@other', 'a subgraph has one more input');
  await e.settle();
  await e.card('crop').locator('.head').click();
  await e.press('c');
  await e.type('outputs');
  await e.press('Enter');
  await page.locator('.dialog input').fill('cropped');
  await e.press('Enter');
  await e.saved(({graphs}) => Object.keys(graphs.relief.outputs).includes('cropped'), 'C leads to a new output');
  await e.settle();
  // Find goes to other levels.
  await page.locator('#canvas').focus();
  await e.press('Control+f');
  await e.type('stones');
  await e.press('Enter');
  await focused(e, 'stones');
  await e.settle();
  await e.card('spare').locator('.head').click();
  await e.press('Control+x');
  await e.saved(({nodes}) => !nodes.spare, 'Ctrl+X cuts');
  assert.match(await page.evaluate(() => navigator.clipboard.readText()), /"spare"/);
  await e.settle();
  await e.card('relief').locator('.head').click();
  await e.press('Control+z', 'Control+z', 'Control+z', 'Control+z', 'Control+z');
  await e.saved(({nodes, graphs}) => nodes.spare && !graphs.relief.outputs?.raw, 'five steps are undone');
  await e.settle();
  await e.card('relief').locator('.head').click();
  await e.press('Control+Shift+g');
  await e.saved(({nodes}) => !nodes.relief && Object.values(nodes).some((n) => n.type === 'blur' && n.radius === 3), 'the nodes are out again');
  await page.waitForFunction(() => document.querySelectorAll('.svelte-flow__node-card.selected').length === 2);
  await e.settle();
  // What the help says is found; so is what fits a wire, the most usual first.
  await page.locator('#canvas').focus();
  await e.press('Escape', 'Tab');
  await e.type('principal components');
  assert.equal(await page.locator('.picker .row .name').first().textContent(), 'pca');
  await e.press('Escape');
  await e.settle();
  const gives = await e.port('stones', 'material', 'source').boundingBox();
  await e.drag({x: gives.x + gives.width / 2, y: gives.y + gives.height / 2}, {x: gives.x + 60, y: gives.y + 260});
  await page.locator('.picker').waitFor();
  assert.equal(await page.locator('.picker .row .name').first().textContent(), 'weight');
  await e.press('Escape');
});
