#!/usr/bin/env bash
# MaterialX and three disagree on which pictures a colorspace applies to, both ways round.
#
# Version:   @needle-tools/materialx 1.4.6 (MaterialX 1.39.4), three 0.187.0, linkedom 0.18.12 (npm)
# Guess:     both decode whatever is marked srgb_texture, itself or by its document, and nothing else.
# Behaviour: MaterialX' shader generator decodes colours alone: on a float or a vector3 the mark does nothing. three's
#            MaterialXLoader decodes floats and vectors too; but a mark on the document, which MaterialX passes on to every
#            colour in it, three does not pass on.
# Matters:   a roughness map with a stray colorspace is right in MaterialX' own viewer and too smooth on the web; a document
#            in srgb_texture is right in the viewer and too bright on the web. Mark every colour file, and nothing else.
# Seen on 2026-11-27:
#   MaterialX, marked color3, vector3, float; color3 in a marked document: decoded as-it-is as-it-is decoded
#   three, marked color3, vector3, float; color3 in a marked document: decoded decoded decoded as-it-is
. "$(dirname "$0")/common/packages.bash"
node_packages @needle-tools/materialx@1.4.6 three@0.187.0 linkedom@0.18.12

cat >documents.mjs <<'JS'
const document = (type, input, file, root) => `<?xml version="1.0"?>
<materialx version="1.39" colorspace="${root}">
  <nodegraph name="maps">
    <image name="map" type="${type}"><input name="file" type="filename" value="a.png" ${file}/></image>
    <output name="out" type="${type}" nodename="map"/>
  </nodegraph>
  <standard_surface name="surface" type="surfaceshader">
    <input name="${input}" type="${type}" nodegraph="maps" output="out"/>
  </standard_surface>
  <surfacematerial name="stone" type="material">
    <input name="surfaceshader" type="surfaceshader" nodename="surface"/>
  </surfacematerial>
</materialx>`;
const marked = 'colorspace="srgb_texture"';
export const documents = [
  [document('color3', 'base_color', marked, 'lin_rec709'), 'colorNode'],
  [document('vector3', 'normal', marked, 'lin_rec709'), 'normalNode'],
  [document('float', 'specular_roughness', marked, 'lin_rec709'), 'roughnessNode'],
  [document('color3', 'base_color', '', 'srgb_texture'), 'colorNode'],
];
export const say = decoded => decoded ? 'decoded' : 'as-it-is';
JS
cat >materialx.mjs <<'JS'
import fs from 'fs';
import {createRequire} from 'module';
import {documents, say} from './documents.mjs';
const folder = new URL('node_modules/@needle-tools/materialx/bin/', import.meta.url).pathname;
globalThis.require = createRequire(import.meta.url);  // the module is for browsers
globalThis.__dirname = folder;
const {default: start} = await import(folder + 'JsMaterialXGenShader.js');
const library = new Uint8Array(fs.readFileSync(folder + 'JsMaterialXGenShader.data.txt')).buffer;
const mx = await start({wasmBinary: fs.readFileSync(folder + 'JsMaterialXGenShader.wasm'),
                        getPreloadedPackage: () => library, locateFile: name => folder + name});
const generator = mx.EsslShaderGenerator.create(), context = new mx.GenContext(generator);
const standard = mx.loadStandardLibraries(context);
const out = [];
for (const [text] of documents) {
  const document = mx.createDocument();
  await mx.readFromXmlString(document, text);
  document.setDataLibrary(standard);
  const source = generator.generate('stone', document.getNode('stone'), context).getSourceCode('pixel');
  out.push(say(/srgb_texture_to/.test(source.slice(source.lastIndexOf('void main')))));
}
console.log(...out);
JS
cat >three.mjs <<'JS'
import {DOMParser} from 'linkedom';
import {documents, say} from './documents.mjs';
const element = {addEventListener() {}, removeEventListener() {}};
Object.assign(globalThis, {DOMParser, self: globalThis, document: {createElementNS: () => element}});
const {MaterialXLoader} = await import('three/addons/loaders/MaterialXLoader.js');
// Whether a function is called on the texture that is not called where nothing is marked.
const calls = (node, seen = new Set()) => {
  if (!node || typeof node !== 'object' || seen.has(node)) return 0;
  seen.add(node);
  let count = node.functionNode || node.constructor.name.startsWith('ShaderCall') ? 1 : 0;
  for (const value of Object.values(node))
    for (const next of Array.isArray(value) ? value : [value]) if (next?.isNode || next?.shaderNode) count += calls(next, seen);
  return count;
};
const count = (text, slot) => calls(Object.values(new MaterialXLoader().parse(text).materials)[0][slot]);
const out = [];
for (const [text, slot] of documents)
  out.push(say(count(text, slot) > count(text.replaceAll(/ colorspace="srgb_texture"/g, ' colorspace="lin_rec709"'), slot)));
console.log(...out);
JS
what="marked color3, vector3, float; color3 in a marked document"
expect "MaterialX, $what" "$(node materialx.mjs 2>&1 | tail -n 1 | cut -c -200)" "decoded as-it-is as-it-is decoded"
expect "three, $what" "$(node three.mjs 2>&1 | tail -n 1 | cut -c -200)" "decoded decoded decoded as-it-is"
finish
