// Forms: what is typed while others change the same, declarations, loops, a graph that is only shown, files that change.
import fs from 'node:fs';
import path from 'node:path';
import { assert, Editor, scenario } from './harness.mjs';

const small = JSON.stringify({
  terrazzo: 1,
  nodes: {
    stones: {type: 'pattern', kind: 'cobbles', size: 64, seed: 1},
    height: {type: 'get_map', material: '@stones', map: 'height'},
    soft: {type: 'blur', image: '@height', radius: 3}},
}, null, 2);

const field = (e, name) => e.page.locator('#panel .field', {has: e.page.locator('label', {hasText: new RegExp(`^\\s*${name}\\b`)})});
const write = (e, change) => {
  const document = e.json;
  change(document);
  // At once: a file that is half written is a text with mistakes for a moment.
  fs.writeFileSync(e.file + '.new', JSON.stringify(document, null, 2));
  fs.renameSync(e.file + '.new', e.file);
};

scenario('a value typed while it changes elsewhere', async () => {
  const e = await Editor.open(small), {page} = e;
  await e.press('f');
  await e.settle();
  await e.card('soft').locator('.head').click();
  const radius = field(e, 'radius'), input = radius.locator('input.number');
  const type = async (value) => { await input.click(); await e.press('Control+a'); await e.type(value); };
  await type('7');
  write(e, ({nodes}) => { nodes.soft.radius = 5; });
  await radius.getByText('Changed elsewhere to').waitFor();
  assert.equal(await input.inputValue(), '7', 'what was typed stays');
  await e.press('Enter');
  await page.waitForTimeout(150);
  assert.equal(e.json.nodes.soft.radius, 5, 'nothing is overwritten');
  // It is still there after another node was looked at.
  await e.card('height').locator('.head').click();
  await e.card('soft').locator('.head').click();
  await radius.getByText('yours is 7').waitFor();
  await radius.getByRole('button', {name: 'take it'}).click();
  await page.waitForFunction(() => !document.querySelector('.field .elsewhere'));
  assert.equal(await input.inputValue(), '5');
  await type('8');
  write(e, ({nodes}) => { nodes.soft.radius = 6; });
  await radius.getByText('Changed elsewhere to').waitFor();
  await radius.getByRole('button', {name: 'keep yours'}).click();
  await e.saved(({nodes}) => nodes.soft.radius === 8, 'mine is kept');
  // A text field, and the comment.
  await e.card('height').locator('.head').click();
  await field(e, 'map').locator('input').first().fill('nor');
  write(e, ({nodes}) => { nodes.height.map = 'roughness'; nodes.height.comment = 'theirs'; });
  await field(e, 'map').getByText('Changed elsewhere to').waitFor();
  assert.equal(await field(e, 'map').locator('input').first().inputValue(), 'nor');
  await field(e, 'map').getByRole('button', {name: 'take it'}).click();
  await page.waitForFunction(() => !document.querySelector('.field .elsewhere'));
  assert.equal(await field(e, 'map').locator('input').first().inputValue(), 'roughness');
  await field(e, 'comment').locator('textarea').fill('mine');
  write(e, ({nodes}) => { nodes.height.comment = 'theirs again'; });
  await field(e, 'comment').getByText('theirs again').waitFor();
  await field(e, 'comment').getByRole('button', {name: 'keep yours'}).click();
  await e.saved(({nodes}) => nodes.height.comment === 'mine' && nodes.height.map === 'roughness', 'a comment of mine is kept');
  // The text: other changes are merged, the same are asked about.
  await page.locator('#tab-text').click();
  const area = page.getByLabel('the document as text');
  await area.fill((await area.inputValue()).replace('"cobbles"', '"bricks"'));
  write(e, ({nodes}) => { nodes.stones.seed = 4; });
  await page.getByText('changed here, and elsewhere').waitFor();
  await area.press('Control+s');
  await e.saved(({nodes}) => nodes.stones.seed === 4 && nodes.stones.kind === 'bricks', 'both changes of the text are kept');
  await page.waitForFunction((a) => a.value.includes('"seed": 4'), await area.elementHandle());
  await area.fill((await area.inputValue()).replace('"seed": 4', '"seed": 9'));
  write(e, ({nodes}) => { nodes.stones.seed = 5; });
  await page.getByText('changed here, and elsewhere').waitFor();
  await area.press('Control+s');
  await page.getByText('/nodes/stones/seed').waitFor();
  assert.equal(e.json.nodes.stones.seed, 5);
  await page.getByRole('button', {name: 'Overwrite it'}).click();
  await e.saved(({nodes}) => nodes.stones.seed === 9, 'overwritten only when asked to');
});

scenario('parameters of the graph, loops and comments', async () => {
  const e = await Editor.open(small), {page} = e;
  await e.press('f');
  await e.settle();
  await e.card('soft').locator('.head').click();
  await field(e, 'radius').locator('label').click({button: 'right'});
  await page.locator('.menu button', {hasText: 'Make it a graph parameter'}).click();
  await page.locator('.dialog input').fill('softness');
  await e.press('Enter');
  await e.saved(({nodes, parameters}) => nodes.soft.radius === '$softness' && parameters.softness.default === 3 && parameters.softness.type === 'number', 'a parameter is promoted');
  await field(e, 'radius').locator('.comes-to', {hasText: '3'}).waitFor();
  await page.locator('#canvas').focus();
  await e.press('Escape');
  await page.getByRole('button', {name: '+ Parameter'}).click();
  const form = page.locator('.declaration');
  await form.getByLabel('name').fill('amount');
  await form.getByLabel('type').selectOption('int');
  await form.getByLabel('default').fill('4');
  await form.getByLabel('least').fill('1');
  await form.getByLabel('most').fill('9');
  await form.getByRole('button', {name: 'Add'}).click();
  await e.saved(({parameters}) => parameters.amount?.max === 9 && parameters.amount.default === 4, 'a parameter is declared');
  const menu = async (name, item) => {
    await field(e, name).locator('label').click({button: 'right'});
    await page.locator('.menu button', {hasText: item}).click();
  };
  await menu('amount', 'Change the declaration');
  await form.getByLabel('most').fill('20');
  await form.getByRole('button', {name: 'Change'}).click();
  await e.saved(({parameters}) => parameters.amount.max === 20, 'a range is changed');
  await menu('softness', 'Rename');
  await page.locator('.dialog input').fill('blur');
  await e.press('Enter');
  await e.saved(({nodes, parameters}) => parameters.blur && nodes.soft.radius === '$blur', 'expressions follow a new name');
  await menu('amount', 'Remove');
  await e.saved(({parameters}) => !parameters.amount, 'a parameter is removed');
  // Values by handle: by keyboard from the node's side, by mouse from the graph's, and none again.
  await e.card('stones').locator('.head').click();
  await page.getByRole('button', {name: 'stones.seed: where its value comes from'}).focus();
  await e.press('Enter');
  await e.type('new');
  await e.press('Enter');
  await page.locator('.dialog input').waitFor();
  await e.press('Enter');
  await e.saved(({nodes, parameters}) => nodes.stones.seed === '$seed' && parameters.seed.default === 1, 'a handle makes a parameter');
  await e.toCanvas();
  await e.press('Escape');
  await e.drag(page.getByRole('button', {name: 'blur: what takes its value'}), e.card('height'));
  await e.toast('No parameter of height takes blur');
  await e.drag(page.getByRole('button', {name: 'seed: what takes its value'}), e.card('soft'));
  await e.saved(({nodes}) => nodes.soft.radius === '$seed', 'a value is dragged to a node');
  await page.getByRole('button', {name: 'blur: what takes its value'}).click();
  await e.type('soft.radius');
  await e.press('Enter');
  await e.saved(({nodes}) => nodes.soft.radius === '$blur', 'a value goes to a parameter');
  await e.card('stones').locator('.head').click();
  await page.getByRole('button', {name: 'stones.seed: where its value comes from'}).click();
  await page.locator('.picker .row', {hasText: 'nothing'}).click();
  await e.saved(({nodes}) => nodes.stones.seed === undefined, 'and is taken away');
  await page.locator('.pin.wired').waitFor({state: 'detached'});
  // Comment, loop and mute, from the form.
  await e.card('soft').locator('.head').click();
  await field(e, 'comment').locator('textarea').fill('two lines\nof it');
  await page.keyboard.press('Tab');
  await e.saved(({nodes}) => nodes.soft.comment === 'two lines\nof it', 'a comment is kept');
  await e.card('soft').locator('.mark').first().waitFor();
  await field(e, 'foreach').locator('input').fill('{"values": [1, 2], "as": "n"}');
  await e.press('Enter');
  await e.saved(({nodes}) => nodes.soft.foreach?.as === 'n', 'a loop is kept');
  await field(e, 'foreach').locator('input').fill('{"values": [1, 2]');
  await e.press('Enter');
  await e.toast('A loop is written as JSON');
  assert.equal(await field(e, 'foreach').locator('input').inputValue(), '{"values": [1, 2]', 'what is wrong can be mended');
  await field(e, 'foreach').locator('input').fill('');
  await e.press('Enter');
  await e.saved(({nodes}) => nodes.soft.foreach === undefined, 'a loop is taken away');
  await field(e, 'mute').locator('input').click();
  await e.saved(({nodes}) => nodes.soft.mute === true, 'the switch mutes');
});

scenario('an unfinished node, and fields that do not move', async () => {
  const e = await Editor.open(small), {page} = e;
  await e.press('f');
  await e.settle();
  const badges = () => page.locator('.card .word:not(:empty)').count();
  await page.waitForFunction(() => document.querySelectorAll('.card .word').length === 3);
  const before = await badges();
  await page.locator('#canvas').focus();
  await e.press('Escape', 'Tab');
  await e.type('weight');
  await e.press('Enter');
  await page.locator('.count.error').waitFor();
  await page.waitForTimeout(600);
  assert.ok(await badges() >= before, 'the others are planned all the same');
  await e.card('soft').locator('.head').click();
  await field(e, 'radius').waitFor();
  const at = async () => (await page.locator('#panel .field').evaluateAll((fields) => fields.map((f) => f.getBoundingClientRect().top))).join();
  const still = await at();
  await field(e, 'radius').locator('.fx').click();
  await field(e, 'radius').locator('input').fill('=no_such_name');
  await e.press('Enter');
  await field(e, 'radius').locator('.sign.error').waitFor();
  await page.locator('.node-problems', {hasText: 'no_such_name'}).waitFor();
  assert.equal(await at(), still, 'no field moves');
  await field(e, 'radius').locator('input').focus();
  await page.locator('.bubble.shown', {hasText: 'no_such_name'}).waitFor();
  assert.equal(await at(), still, 'no field moves for help either');
});

scenario('a graph that is only shown', async () => {
  const e = await Editor.open(small, {args: ['--read-only']}), {page} = e, text = e.text;
  await page.locator('.tag', {hasText: 'read-only'}).waitFor();
  await e.press('f');
  await e.settle();
  const none = async (what) => assert.equal(await page.locator('.dialog, .picker').count(), 0, what);
  await e.card('soft').locator('.head').click();
  for (const key of ['F2', 'Shift+F', 'Control+g', 'Control+d', 'Control+x', 'c', ' ', 'm', 'p', 'Delete', 'Alt+ArrowUp', 'Control+Shift+g', 'w', 'b', 'Delete']) {
    await e.press(key === ' ' ? 'Space' : key);
    await none(key);
  }
  await e.toast('read-only');
  await page.mouse.dblclick(300, 700);
  await none('double click');
  await e.card('soft').locator('.head').click({button: 'right'});
  for (const name of ['Rename', 'Delete', 'Duplicate', 'Mute', 'Group', 'Frame', 'Cut', 'Pin'])
    assert.ok(await page.locator('.menu button', {hasText: name}).first().isDisabled(), name);
  await e.press('Escape');
  await e.card('soft').locator('.head').click();
  assert.equal(await page.locator('#panel .field :is(input, select, textarea):enabled').count(), 0, 'fields are disabled');
  assert.equal(e.text, text);
});

scenario('conflicts, write-protected files and a repaired text', async () => {
  const e = await Editor.open(small), {page} = e;
  await e.press('f');
  await e.settle();
  await e.card('stones').locator('.head').click();
  const seed = field(e, 'seed').locator('input.number');
  const set = async (value) => { await seed.click(); await e.press('Control+a'); await e.type(value); await e.press('Enter'); };
  fs.chmodSync(e.file, 0o444);
  await set('11');
  await page.locator('.banner', {hasText: 'write-protected'}).waitFor();
  await page.locator('.tag', {hasText: 'not saved'}).waitFor();
  assert.equal(e.json.nodes.stones.seed, 1);
  // Somebody else changes the same meanwhile.
  fs.chmodSync(e.file, 0o644);
  write(e, ({nodes}) => { nodes.stones.seed = 2; });
  await page.locator('.banner', {hasText: '/nodes/stones/seed'}).waitFor();
  await page.getByRole('button', {name: 'Take the file’s'}).or(page.getByRole('button', {name: "Take the file's"})).click();
  await page.waitForFunction(() => !document.querySelector('.banner'));
  assert.equal(await seed.inputValue(), '2');
  await e.press('Control+z');
  await e.saved(({nodes}) => nodes.stones.seed === 11, 'what was given up can be had again');
  // Broken by another program, and repaired in the page.
  fs.writeFileSync(e.file, e.text.replace('"seed": 11', '"seed": 11,,'));
  await page.locator('.text-panel .problem', {hasText: /Line/}).waitFor();
  const area = page.getByLabel('the document as text');
  await area.fill((await area.inputValue()).replace(',,', ''));
  await area.press('Control+s');
  await e.saved(({nodes}) => nodes.stones.seed === 11, 'the text is repaired');
  await e.card('stones').waitFor();
  fs.rmSync(e.file);
  await page.locator('.banner', {hasText: 'gone'}).waitFor();
  await page.getByRole('button', {name: 'Write it again'}).click();
  await e.saved(({nodes}) => nodes.stones.seed === 11, 'the file is there again');
});

scenario('a picture that changes on disk', async () => {
  const pgm = (grey) => Buffer.from(`P5 4 4 255\n${String.fromCharCode(grey).repeat(16)}`, 'latin1');
  const e = await Editor.open(JSON.stringify({terrazzo: 1, nodes: {map: {type: 'load_map', path: 'map.pgm', semantic: 'height'}}}, null, 2),
                              {prepare: (folder) => fs.writeFileSync(path.join(folder, 'map.pgm'), pgm(100))});
  const shown = () => e.page.evaluate(() => document.querySelector('.svelte-flow__node[data-id=map] img')?.src ?? '');
  await e.card('map').locator('.head').click();
  await e.press('p');
  await e.card('map').locator('img').waitFor();
  const before = await shown();
  fs.writeFileSync(path.join(e.folder, 'map.pgm'), pgm(200));
  await e.page.waitForFunction((old) => { const now = document.querySelector('.svelte-flow__node[data-id=map] img')?.src; return now && now !== old; }, before);
});
