// Looking at results: pieces of a uv map, sheets of sweeps, presets, masks for a graph's own parameters.
import fs from 'node:fs';
import { assert, Editor, scenario } from './harness.mjs';

const wall = JSON.stringify({
  terrazzo: 1,
  parameters: {seed: {type: 'int', default: 1, min: 0}, mask: {type: 'path', help: 'white is filled'}},
  nodes: {stones: {type: 'pattern', kind: 'bricks', size: 64}, weighted: {type: 'weight', material: '@stones'},
    space: {type: 'pca', features: '@weighted'}, index: {type: 'index', appearance: '@space'},
    layout: {type: 'synthesize', index: '@index', size: 128, seed: '$seed'},
    result: {type: 'resolve_uv', uv: '@layout', material: '@stones'},
    holes: {type: 'load_map', path: '$mask', semantic: 'mask'},
    filled: {type: 'inpaint', index: '@index', mask: '@holes', seed: '$seed'}},
}, null, 2);

const look = async (e, name) => {
  await e.press('f');
  await e.settle();
  await e.card(name).click();
  await e.page.locator('#view .caption', {hasText: name}).last().waitFor();
};
const middleOf = async (picture) => {
  const box = await picture.boundingBox();
  return {x: box.x + box.width / 2, y: box.y + box.height / 2};
};

scenario('the piece under the pointer', async () => {
  const e = await Editor.open(wall), {page} = e;
  await look(e, 'layout');
  const result = page.locator('#view .flat canvas').last();
  await page.waitForFunction(() => document.querySelectorAll('#view .flat').length === 2);
  await page.waitForFunction(() => !document.querySelector('#view')?.textContent.includes('coarse'));
  const at = await middleOf(result);
  for (let step = 0; step < 20 && !(await page.locator('.values', {hasText: 'in a piece of'}).isVisible()); ++step) {
    await page.mouse.move(at.x + step, at.y);
    await page.waitForTimeout(150);
  }
  const said = await page.locator('.values').textContent();
  assert.match(said, /from \d+, \d+\s+in a piece of [1-9]\d* pixels/);
  await page.mouse.move(20, 400);
  await page.waitForFunction(() => !document.querySelector('.values').textContent.includes('piece'));
});

scenario('take one of a sweep', async () => {
  const e = await Editor.open(wall), {page} = e;
  await look(e, 'result');
  await page.getByRole('button', {name: 'Sweep', exact: true}).click();
  await page.getByLabel('parameter 1').selectOption('seed');
  await page.getByLabel('values of seed').fill('4..7');
  const show = page.locator('.sheet form').getByRole('button', {name: 'Show'});
  // Pictures may come, and even end, before the answer that names their cells.
  await page.route('**/api/sweep', async (route) => {
    const ended = page.evaluate(() => new Promise((done) => {
      const events = new EventSource('/api/events?tab=other');
      events.addEventListener('swept', () => { events.close(); done(); });
      events.onopen = () => { window.hears = true; };
    }));
    await page.waitForFunction(() => window.hears);
    const response = await route.fetch();
    await ended;
    await route.fulfill({response});
  }, {times: 1});
  await show.click();
  await page.waitForFunction(() => document.querySelectorAll('.cell img').length === 4);
  await show.waitFor();
  await page.locator('.cell', {hasText: 'seed=6'}).click();
  await page.keyboard.press('ArrowRight');
  await e.accessible('a sheet');
  await page.getByRole('button', {name: 'Take this one'}).click();
  await e.saved(({parameters}) => parameters.seed.default === 7, 'the chosen value is set');
  await page.keyboard.press('Control+z');
  await e.saved(({parameters}) => parameters.seed.default === 1, 'and undone');
  // What is wrong is said.
  await page.getByRole('button', {name: 'Sweep', exact: true}).click();
  await page.getByLabel('values of seed').fill('1..9999');
  await page.locator('.sheet form').getByRole('button').last().click();
  await page.locator('.sheet .problem', {hasText: 'pictures'}).waitFor();
});

scenario('presets', async () => {
  const e = await Editor.open(wall), {page} = e;
  const answer = async (text) => { await page.locator('[role=dialog] input').fill(text); await page.keyboard.press('Enter'); };
  await page.getByRole('button', {name: '+ Preset'}).click();
  await answer('early');
  await e.saved(({presets}) => presets.early.set.seed === 1 && !('mask' in presets.early.set), 'a preset holds the values of now');
  const seed = page.locator('#panel .field', {hasText: 'seed'}).locator('input.number').first();
  await seed.fill('8');
  await seed.press('Enter');
  await page.locator('.preset[aria-pressed=false]', {hasText: 'early'}).waitFor();
  const choose = async (item) => {
    await page.getByLabel('more for preset').first().click();
    await page.locator('.menu button', {hasText: item}).click();
  };
  await choose('Rename');
  await answer('late');
  await e.saved(({presets}) => presets.late && !presets.early, 'it is renamed');
  await page.locator('.preset', {hasText: 'late'}).click();
  await e.saved(({parameters}) => parameters.seed.default === 1, 'it is applied');
  await page.locator('.preset[aria-pressed=true]', {hasText: 'late'}).waitFor();
  await choose('Remove');
  await e.saved((graph) => !graph.presets, 'it is removed');
});

scenario("paint a graph's own mask", async () => {
  const e = await Editor.open(wall), {page} = e;
  await look(e, 'stones');
  const picture = page.locator('#view .flat canvas').last();
  await page.getByRole('button', {name: 'Paint', exact: true}).click();
  const at = await middleOf(picture);
  await e.drag({x: at.x - 20, y: at.y}, {x: at.x + 20, y: at.y + 6});
  await page.getByLabel('what takes the mask').selectOption({label: "the graph's mask"});
  await page.locator('.paint').getByRole('button', {name: 'Save'}).click();
  await e.saved(({parameters, nodes}) => parameters.mask.default === 'mask.png' && nodes.holes.path === '$mask', 'the parameter names the mask');
  assert.ok(fs.existsSync(e.folder + '/mask.png'));
  // The graph takes it.
  await look(e, 'filled');
});
