// Called by editor_pictures.sh, in a folder with wall.json: node editor_pictures.mjs PROGRAM CHROMIUM
import fs from 'node:fs';
import path from 'node:path';
import { spawn } from 'node:child_process';
import { createRequire } from 'node:module';

const { chromium } = createRequire(path.join(process.cwd(), 'package.json'))('playwright-core');
const [program, executablePath] = process.argv.slice(2);

// In rows, so that nodes can be read; pictures on those that say most.
const rows = [['exemplar', 'weighted', 'lattice'], ['guides', 'elements', 'space'], ['index', 'layout', 'result'], ['files']];
const places = {};
rows.forEach((row, y) => row.forEach((name, x) => { places[name] = [x * 250, y * 200]; }));
places.files = [750, 400];

const server = spawn(program, ['edit', 'wall.json', '--no-open', '--cache', 'cache'], {stdio: ['ignore', 'pipe', 'inherit']});
const address = await new Promise((done) => {
  let printed = '';
  server.stdout.on('data', (bytes) => { const found = /http:\/\/\S+\s/.exec(printed += bytes); if (found) done(found[0].trim()); });
});
const browser = await chromium.launch({executablePath, args: ['--no-sandbox', '--disable-gpu', '--enable-unsafe-swiftshader']});
const page = await browser.newPage({viewport: {width: 1280, height: 800}, colorScheme: 'dark'});
const pause = (seconds) => page.waitForTimeout(seconds * 1000);
const node = (name) => page.locator(`.svelte-flow__node[data-id="${name}"]`);
const view = page.locator('#view'), picture = page.locator('#view .flat canvas').last();
const button = (name) => view.getByRole('button', {name, exact: true});
/// Until nothing is being made, and what is shown is no coarse look.
async function finished() {
  for (let quiet = 0; quiet < 4; await pause(0.3))
    quiet = await page.evaluate(() => !document.querySelector('#view .pictures .bar') &&
      !/coarse|has no picture/.test(document.querySelector('#view').textContent)) ? quiet + 1 : 0;
}

await page.goto(address);
await page.locator('.saved').waitFor();
await page.evaluate(async (positions) => {
  const ask = (name, body) => fetch('/api/' + name, {method: 'POST', headers: {'Content-Type': 'application/json'}, body: JSON.stringify(body)});
  await ask('edit', {base: 0, edits: [{op: 'move', positions}, {op: 'pin', nodes: ['exemplar', 'layout', 'result'], on: true}]});
}, places);
await page.evaluate(() => { localStorage.setItem('terrazzo.minimap', 'false'); localStorage.setItem('terrazzo.viewShare', '0.52'); });
await page.reload();
await page.locator('.saved').waitFor();
await pause(1);
await page.keyboard.press('f');
await pause(1);
await finished();
for (const name of ['exemplar', 'layout', 'result']) await node(name).locator('img').first().waitFor({timeout: 60000});
await finished();
for (const scheme of ['dark', 'light']) {
  await page.emulateMedia({colorScheme: scheme});
  await pause(0.6);
  await page.screenshot({path: `editor-${scheme}.png`});
}
await page.emulateMedia({colorScheme: 'dark'});

// The editor beside what it has made.
const both = await browser.newPage({viewport: {width: 1645, height: 640}});
const inline = (file) => 'data:image/png;base64,' + fs.readFileSync(file).toString('base64');
await both.setContent(`<body style="margin:0;display:flex;gap:32px;padding:16px;background:#0b0c0e">
  <img style="height:608px;border-radius:6px" src="${inline('editor-dark.png')}"><img style="height:608px;border-radius:6px" src="${inline('result.png')}">`);
await both.waitForFunction(() => [...document.images].every((i) => i.complete && i.naturalWidth));
await both.screenshot({path: 'editor-result.png'});
await both.close();

// The recording. The browser does not draw a pointer by itself.
await page.evaluate(() => {
  const pointer = document.createElement('div');
  pointer.innerHTML = '<svg width="22" height="26" viewBox="0 0 22 26"><path d="M2 2v19l5-5 3.4 8 3.4-1.4-3.4-8h7z" fill="#fff" stroke="#000" stroke-width="1.4"/></svg>';
  pointer.style.cssText = 'position:fixed;left:-40px;top:0;z-index:99999;pointer-events:none';
  document.body.append(pointer);
  addEventListener('pointermove', (event) => { pointer.style.left = event.clientX + 'px'; pointer.style.top = event.clientY + 'px'; }, true);
});
const frames = [], screen = await page.context().newCDPSession(page);
screen.on('Page.screencastFrame', ({data, metadata, sessionId}) => {
  frames.push({data, at: metadata.timestamp});
  screen.send('Page.screencastFrameAck', {sessionId}).catch(() => undefined);  // the recording may have ended
});
let at = {x: 640, y: 400};
async function go(to, seconds = 0.6, rate = 25) {
  const target = to.boundingBox ? await to.boundingBox().then((b) => ({x: b.x + b.width / 2, y: b.y + b.height / 2})) : to;
  const from = at, steps = Math.max(4, Math.round(seconds * rate));
  for (let i = 1; i <= steps; ++i) {
    const part = i / steps, eased = part * part * (3 - 2 * part);
    await page.mouse.move(from.x + (target.x - from.x) * eased, from.y + (target.y - from.y) * eased);
    await pause(seconds / steps / 2);
  }
  at = target;
}
const click = async (to, seconds) => { await go(to, seconds); await page.mouse.down(); await pause(0.08); await page.mouse.up(); };

await screen.send('Page.startScreencast', {format: 'png', maxWidth: 960, maxHeight: 600});
await pause(0.8);
// A number is dragged, and pictures follow.
const seed = page.locator('#panel .field', {hasText: 'seed'}).locator('input.number').first();
await go(seed);
await page.mouse.down();
await go({x: at.x + 90, y: at.y}, 2.2);
await page.mouse.up();
await pause(1.6);
// Pieces of the layout.
await click(node('layout').locator('.head'));
await pause(0.9);
const box = await picture.boundingBox();
for (const [x, y] of [[0.3, 0.35], [0.6, 0.4], [0.5, 0.65], [0.75, 0.6]]) {
  await go({x: box.x + box.width * x, y: box.y + box.height * y}, 0.5);
  await pause(0.45);
}
// Several seeds at once.
await click(node('result').locator('.head'));
await pause(0.4);
await click(button('Sweep'));
await pause(0.3);
await page.getByLabel('values of seed').fill('1..6');
await click(view.locator('.sheet form').getByRole('button').last());
await page.waitForFunction(() => document.querySelectorAll('.cell img').length === 6, null, {timeout: 60000});
await pause(1.2);
await click(page.locator('.cell').nth(2));
await pause(0.3);
await click(page.getByRole('button', {name: 'Take this one'}));
await pause(1.6);
// Lit, with a light that goes round.
await click(button('Lit'));
await view.locator('.lit canvas').waitFor();
await pause(1);
const light = view.getByRole('slider', {name: 'light', exact: true}), track = await light.boundingBox();
const onTrack = (part) => ({x: track.x + track.width * part, y: track.y + track.height / 2});
await go(onTrack(135 / 360));
await page.mouse.down();
// No faster than frames are kept: without a graphics card each step takes a while.
await go(onTrack(0.95), 1.6, 8);
await go(onTrack(0.15), 2, 8);
await page.mouse.up();
await pause(1.2);
await screen.send('Page.stopScreencast');

// At most eight frames a second of what is shown: twenty seconds, however slow the machine is.
frames.sort((a, b) => a.at - b.at);
const took = frames.at(-1).at - frames[0].at, slowness = Math.max(1, took / 20), least = 0.125 * slowness;
const kept = frames.filter((frame, i) => i === 0 || i === frames.length - 1 || Math.floor(frame.at / least) !== Math.floor(frames[i - 1].at / least));
fs.writeFileSync('frames.txt', kept.map(({data, at: time}, i) => {
  const file = `frame-${String(i).padStart(4, '0')}.png`;
  fs.writeFileSync(file, Buffer.from(data, 'base64'));
  const shown = i + 1 < kept.length ? (kept[i + 1].at - time) / slowness : 1.5;
  return `-d ${Math.max(20, Math.round(1000 * shown))} ${file}`;
}).join('\n'));
console.log(`${kept.length} frames of ${took.toFixed(1)} s`);
await browser.close();
server.kill('SIGINT');
