// Bundles the page into a folder: node build.mjs FOLDER. bundle.sh calls it where npm has put the packages.
import { readFileSync } from 'node:fs';
import { fileURLToPath } from 'node:url';
import path from 'node:path';
import { build, transform } from 'esbuild';
import { compile, compileModule } from 'svelte/compiler';

const here = path.dirname(fileURLToPath(import.meta.url));

// Svelte's own compiler is all that a plugin has to call.
const svelte = {
  name: 'svelte',
  setup(pipeline) {
    pipeline.onLoad({filter: /\.svelte$/}, ({path: filename}) => ({
      contents: compile(readFileSync(filename, 'utf8'), {
        filename, generate: 'client', css: 'injected', runes: filename.includes('node_modules') ? undefined : true,
      }).js.code,
    }));
    pipeline.onLoad({filter: /\.svelte\.(ts|js)$/}, async ({path: filename}) => {
      const {code} = await transform(readFileSync(filename, 'utf8'), {
        loader: filename.endsWith('ts') ? 'ts' : 'js', target: 'es2022', sourcefile: filename,
        tsconfigRaw: {compilerOptions: {verbatimModuleSyntax: true}},
      });
      return {contents: compileModule(code, {filename, generate: 'client'}).js.code};
    });
  },
};

await build({
  entryPoints: {app: path.join(here, 'src/main.ts')},
  outdir: process.argv[2],
  bundle: true,
  minify: true,
  format: 'iife',
  target: 'es2022',
  charset: 'ascii',
  legalComments: 'none',
  conditions: ['svelte', 'browser', 'production'],
  mainFields: ['svelte', 'browser', 'module', 'main'],
  // The lit view lies with the reports, outside this folder; its packages are here.
  nodePaths: [path.join(here, 'node_modules')],
  define: {'process.env.NODE_ENV': '"production"'},
  plugins: [svelte],
});
