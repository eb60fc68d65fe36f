#!/usr/bin/env bash
# Svelte Flow and React Flow that draw only what is in sight cannot fit nodes whose sizes and handles are stated.
#
# Version:   @xyflow/svelte 1.7.0 with svelte 5.57.3, @xyflow/react 12.12.1 with react 19.3.1 (npm); chromium
#            150.0.7871.100-1~deb12u1 (Debian 12)
# Guess:     with onlyRenderVisibleElements, too, fitView shows all nodes, at the latest if each states its size.
# Behaviour: with width and height alone it does, for then each node is drawn once. With handles as well, only those in
#            sight are: the property fitView shows the node at the origin alone, fitView() moves nothing, and its promise
#            is pending. It is kept for later: once a pan brings another node into sight, the view jumps away under the
#            pointer, to the nodes seen so far. With `measured` stated, too, all is well.
# Matters:   large graphs are the ones that draw only what is in sight and state what they know, as rendering on a server
#            wants it. Their button to fit seems dead, then moves the view in the middle of a drag, and what awaits
#            fitView() hangs. State `measured`, or set the viewport oneself.
# Seen on 2026-11-28, the nodes in sight of 0 1 2 3 at first, then after fitView(), then the zoom before and after a pan:
#   svelte, sizes: 0 1 2 3; 0 1 2 3, done; 0.26 and 0.26, done
#   svelte, sizes handles: 0; 0, pending; 1.00 and 0.73, done
#   svelte, sizes handles measured: 0 1 2 3; 0 1 2 3, done; 0.26 and 0.26, done
#   react, sizes: 0 1 2 3; 0 1 2 3, done; 0.26 and 0.26, done
#   react, sizes handles: 0; 0, pending; 1.00 and 0.73, done
#   react, sizes handles measured: 0 1 2 3; 0 1 2 3, done; 0.26 and 0.26, done
. "$(dirname "$0")/common/pages.bash"
web_packages @xyflow/svelte@1.7.0 svelte@5.57.3 @xyflow/react@12.12.1 react@19.3.1 react-dom@19.3.1

# Four nodes in a row, of which a view that was not moved shows the first. What they state is in `given`.
cat >nodes.js <<'JS'
const port = (type, position, x) => ({type, position, x, y: 20, width: 1, height: 1});
const stated = {
  sizes: {width: 100, height: 40},
  handles: {handles: [port('target', 'left', 0), port('source', 'right', 99)]},
  measured: {measured: {width: 100, height: 40}},
};
const known = Object.assign({}, ...given.map((what) => stated[what]));
export const nodes = [0, 1, 2, 3].map((i) => ({id: `${i}`, position: {x: 900 * i, y: 0}, data: {label: ''}, ...known}));
export const options = {onlyRenderVisibleElements: true, fitView: true, minZoom: 0.05};
JS
cat >Page.svelte <<'SVELTE'
<script>
  import {SvelteFlow} from '@xyflow/svelte';
  import {nodes as all, options} from './nodes.js';
  import Hold from './Hold.svelte';
  let nodes = $state.raw(all), edges = $state.raw([]);
</script>
<SvelteFlow bind:nodes bind:edges {...options}><Hold /></SvelteFlow>
SVELTE
cat >Hold.svelte <<'SVELTE'
<script>
  import {useSvelteFlow} from '@xyflow/svelte';
  window.flow = useSvelteFlow();
</script>
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
import {nodes as all, options} from './nodes.js';
function Page() {
  const [nodes, , onNodesChange] = useNodesState(all);
  return createElement(ReactFlow, {nodes, edges: [], onNodesChange, onInit: (flow) => { window.flow = flow; }, ...options});
}
createRoot(document.querySelector('main')).render(createElement(Page));
JS
cat >look.mjs <<'JS'
import {browser, page, pause} from './page.mjs';
const inSight = () => page.evaluate(() => {
  const {x, zoom} = flow.getViewport();
  return [0, 1, 2, 3].filter((i) => x + 900 * i * zoom >= 0 && x + (900 * i + 100) * zoom <= 800).join(' ');
});
const ended = () => page.evaluate(() => window.state), zoom = () => page.evaluate(() => flow.getViewport().zoom.toFixed(2));
const first = await inSight();
await page.evaluate(() => flow.setViewport({x: 0, y: 0, zoom: 1}));
await pause();
await page.evaluate(() => { window.state = 'pending'; flow.fitView().then(() => { window.state = 'done'; }); });
await pause();
const second = `${await inSight()}, ${await ended()}`, before = await zoom();
await page.mouse.move(700, 500);
await page.mouse.down();
for (let x = 700; x >= 500; x -= 10) {
  await page.mouse.move(x, 500);
  await pause(30);
}
await page.mouse.up();
await pause();
console.log(`${first}; ${second}; ${before} and ${await zoom()}, ${await ended()}`);
await browser.close();
JS
bundle svelte react
all="0 1 2 3; 0 1 2 3, done; 0.26 and 0.26, done"
for library in svelte react; do
  expect "$library, sizes" "$(look $library sizes)" "$all"
  expect "$library, sizes handles" "$(look $library sizes handles)" "0; 0, pending; 1.00 and 0.73, done"
  expect "$library, sizes handles measured" "$(look $library sizes handles measured)" "$all"
done
finish
