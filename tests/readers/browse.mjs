// Lets pages in headless Chromium do jobs, and prints what they say of each, one JSON object a line.
// Usage: node browse.mjs CHROMIUM JOBS.json: paths in the jobs are relative to the working folder, which also has
// node_modules. A job's `page` is a page of this folder; a job's picture is written to the path `picture`.
import fs from 'fs';
import http from 'http';
import path from 'path';
import { spawn } from 'child_process';

const [browser, jobsFile] = process.argv.slice(2);
const jobs = JSON.parse(fs.readFileSync(jobsFile));
const pages = path.dirname(new URL(import.meta.url).pathname), folder = process.cwd();
const types = {
  '.html': 'text/html', '.js': 'text/javascript', '.wasm': 'application/wasm', '.png': 'image/png', '.jpg': 'image/jpeg',
};
let chromium, silence, failed = false;

function leave(code) {
  clearTimeout(silence);
  chromium.removeAllListeners();
  process.kill(-chromium.pid, 'SIGKILL');
  process.exit(code);
}

// A browser that says nothing for a while hangs.
function heard() {
  clearTimeout(silence);
  silence = setTimeout(() => { console.error('the browser says nothing'); leave(1); }, 120000);
}

const body = request => new Promise(done => {
  const parts = [];
  request.on('data', part => parts.push(part));
  request.on('end', () => done(Buffer.concat(parts)));
});

// Only what lies in the two folders.
function file(url) {
  const name = decodeURIComponent(url.pathname);
  const [root, rest] = name.startsWith('/pages/') ? [pages, name.slice(7)] : [folder, name];
  const found = path.join(root, rest);
  if (!found.startsWith(root + path.sep)) return null;
  // A package of the registry imports its own package.json as a module.
  if (found.endsWith('package.json')) return ['text/javascript', 'export default ' + fs.readFileSync(found)];
  return [types[path.extname(found)] ?? 'application/octet-stream', fs.readFileSync(found)];
}

const left = [...new Set(jobs.map(job => job.page))];
const server = http.createServer(async (request, response) => {
  heard();
  const url = new URL(request.url, 'http://localhost');
  try {
    if (url.pathname === '/jobs') {
      response.end(JSON.stringify(jobs.filter(job => job.page === url.searchParams.get('page'))));
    } else if (url.pathname === '/picture') {
      fs.writeFileSync(path.join(folder, url.searchParams.get('to')), await body(request));
      response.end();
    } else if (url.pathname === '/told') {
      console.log(String(await body(request)));
      response.end();
    } else if (url.pathname === '/wrong') {
      console.error(String(await body(request)));
      failed = true;
      response.end();
    } else if (url.pathname === '/next') {
      // The next page, or the end.
      const page = left.shift();
      response.end(page ? `/pages/${page}.html` : '');
      if (!page) setTimeout(() => leave(failed ? 1 : 0), 100);
    } else {
      const [type, bytes] = file(url);
      response.writeHead(200, {'Content-Type': type});
      response.end(bytes);
    }
  } catch (error) {
    response.writeHead(404);
    response.end(String(error));
  }
});

server.listen(0, '127.0.0.1', () => {
  const at = `http://127.0.0.1:${server.address().port}`;
  chromium = spawn(browser, [
    '--headless=new', '--no-sandbox', '--disable-breakpad', '--use-gl=angle', '--use-angle=swiftshader',
    '--enable-unsafe-swiftshader', `--user-data-dir=${path.join(folder, 'profile')}`, `${at}/pages/${left.shift()}.html`,
  ], {stdio: 'ignore', detached: true});
  chromium.on('exit', () => { console.error('the browser ended'); leave(1); });
  heard();
});
