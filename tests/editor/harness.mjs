// One Chromium for all scenarios, two at a time: they wait more than they work. A running `terrazzo edit` for each.
import assert from 'node:assert/strict';
import { AsyncLocalStorage } from 'node:async_hooks';
import fs from 'node:fs';
import path from 'node:path';
import { spawn } from 'node:child_process';
import { createRequire } from 'node:module';

// The packages lie in the working folder, where editor_test.sh has put them.
const require = createRequire(path.join(process.cwd(), 'package.json'));
const { chromium } = require('playwright-core');
const axe = fs.readFileSync(require.resolve('axe-core/axe.min.js'), 'utf8');

const [program, source, executablePath] = process.argv.slice(2);
export const stock = (name) => fs.readFileSync(path.join(source, 'graphs', name + '.json'), 'utf8');
export { assert };

// Without a graphics card, drawing through an emulated one takes most of the time; no scenario needs WebGL.
const browser = await chromium.launch({executablePath, args: ['--no-sandbox', '--disable-gpu']});
const lanes = 2, laneOf = new AsyncLocalStorage();

// One page for all scenarios of a lane: a new one costs more than most of them.
async function newLane() {
  const context = await browser.newContext(), page = await context.newPage(), errors = [];
  await context.grantPermissions(['clipboard-read', 'clipboard-write']);
  page.on('pageerror', (error) => errors.push(error.stack ?? error.message));
  page.on('console', (message) => {
    // Refused edits and a server that is away are answered by the page itself.
    if (message.type() === 'error' && !/Failed to load resource/.test(message.text())) errors.push(message.text());
  });
  page.setDefaultTimeout(10000);
  return {context, page, errors, open: []};
}

const servers = new Set();
process.on('exit', () => { for (const server of servers) server.kill('SIGKILL'); });

let folders = 0;
export class Editor {
  /// A page that shows a graph of that text, or one that does not exist if it is null, in a folder of its own, which first holds what `prepare` writes into it.
  static async open(text, {args = [], prepare, layout, size = [1280, 800], dark = true} = {}) {
    const editor = new Editor(), lane = laneOf.getStore(), {page} = lane;
    lane.open.push(editor);
    editor.errors = lane.errors;
    editor.folder = path.resolve(`graph-${++folders}`);
    fs.mkdirSync(editor.folder, {recursive: true});
    prepare?.(editor.folder);
    editor.file = path.join(editor.folder, 'graph.json');
    if (text !== null) fs.writeFileSync(editor.file, text);
    if (layout) fs.writeFileSync(path.join(editor.folder, 'graph.layout.json'), layout);
    editor.args = args;
    await editor.start();
    editor.page = page;
    editor.context = lane.context;
    lane.errors.length = 0;
    await page.setViewportSize({width: size[0], height: size[1]});
    await page.emulateMedia({colorScheme: dark ? 'dark' : 'light'});
    await page.goto(editor.address);
    await page.evaluate(() => localStorage.clear());
    await editor.page.waitForFunction(() => document.querySelector('.saved')?.textContent || document.querySelector('.tag'));
    await editor.page.waitForTimeout(300);
    return editor;
  }

  async start(port) {
    this.server = spawn(program, ['edit', this.file, '--no-open', ...(port ? ['--port', String(port)] : []), ...this.args],
                        {cwd: this.folder, stdio: ['ignore', 'pipe', 'inherit'], env: {...process.env, TERRAZZO_CACHE: path.resolve('cache')}});
    servers.add(this.server);
    this.address = await new Promise((done, failed) => {
      let printed = '';
      this.server.stdout.on('data', (bytes) => {
        printed += bytes;
        const found = /http:\/\/\S+/.exec(printed);
        if (found && printed.includes('\n', found.index)) done(found[0]);
      });
      this.server.on('exit', (code) => failed(new Error(`the editor ended with ${code}: ${printed}`)));
    });
    this.portNumber = new URL(this.address).port;
  }
  async kill() {
    const gone = new Promise((done) => this.server.on('exit', done));
    this.server.kill('SIGKILL');
    servers.delete(this.server);
    await gone;
  }

  get text() { return fs.readFileSync(this.file, 'utf8'); }
  /// The document without comments, as far as the scenarios write such.
  get json() { return JSON.parse(this.text); }
  get layout() { return JSON.parse(fs.readFileSync(path.join(this.folder, 'graph.layout.json'), 'utf8')); }
  /// Waits until the positions are so.
  laidOut(holds, what) { return this.saved(() => holds(), `${what} (${fs.existsSync(path.join(this.folder, 'graph.layout.json')) ? JSON.stringify(this.layout) : 'no layout'})`); }
  /// Waits until what is on the disk is so, and the page shows it.
  async saved(holds, what) {
    for (const end = Date.now() + 6000; ;) {
      try {
        if (holds(this.json)) return await this.caughtUp();
      } catch { /* a half-written file, or a node that is not there yet */ }
      if (Date.now() > end) assert.fail(`${what}, but the file says ${this.text}`);
      await new Promise((done) => setTimeout(done, 40));
    }
  }

  /// The program writes before the page hears of it: what is done to the page meanwhile is done to an older state. Some scenarios cut the page off, so this gives up.
  async caughtUp() {
    await this.page.evaluate(async () => {
      const answer = await fetch('/api/state', {method: 'POST', headers: {'Content-Type': 'application/json'}, body: '{}'});
      const {revision} = await answer.json();
      for (let i = 0; i < 100 && Number(document.querySelector('main')?.dataset.revision) < revision; ++i) await new Promise((done) => setTimeout(done, 20));
    }).catch(() => undefined);
  }

  card(name) { return this.page.locator(`.svelte-flow__node[data-id="${name}"]`); }
  port(node, port, side) { return this.card(node).locator(`.svelte-flow__handle.${side}[data-handleid="${port}"]`); }
  wire(id) { return this.page.locator(`.svelte-flow__edge[data-id="${id}"]`); }
  toast(text) { return this.page.locator('.toast', {hasText: text}).first().waitFor(); }
  async press(...keys) { for (const key of keys) await this.page.keyboard.press(key); }
  async type(text) { await this.page.keyboard.type(text); }
  toCanvas() { return this.page.locator('#canvas').focus(); }
  /// All nodes in sight, and the panel about this one.
  async show(name) {
    await this.press('f');
    await this.settle();
    await this.card(name).locator('.head').click();
  }
  /// Until the canvas stands still: nothing moves, comes, goes or is selected any more.
  async settle() {
    const look = () => this.page.evaluate(() => document.querySelector('.svelte-flow__viewport')?.style.transform +
      [...document.querySelectorAll('.svelte-flow__node')].map((n) => n.dataset.id + n.style.transform + n.className).join());
    for (let before = '', now = await look(), same = 0; same < 2; before = now, now = await look()) {
      same = before === now ? same + 1 : 0;
      await this.page.waitForTimeout(70);
    }
  }

  async drag(from, to) {
    const at = async (place) => {
      if (!place.boundingBox) return place;
      const box = await place.boundingBox();
      return {x: box.x + box.width / 2, y: box.y + box.height / 2};
    };
    const [a, b] = [await at(from), await at(to)], {mouse} = this.page;
    await mouse.move(a.x, a.y);
    await mouse.down();
    await mouse.move((a.x + b.x) / 2, (a.y + b.y) / 2, {steps: 4});
    await mouse.move(b.x, b.y, {steps: 4});
    await mouse.up();
  }

  /// The wires that pass behind a card which they do not end at.
  hiddenWires() {
    return this.page.evaluate(() => {
      const cards = [...document.querySelectorAll('.svelte-flow__node-card')].map((n) => [n.dataset.id, n.getBoundingClientRect()]);
      return [...document.querySelectorAll('.svelte-flow__edge')].flatMap((edge) => {
        const path = edge.querySelector('path'), length = path.getTotalLength(), matrix = path.getScreenCTM(), found = new Set();
        for (let step = 0; step <= 80; ++step) {
          const at = path.getPointAtLength(length * step / 80).matrixTransform(matrix);
          for (const [name, b] of cards)
            if (at.x > b.left + 2 && at.x < b.right - 2 && at.y > b.top + 2 && at.y < b.bottom - 2) found.add(`${edge.dataset.id} behind ${name}`);
        }
        return [...found];
      });
    });
  }

  /// By axe-core's rules: all of them, or these.
  async accessible(where, rules) {
    await this.page.evaluate(axe + ';0');
    const found = await this.page.evaluate((only) => axe.run(document, {resultTypes: ['violations'], ...(only ? {runOnly: only} : {})}), rules);
    const told = found.violations.map((v) => `${v.id}: ${v.help}\n` + v.nodes.slice(0, 4).map((n) => '  ' + n.html.slice(0, 200) + '\n  ' + n.failureSummary.replace(/\n/g, ' ').slice(0, 300)).join('\n'));
    assert.equal(told.join('\n'), '', `accessibility of ${where}`);
  }

  async close() {
    const found = [...this.errors];
    await this.page.goto('about:blank');
    if (servers.has(this.server)) await this.kill();
    assert.deepEqual(found, [], 'errors in the page');
  }
}

const scenarios = [];
let clipboard = Promise.resolve();
export const scenario = (name, run) => scenarios.push({name, run});
/// The browser has one clipboard: of these only one is run at a time.
export const scenarioWithClipboard = (name, run) => scenario(name, () => (clipboard = clipboard.catch(() => undefined).then(run)));

async function runOne({name, run}, lane) {
  const start = Date.now();
  lane.open.length = 0;
  try {
    await run();
    for (const editor of lane.open) await editor.close();
    console.log(`${name}: ${((Date.now() - start) / 1000).toFixed(1)} s`);
    return true;
  } catch (error) {
    console.log(`FAILED: ${name}: ${error.stack}`);
    for (const [index, editor] of lane.open.entries()) {
      if (process.env.EDITOR_TEST_PICTURES)
        await lane.page.screenshot({path: path.join(process.env.EDITOR_TEST_PICTURES, `${name.replaceAll(' ', '-')}-${index}.png`)}).catch(() => {});
      console.log(lane.errors.join('\n'));
      await editor.close().catch(() => {});
    }
    return false;
  }
}

/// Runs all, and ends the process: with 1 if one failed.
export async function runAll(filter) {
  const waiting = scenarios.filter(({name}) => !filter || name.includes(filter)), start = Date.now();
  let failed = 0;
  await Promise.all(Array.from({length: Math.min(lanes, waiting.length)}, async () => {
    const lane = await newLane();
    for (let next = waiting.shift(); next; next = waiting.shift())
      if (!await laneOf.run(lane, () => runOne(next, lane))) ++failed;
  }));
  console.log(`all in ${((Date.now() - start) / 1000).toFixed(0)} s`);
  await browser.close();
  process.exit(failed ? 1 : 0);
}
