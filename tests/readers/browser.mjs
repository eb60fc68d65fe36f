// One headless Chromium in which pages are opened one after another, driven through a pipe (the DevTools protocol). Pages
// that import modules come from a server on this machine: `/pages/NAME` is a file of this folder, any other path one of
// the working folder, which also has node_modules.
import fs from 'fs';
import http from 'http';
import path from 'path';
import { spawn } from 'child_process';
import { fileURLToPath } from 'url';

const pages = path.dirname(fileURLToPath(import.meta.url)), folder = process.cwd();
const types = {
  '.html': 'text/html', '.js': 'text/javascript', '.wasm': 'application/wasm', '.png': 'image/png', '.jpg': 'image/jpeg',
};

// Only what lies in the two folders.
function fileOf(url) {
  const name = decodeURIComponent(url.pathname);
  const [root, rest] = name.startsWith('/pages/') ? [pages, name.slice(7)] : [folder, name];
  const found = path.join(root, rest);
  if (!found.startsWith(root + path.sep)) throw new Error(`${name} is not served`);
  // A package of the registry imports its own package.json as a module.
  if (found.endsWith('package.json')) return ['text/javascript', 'export default ' + fs.readFileSync(found)];
  return [types[path.extname(found)] ?? 'application/octet-stream', fs.readFileSync(found)];
}

function serve(request, response) {
  if (request.url === '/favicon.ico') return response.writeHead(204).end();  // browsers ask for it
  try {
    const [type, bytes] = fileOf(new URL(request.url, 'http://localhost'));
    response.writeHead(200, {'Content-Type': type});
    response.end(bytes);
  } catch (error) {
    response.writeHead(404);
    response.end(String(error));
  }
}

const textOf = thing => thing.value !== undefined ? String(thing.value) : thing.description ?? thing.type;

export class Browser {
  #process; #server; #session; #waiting = new Map(); #last = 0; #part = ''; #loaded; #page;
  console = [];  // what has appeared there since the page was opened

  // `seconds`: after which a page that does not get on is a failure.
  static async start(chromium, seconds = 120) {
    const browser = new Browser();
    browser.seconds = seconds;
    browser.#server = http.createServer(serve);
    await new Promise(done => browser.#server.listen(0, '127.0.0.1', done));
    browser.#process = spawn(chromium, [
      '--headless=new', '--no-sandbox', '--disable-breakpad', '--use-gl=angle', '--use-angle=swiftshader',
      '--enable-unsafe-swiftshader', '--no-first-run', '--remote-debugging-pipe',
      `--user-data-dir=${path.join(folder, 'profile')}`, 'about:blank',
    ], {stdio: ['ignore', 'ignore', 'ignore', 'pipe', 'pipe'], detached: true});
    browser.#process.on('exit', () => browser.#fail('the browser ended'));
    process.on('exit', () => browser.#kill());
    browser.#process.stdio[4].setEncoding('utf8').on('data', text => browser.#read(text));
    const {targetInfos} = await browser.#call('Target.getTargets');
    const {targetId} = targetInfos.find(target => target.type === 'page') ??
      await browser.#call('Target.createTarget', {url: 'about:blank'});
    browser.#session = (await browser.#call('Target.attachToTarget', {targetId, flatten: true})).sessionId;
    for (const domain of ['Page', 'Runtime', 'Log']) await browser.#call(domain + '.enable');
    return browser;
  }

  // Opens a page, a path of the server or a URL, and waits until the condition holds in it; `before`: a script that runs
  // before those of the page.
  async open(page, {until = 'true', width = 1000, before = ''} = {}) {
    this.console = [];
    await this.#call('Emulation.setDeviceMetricsOverride', {width, height: 900, deviceScaleFactor: 1, mobile: false});
    const script = before && (await this.#call('Page.addScriptToEvaluateOnNewDocument', {source: before})).identifier;
    const loaded = new Promise(done => { this.#loaded = done; });
    const url = page.startsWith('/') ? `http://127.0.0.1:${this.#server.address().port}${page}` : page;
    const {errorText} = await this.#call('Page.navigate', {url});
    if (errorText) throw new Error(`${page}: ${errorText}`);
    await this.#within(loaded, page);
    if (script) await this.#call('Page.removeScriptToEvaluateOnNewDocument', {identifier: script});
    this.#page = page;
    await this.evaluate(`new Promise(done => {
      const look = () => ${until} ? done() : setTimeout(look, 10);
      look();
    })`);
  }

  // Its value, or that of its promise.
  async evaluate(expression) {
    const {result, exceptionDetails: wrong} =
      await this.#call('Runtime.evaluate', {expression, awaitPromise: true, returnByValue: true});
    if (wrong) throw new Error(`${expression}: ${wrong.exception?.description ?? wrong.text}`);
    return result.value;
  }

  // Lets a page of this folder do a job (work.js), and adds the errors and the seconds it took.
  async work(job) {
    const begun = performance.now(), page = `/pages/${job.page}.html`;
    if (page !== this.#page) await this.open(page, {until: 'globalThis.work'});
    const told = await this.evaluate(`work(${JSON.stringify(job)})`), seconds = (performance.now() - begun) / 1000;
    // MaterialX' library says so of whatever is no number and no image.
    const errors = this.console.splice(0).filter(text => /^(error|warning)/.test(text) && !text.includes('MaterialX: Unsupported uniform'));
    return {...told, errors, seconds: +seconds.toFixed(1)};
  }

  close() {
    this.#process.removeAllListeners();
    this.#kill();
    this.#server.close();
    this.#server.closeAllConnections();
  }

  #call(method, params = {}) {
    const id = ++this.#last;
    const answer = new Promise((done, failed) => this.#waiting.set(id, {done, failed}));
    this.#process.stdio[3].write(JSON.stringify({id, method, params, sessionId: this.#session}) + '\0');
    return this.#within(answer, method);
  }

  // A browser that says nothing for so long hangs.
  async #within(promise, what) {
    let timer;
    const late = new Promise((_, failed) => {
      timer = setTimeout(() => failed(new Error(`${what}: nothing for ${this.seconds} seconds`)), 1000 * this.seconds);
    });
    try {
      return await Promise.race([promise, late]);
    } finally {
      clearTimeout(timer);
    }
  }

  #read(text) {
    const messages = (this.#part + text).split('\0');
    this.#part = messages.pop();
    for (const message of messages) this.#hear(JSON.parse(message));
  }

  #hear({id, result, error, method, params}) {
    if (id) {
      const {done, failed} = this.#waiting.get(id);
      this.#waiting.delete(id);
      error ? failed(new Error(error.message)) : done(result);
    } else if (method === 'Page.loadEventFired') {
      this.#loaded?.();
    } else if (method === 'Runtime.exceptionThrown') {
      const {exception, text} = params.exceptionDetails;
      this.#note('error', exception?.description ?? text);
    } else if (method === 'Runtime.consoleAPICalled') {
      this.#note(params.type, params.args.map(textOf).join(' '));
    } else if (method === 'Log.entryAdded') {
      this.#note(params.entry.level, `${params.entry.text} ${params.entry.url ?? ''}`.trim());
    }
  }

  #note(level, text) {
    // Of what drawing costs without a graphics card.
    if (!text.includes('GL Driver Message (OpenGL, Performance')) this.console.push(`${level}: ${text}`);
  }

  #fail(message) {
    for (const {failed} of this.#waiting.values()) failed(new Error(message));
    this.#waiting.clear();
  }

  #kill() {
    try {
      process.kill(-this.#process.pid, 'SIGKILL');
    } catch {}  // it has ended
  }
}

// Collects what does not hold, and prints it.
export class Checks {
  failed = false;
  #about = '';

  // What the checks from now on are about.
  about(what) {
    this.#about = what;
  }

  holds(condition, what) {
    if (condition) return;
    console.error(`${this.#about}: ${what}`);
    this.failed = true;
  }

  // Whether `told` has these values.
  equal(told, expected) {
    for (const [name, value] of Object.entries(expected))
      this.holds(String(told[name]) === String(value), `expected ${name} "${value}", found "${told[name]}"`);
  }
}
