// Makes out/NAME.js and out/NAME.css of each NAME.js, and of the Svelte components it imports.
import fs from 'fs';
import {build} from 'esbuild';
import {compile, compileModule} from 'svelte/compiler';
const compiled = (call, more) => ({path: filename}) =>
  ({contents: call(fs.readFileSync(filename, 'utf8'), {filename, generate: 'client', ...more}).js.code});
const svelte = {
  name: 'svelte',
  setup(pipeline) {
    pipeline.onLoad({filter: /\.svelte$/}, compiled(compile, {css: 'injected'}));
    pipeline.onLoad({filter: /\.svelte\.js$/}, compiled(compileModule));
  },
};
await build({entryPoints: process.argv.slice(2), outdir: 'out', bundle: true, format: 'iife', plugins: [svelte],
             conditions: ['svelte', 'browser'], define: {'process.env.NODE_ENV': '"production"'}});
