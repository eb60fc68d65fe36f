// Building graphs: by mouse alone, by keyboard alone, and undoing all of it.
import { assert, Editor, scenario, scenarioWithClipboard, stock } from './harness.mjs';

const empty = '{\n  "terrazzo": 1,\n  "nodes": {}\n}\n';

const isBuilt = ({nodes}) => nodes.pattern?.type === 'pattern' && nodes.get_map?.material === '@pattern' && nodes.get_map.map === 'height' &&
  nodes.blur?.image === '@get_map' && nodes.blur.radius === 5;

scenario('build by mouse', async () => {
  const e = await Editor.open(empty), {page} = e;
  // Double click, and choose from the list.
  await page.mouse.dblclick(180, 300);
  await page.locator('.picker .row', {hasText: 'pattern'}).first().click();
  await e.card('pattern').waitFor();
  // A wire that is dropped on the empty canvas offers what fits it.
  await e.drag(e.port('pattern', 'material', 'source'), {x: 460, y: 330});
  assert.equal(await page.locator('.picker .row', {hasText: 'blur'}).count(), 0, 'blur takes no material');
  await page.locator('.picker .row .name', {hasText: /^get_map$/}).click();
  await e.saved(({nodes}) => nodes.get_map?.material === '@pattern', 'the dropped wire is connected');
  // A third node from the context menu, connected by hand.
  await page.mouse.click(640, 560, {button: 'right'});
  await page.locator('.menu button', {hasText: 'Add a node'}).click();
  await page.locator('.picker .row .name', {hasText: /^blur$/}).click();
  await e.card('blur').waitFor();
  await e.drag(e.port('get_map', 'image', 'source'), e.port('blur', 'image', 'target'));
  await e.saved(({nodes}) => nodes.blur?.image === '@get_map', 'a wire is drawn');
  // Values: typed ones too need a keyboard; the mouse drags.
  await e.card('get_map').click();
  await page.locator('#panel label', {hasText: /^map$/}).waitFor();
  await page.locator('#panel .field', {hasText: 'map'}).locator('input[type=text]').first().fill('height');
  await e.card('blur').click();
  const radius = page.locator('#panel .field', {hasText: 'radius'}).locator('input.number');
  await radius.waitFor();
  const box = await radius.boundingBox();
  await e.drag(radius, {x: box.x + box.width / 2 + 120, y: box.y + 10});
  await e.saved(({nodes}) => nodes.blur.radius > 2, 'a number is dragged');
  await radius.fill('5');
  await radius.press('Enter');
  await e.saved(isBuilt, 'the graph is built');
});

scenario('build by keyboard', async () => {
  const e = await Editor.open(empty), {page} = e;
  await e.press('Tab');
  await e.type('pattern');
  await e.press('Enter');
  await e.card('pattern').waitFor();
  await e.settle();
  // Space and a few letters: behind the selected node, and connected.
  await e.press('Space');
  await e.type('get');
  await e.press('Enter');
  await e.saved(({nodes}) => nodes.get_map?.material === '@pattern', 'Space connects');
  await e.settle();
  await e.press('Escape', 'Tab');
  await e.type('blur');
  await e.press('Enter');
  await e.card('blur').waitFor();
  await e.settle();
  // Arrows go to a node, C connects it.
  await page.waitForFunction(() => document.activeElement?.dataset.id === 'blur');
  await e.press('Escape', 'ArrowRight');
  for (let step = 0; step < 4 && !(await page.evaluate(() => document.activeElement?.dataset.id === 'get_map')); ++step) await e.press('ArrowRight');
  await page.waitForFunction(() => document.activeElement?.dataset.id === 'get_map');
  await e.press('c');
  await e.type('blur');
  await e.press('Enter');
  await e.saved(({nodes}) => nodes.blur?.image === '@get_map', 'C connects');
  await e.settle();
  // F6 goes to the panel; its fields are reached by Tab.
  const field = async (name, value) => {
    await e.press('F6');
    for (let stop = 0; stop < 60; ++stop) {
      await e.press('Tab');
      const label = await page.evaluate(() => { const at = document.activeElement; return at?.labels?.[0]?.textContent?.trim() ?? at?.ariaLabel; });
      if (label?.split(' ')[0] === name) break;
    }
    await e.press('Control+a');
    await e.type(value);
    await e.press('Enter');
    await e.settle();
  };
  await field('map', 'height');
  await e.saved(({nodes}) => nodes.get_map.map === 'height', 'a text is typed');
  await e.press('Shift+F6', 'ArrowRight');
  await page.waitForFunction(() => document.activeElement?.dataset.id === 'blur');
  await field('radius', '5');
  await e.saved(isBuilt, 'the graph is built');
});

scenarioWithClipboard('edit a stock graph and undo everything', async () => {
  const text = stock('material'), e = await Editor.open(text), {page} = e;
  await e.press('f');
  await e.settle();
  await e.card('layout').click();
  const quality = page.locator('#panel .field', {hasText: 'quality'});
  await quality.locator('.fx').click();
  await e.saved(({nodes}) => nodes.layout.quality === undefined, 'an expression is taken away');
  await e.settle();
  await e.card('guides').click();
  await e.press('m');
  await e.saved(({nodes}) => nodes.guides.mute === true, 'M mutes');
  await e.press('Delete');
  await e.saved(({nodes}) => !nodes.guides, 'Delete removes');
  await e.settle();
  await e.card('lattice').click();
  await e.press('Control+d');
  await e.saved(({nodes}) => Object.values(nodes).filter((n) => n.type === 'regularity').length === 2, 'Ctrl+D duplicates');
  await e.settle();
  await e.press('Backspace');
  await e.saved(({nodes}) => Object.values(nodes).filter((n) => n.type === 'regularity').length === 1, 'Backspace removes');
  await e.settle();
  await e.card('index').click();
  await e.press('F2');
  await e.type('similar');
  await e.press('Enter');
  await e.saved(({nodes}) => nodes.similar && nodes.layout.index === '@similar', 'wires follow a new name');
  // To a text editor and back.
  await e.settle();
  await e.press('Control+c');
  await e.toast('copied as JSON');
  assert.match(await page.evaluate(() => navigator.clipboard.readText()), /"type": "index"/);
  await e.press('Control+v');
  await e.saved(({nodes}) => Object.values(nodes).filter((n) => n.type === 'index').length === 2, 'Ctrl+V pastes');
  await e.settle();
  for (let step = 0; step < 40 && await page.locator('[aria-label=undo]').isEnabled(); ++step) {
    await e.press('Control+z');
    await page.waitForTimeout(90);
  }
  await e.settle();
  assert.equal(JSON.stringify(e.json), JSON.stringify(JSON.parse(text)), 'all is undone');
  for (let step = 0; step < 40 && await page.locator('[aria-label=redo]').isEnabled(); ++step) {
    await e.press('Control+Shift+z');
    await page.waitForTimeout(90);
  }
  await e.saved(({nodes}) => Object.values(nodes).filter((n) => n.type === 'index').length === 2, 'all is done again');
});

scenario('break and repair a wire', async () => {
  const e = await Editor.open(stock('material')), {page} = e;
  await e.press('f');
  await e.settle();
  assert.deepEqual(await e.hiddenWires(), []);
  // What does not fit is refused, and says why.
  await e.drag(e.port('index', 'index', 'source'), e.port('files', 'material', 'target'));
  await e.toast('index gives an index');
  await e.press('Escape');
  // A wire is pulled off its input.
  const end = await e.port('space', 'features', 'target').boundingBox();
  await e.drag({x: end.x - 3, y: end.y + end.height / 2}, {x: end.x + 20, y: end.y + 220});
  await e.saved(({nodes}) => nodes.space.features === undefined, 'the wire is gone');
  await page.locator('.count.error').waitFor();
  await page.locator('#tab-problems').click();
  await page.locator('.problems button', {hasText: 'space'}).first().click();
  await page.waitForFunction(() => document.querySelector('.svelte-flow__node.selected')?.dataset.id === 'space');
  await e.drag(e.port('elements', 'features', 'source'), e.port('space', 'features', 'target'));
  await e.saved(({nodes}) => nodes.space.features === '@elements', 'the wire is back');
  await page.waitForFunction(() => !document.querySelector('.count.error'));
  // Escape leaves a drag: of a wire, and of a node.
  const at = async (place) => { const b = await place.boundingBox(); await page.mouse.move(b.x + b.width / 2, b.y + b.height / 2); };
  const {text} = e;
  await at(e.port('elements', 'features', 'target'));
  await page.mouse.down();
  await at(e.port('layout', 'coarse', 'target'));
  await e.press('Escape');
  await page.mouse.up();
  await at(e.card('lattice').locator('.name'));
  await page.mouse.down();
  await page.mouse.move(300, 700, {steps: 4});
  await e.press('Escape');
  await page.mouse.up();
  await page.waitForTimeout(200);
  assert.equal(e.text, text, 'nothing has changed');
  assert.equal(await page.locator('.picker').count(), 0);
  // The input's own handle lets a wire go, too: to another input, or to nowhere.
  await e.drag(e.port('index', 'appearance', 'target'), {x: 300, y: 740});
  await e.saved(({nodes}) => nodes.index.appearance === undefined, 'the handle lets the wire go');
  await e.toCanvas();
  await e.press('Control+z');
  await e.saved(({nodes}) => nodes.index.appearance === '@space', 'and it comes back');
  // By keyboard: W selects a wire, Delete removes it.
  await e.card('index').click();
  await e.press('w', 'Delete');
  await e.saved(({nodes}) => nodes.index && nodes.index.appearance === undefined, 'the selected wire is removed');
});
