// The keyboard on the canvas. The help sheet lists the same keys.
import { canvas, focusCanvas, focusNode } from '../state/canvas.svelte.ts';
import { runs } from '../state/runs.svelte.ts';
import { session } from '../state/session.svelte.ts';
import { ui } from '../state/ui.svelte.ts';
import * as act from './actions.ts';
import { bendSelected, nextBend } from './bends.ts';
import { bendMenu, frameMenu, look, nodeMenu, paneMenu, wireMenu } from './menus.ts';
import { cardHeight, wireOf } from './model.ts';

// The node that was walked to last: of several selected ones, the one to go on from.
let reached = '';

// Left and right go along wires, up and down to the nearest node; without wires all four do. With Shift, nodes on the way
// stay selected.
function walk(key: string, isExtended: boolean) {
  const {level} = session, from = canvas.current ?? (canvas.selected.includes(reached) ? reached : canvas.selected[0]);
  const node = level.nodes.find((n) => n.name === from);
  if (!node) {
    const first = [...level.nodes].sort((a, b) => a.x - b.x || a.y - b.y)[0];
    if (first) canvas.go(first.name);
    return;
  }
  const middle = (n: typeof node) => n.y + cardHeight(n, n.pinned) / 2;
  const along = key === 'ArrowLeft' ? level.nodes.filter((n) => node.wires.some((w) => w.node === n.name))
    : key === 'ArrowRight' ? level.nodes.filter((n) => n.wires.some((w) => w.node === node.name)) : [];
  const distance = (n: typeof node) => {
    const dx = n.x - node.x, dy = middle(n) - middle(node);
    const ahead = {ArrowLeft: -dx, ArrowRight: dx, ArrowUp: -dy, ArrowDown: dy}[key]!;
    const aside = key === 'ArrowLeft' || key === 'ArrowRight' ? dy : dx;
    return ahead <= 0 ? Infinity : ahead + 2 * Math.abs(aside);
  };
  const candidates = along.length ? along : level.nodes.filter((n) => n !== node && distance(n) < Infinity);
  const measure = along.length ? (n: typeof node) => Math.abs(middle(n) - middle(node)) + Math.abs(n.x - node.x) * 0.1 : distance;
  const next = candidates.sort((a, b) => measure(a) - measure(b))[0];
  if (!next) return;
  reached = next.name;
  canvas.go(next.name, isExtended ? canvas.selected : []);
}

// The wires of the node in turn, so that each can be removed.
function nextWire() {
  const at = canvas.selectedWires[0];
  const node = canvas.current ?? (at ? wireOf(at).node : undefined);
  const wires = node ? canvas.wiresOf(node) : canvas.edges;
  if (!wires.length) return;
  const next = wires[(wires.findIndex((w) => w.id === at) + 1) % wires.length]!;
  canvas.select(node ? [node] : [], [next.id]);
  // Delete must mean the wire alone.
  canvas.nodes = canvas.nodes.map((n) => n.selected ? {...n, selected: false} : n);
}

function menuByKey() {
  const name = canvas.selected[0], frame = canvas.selectedFrames[0], wire = canvas.selectedWires[0], {bend} = canvas;
  const id = name ?? (frame === undefined ? undefined : 'frame:' + frame);
  const element = id !== undefined ? `.svelte-flow__node[data-id="${CSS.escape(id)}"]` : bend ? '.bend.picked' : wire ? `.svelte-flow__edge[data-id="${CSS.escape(wire)}"] path` : '';
  const box = element ? document.querySelector(element)?.getBoundingClientRect() : null;
  const at = !box ? canvas.pane?.centre().screen ?? {x: 200, y: 200} : id === undefined ? {x: box.left + box.width / 2, y: box.top + box.height / 2} : {x: box.left + 20, y: box.top + 30};
  if (name !== undefined) nodeMenu(at, name);
  else if (frame !== undefined) frameMenu(at, frame);
  else if (bend) bendMenu(at, bend.wire, bend.index);
  else if (wire) wireMenu(at, wire);
  else paneMenu(at);
}

const withControl: Record<string, (event: KeyboardEvent) => void> = {
  z: (event) => void (event.shiftKey ? session.redo() : session.undo()),
  y: () => void session.redo(),
  a: () => canvas.select(session.level.nodes.map((n) => n.name)),
  c: () => void act.copySelected(),
  x: () => void act.copySelected(true),
  d: () => void act.duplicate(),
  g: (event) => event.shiftKey ? void (canvas.current && act.ungroup(canvas.current)) : act.group(),
  f: () => { ui.finding = true; },
  s: () => session.say(session.document?.saved ? 'Every edit is saved as it is made.' : 'Being saved.'),
  Enter: () => void runs.run(true),
};

const plain: Record<string, (event: KeyboardEvent) => void> = {
  ' ': act.openBehind,
  Tab: () => act.openPalette(),
  Delete: () => void act.removeSelected(),
  Backspace: () => void act.removeSelected(),
  m: () => act.setOnSelected('mute'),
  p: () => act.setOnSelected('pin'),
  f: (event) => event.shiftKey ? act.frame() : canvas.pane?.fit(),
  c: () => { if (canvas.current) ui.connecting = {node: canvas.current}; },
  l: () => { if (canvas.current) look(canvas.current); },
  u: () => session.leave(),
  w: nextWire,
  b: (event) => event.shiftKey ? nextBend() : bendSelected(),
  v: () => { ui.viewOpen = !ui.viewOpen; ui.keep(); },
  F2: () => { if (canvas.current) act.rename(canvas.current); else if (canvas.selectedFrames[0]) act.retitle(canvas.selectedFrames[0]); },
  Enter: () => { if (canvas.current && !session.enter(canvas.current)) look(canvas.current); },
  '+': () => canvas.pane?.zoomBy(1.25),
  '=': () => canvas.pane?.zoomBy(1.25),
  '-': () => canvas.pane?.zoomBy(0.8),
  '0': () => canvas.pane?.zoomTo(1),
  ContextMenu: menuByKey,
  F10: (event) => { if (event.shiftKey) menuByKey(); },
  Escape: () => { canvas.select([]); focusCanvas(); },
};

// What changes the graph, or writes files, where it is only shown: the page says so, and nothing happens.
const changing = new Set(['Delete', 'Backspace', 'F2', 'Tab', ' ', 'm', 'p', 'c', 'b']);
const changingWithControl = new Set(['z', 'y', 'x', 'd', 'g', 'Enter']);

const writes = 'input, textarea, select, [contenteditable]';
const regions = ['#canvas', '#panel', '#view', '#bar'];

export function onkeydown(event: KeyboardEvent) {
  if (event.defaultPrevented || ui.anyOpen()) return;
  const target = event.target as HTMLElement;
  // A number that is not being typed, a slider or a choice has nothing of its own to undo.
  const undoes = (event.ctrlKey || event.metaKey) && ['z', 'y'].includes(event.key.toLowerCase());
  const isWriting = target.matches?.(writes) && !(undoes && target.matches('.number:not([data-typed]), [type=range], [type=checkbox], select'));
  const onCanvas = target === document.body || !!target.closest?.('#canvas');
  const take = () => event.preventDefault();
  if (event.key === 'F6') {
    take();
    const at = Math.max(0, regions.findIndex((region) => target.closest?.(region)));
    for (let step = 1; step <= regions.length; ++step) {
      const region = document.querySelector<HTMLElement>(regions[(at + (event.shiftKey ? -step : step) + 2 * regions.length) % regions.length]!);
      if (!region) continue;
      if (region.id === 'canvas') { if (canvas.current) focusNode(canvas.current); else region.focus(); }
      else region.querySelector<HTMLElement>('button, input, select, textarea, [tabindex="0"]')?.focus();
      return;
    }
  }
  if (isWriting) return;
  if (event.key === '?') { take(); ui.help = true; return; }
  if (event.ctrlKey || event.metaKey) {
    const key = event.key.length === 1 ? event.key.toLowerCase() : event.key, known = withControl[key];
    if (session.readOnly && changingWithControl.has(key)) { if (onCanvas) session.say('This graph is shown read-only.'); return; }
    const copies = ['c', 'x'].includes(event.key.toLowerCase()) && !!getSelection()?.toString();
    if (known && !copies && (onCanvas || ['z', 'y', 'f', 's', 'Enter'].includes(event.key.toLowerCase()) || event.key === 'Enter')) { take(); known(event); }
    return;
  }
  // Buttons keep their keys.
  if (!onCanvas || (target.closest?.('button') && ['Enter', ' ', 'Tab'].includes(event.key))) return;
  if (event.key.startsWith('Arrow')) {
    take();
    const [x, y] = {ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1]}[event.key]!;
    const step = event.shiftKey ? 64 : 16;
    if (event.altKey && session.readOnly) return;
    return event.altKey ? act.nudge(x! * step, y! * step) : walk(event.key, event.shiftKey);
  }
  if (event.altKey || (event.key === 'Tab' && event.shiftKey)) return;
  const key = event.key.length === 1 ? event.key.toLowerCase() : event.key, known = plain[key];
  if (session.readOnly && (changing.has(key) || key === 'f' && event.shiftKey)) {
    if (key !== 'Tab') session.say('This graph is shown read-only.');
    return;
  }
  if (known) { take(); known(event); }
}

// The event of pasting carries the text without asking for a permission.
export function onpaste(event: ClipboardEvent) {
  const target = event.target as HTMLElement;
  if (session.readOnly || target.matches?.(writes) || ui.anyOpen() || !(target === document.body || target.closest?.('#canvas'))) return;
  event.preventDefault();
  void act.paste(event.clipboardData?.getData('text/plain') ?? '');
}
