#!/usr/bin/env bash
# In Svelte Flow and React Flow a click on one of several selected nodes changes nothing, and after a box goes unheard.
#
# Version:   @xyflow/svelte 1.7.0 with svelte 5.57.3, @xyflow/react 12.12.1 with react 19.3.1, litegraph.js 0.7.18,
#            @comfyorg/litegraph 0.17.2 (npm); chromium 150.0.7871.100-1~deb12u1 (Debian 12)
# Guess:     a plain click on a node selects it alone, whatever was selected before, as icons in a file manager.
# Behaviour: so it is in litegraph.js and ComfyUI's. The other two keep all that were selected. After Ctrl and clicks the
#            page is told of the click, and can select the node itself. After a box it is not: the box round the selected
#            nodes stays on top of them and takes the click.
# Matters:   a panel for the parameters of the one selected node cannot be had by clicking that node; one has to click the
#            empty canvas first. What a page does on clicks on nodes, such as opening a preview, fails after boxes only.
# Seen on 2026-11-28, the selected ones of 0 1 2 before a click on 0 and after it:
#   svelte, by Ctrl: 0 1, then 0 1; clicks heard: 1
#   svelte, by a box: 0 1, then 0 1; clicks heard: 0
#   react, by Ctrl: 0 1, then 0 1; clicks heard: 1
#   react, by a box: 0 1, then 0 1; clicks heard: 0
#   litegraph, by Ctrl: 0 1, then 0
#   litegraph, by a box: 0 1, then 0
#   comfyui, by Ctrl: 0 1, then 0
#   comfyui, by a box: 0 1, then 0
. "$(dirname "$0")/common/pages.bash"
web_packages @xyflow/svelte@1.7.0 svelte@5.57.3 @xyflow/react@12.12.1 react@19.3.1 react-dom@19.3.1 litegraph.js@0.7.18 \
  @comfyorg/litegraph@0.17.2

# Three nodes in a row.
cat >flow.js <<'JS'
export const nodes = [0, 1, 2].map((i) =>
  ({id: `${i}`, position: {x: 50 + 220 * i, y: 200}, width: 140, height: 60, data: {label: ''}}));
export const hear = () => { ++window.heard; };
window.heard = 0;
window.selected = () => [...document.querySelectorAll('.selected[data-id]')].map((node) => node.dataset.id).join(' ');
JS
cat >Page.svelte <<'SVELTE'
<script>
  import {SvelteFlow} from '@xyflow/svelte';
  import {hear, nodes as all} from './flow.js';
  let nodes = $state.raw(all), edges = $state.raw([]);
</script>
<SvelteFlow bind:nodes bind:edges onnodeclick={hear} />
SVELTE
cat >svelte.js <<'JS'
import '@xyflow/svelte/dist/style.css';
import {mount} from 'svelte';
import Page from './Page.svelte';
mount(Page, {target: document.querySelector('main')});
JS
cat >react.js <<'JS'
import '@xyflow/react/dist/style.css';
import {createElement} from 'react';
import {createRoot} from 'react-dom/client';
import {ReactFlow, useNodesState} from '@xyflow/react';
import {hear, nodes as all} from './flow.js';
function Page() {
  const [nodes, , onNodesChange] = useNodesState(all);
  return createElement(ReactFlow, {nodes, edges: [], onNodesChange, onNodeClick: hear});
}
createRoot(document.querySelector('main')).render(createElement(Page));
JS
cat >lite.js <<'JS'
export function show({LiteGraph, LGraph, LGraphCanvas}, Node) {
  document.querySelector('main').innerHTML = '<canvas width="800" height="600"></canvas>';
  LiteGraph.registerNodeType('a/node', Node);
  const graph = new LGraph(), view = new LGraphCanvas(document.querySelector('canvas'), graph);
  const nodes = [0, 1, 2].map((i) => {
    const node = LiteGraph.createNode('a/node');
    Object.assign(node, {pos: [50 + 220 * i, 200], size: [140, 60]});
    graph.add(node);
    return node;
  });
  window.selected = () => nodes.flatMap((node, i) => view.selected_nodes[node.id] ? [i] : []).join(' ');
}
JS
cat >litegraph.js <<'JS'
import * as library from 'litegraph.js';
import {show} from './lite.js';
show(library, function() {});
JS
cat >comfyui.js <<'JS'
import * as library from '@comfyorg/litegraph';
import {show} from './lite.js';
library.CanvasPointer.bufferTime = 5000;  // for slow computers, where a click takes longer
show(library, class extends library.LGraphNode {});
JS
cat >look.mjs <<'JS'
import {browser, given, library, page, pause} from './page.mjs';
const {mouse, keyboard} = page, isFlow = ['svelte', 'react'].includes(library);
async function click(i) {
  await mouse.click(120 + 220 * i, 235);
  await pause(600);  // or two would be a double click
}
if (given[0] === 'Ctrl') {
  await click(0);
  await keyboard.down('Control');
  await click(1);
  await keyboard.up('Control');
} else {
  const key = isFlow ? 'Shift' : 'Control';
  await keyboard.down(key);
  await mouse.move(10, 100);
  await mouse.down();
  await mouse.move(440, 400, {steps: 10});
  await mouse.up();
  await keyboard.up(key);
  await pause(600);
}
const look = () => page.evaluate(() => ({ids: selected(), heard: window.heard})), before = await look();
await click(0);
const after = await look();
console.log(`${before.ids}, then ${after.ids}${isFlow ? `; clicks heard: ${after.heard - before.heard}` : ''}`);
await browser.close();
JS
bundle svelte react litegraph comfyui
for flow in svelte react; do
  expect "$flow, by Ctrl" "$(look $flow Ctrl)" "0 1, then 0 1; clicks heard: 1"
  expect "$flow, by a box" "$(look $flow box)" "0 1, then 0 1; clicks heard: 0"
done
for lite in litegraph comfyui; do
  expect "$lite, by Ctrl" "$(look $lite Ctrl)" "0 1, then 0"
  expect "$lite, by a box" "$(look $lite box)" "0 1, then 0"
done
finish
