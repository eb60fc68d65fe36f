// What can be done with nodes and wires; keys, menus and drops all come here.
import type { Edit, GraphNode, NodeType, Port } from '../state/protocol.ts';
import { canvas, focusCanvas, focusNode } from '../state/canvas.svelte.ts';
import { session } from '../state/session.svelte.ts';
import { ui, type PaletteRequest, type Point } from '../state/ui.svelte.ts';
import { nudgeBend, removeBend } from './bends.ts';
import { bendEdits, isOn } from './drag.ts';
import { firstFit, inputPort, inputsId, newPort, outputsId, reference, uniqueName, whyNot, type End } from './fit.ts';
import { cardHeight, cardWidth, wireOf } from './model.ts';

const count = (names: string[]) => names.length === 1 ? names[0]! : `${names.length} nodes`;
const shownLevel = () => session.level;

/// Says why nothing happens where the graph is only shown.
function isLocked(): boolean {
  if (session.readOnly) session.say('This graph is shown read-only.');
  return session.readOnly;
}

function selectAdded(names: string[] | null) {
  if (!names?.length) return;
  // The canvas takes the new state in an effect.
  requestAnimationFrame(() => {
    canvas.select(names);
    // What was opened meanwhile keeps the keyboard.
    requestAnimationFrame(() => { if (!ui.anyOpen()) focusNode(names[0]!); });
  });
}

export async function connect(from: End, to: End, replace?: {node: string; port: string; index: number}) {
  if (isLocked()) return;
  const why = whyNot(shownLevel(), from, to);
  if (why) return session.say(why, 'error');
  const edits: Edit[] = replace ? [{op: 'disconnect', ...replace}] : [];
  if (to.node === outputsId) {
    const set = (name: string) => session.tryEdit(`output ${name}`, ...edits, {op: 'output', name, from: reference(shownLevel(), from)});
    if (to.port !== newPort) return void set(to.port).catch((error: unknown) => session.complain(error));
    return ui.ask('A new output of the subgraph', from.port, (name) => name && set(name), 'Its name.');
  }
  if (from.port === newPort) {
    const {type, help} = inputPort(shownLevel(), to)!;
    return ui.ask('A new input of the subgraph', to.port, (name) => name && session.tryEdit(`input ${name}`, {op: 'input', name, set: {type, help}}, {op: 'connect', from: name, to: to.node, port: to.port}), 'Its name.');
  }
  edits.push({op: 'connect', from: reference(shownLevel(), from), to: to.node, port: to.port});
  await session.edit(`connect ${from.node === inputsId ? from.port : from.node} to ${to.node}`, ...edits);
}

function disconnection(id: string): Edit {
  const {node, port, index} = wireOf(id);
  return node === outputsId ? {op: 'output', name: port, from: null} : {op: 'disconnect', node, port, index};
}

export const disconnect = (id: string) => session.edit('remove a wire', disconnection(id));

export async function add(type: NodeType, request: PaletteRequest) {
  const level = shownLevel(), name = uniqueName(level, type.name), edits: Edit[] = [];
  let at = request.at ?? canvas.pane?.centre().canvas ?? {x: 0, y: 0};
  const behind = request.behind ? session.node(request.behind) : undefined;
  if (behind) at = {x: behind.x + cardWidth + 48, y: behind.y};
  at = {x: at.x, y: freeRow(at.x, at.y)};
  edits.push({op: 'add', type: type.name, name, x: Math.round(at.x), y: Math.round(at.y)});
  if (behind) {
    const output = behind.outputs.find((o) => firstFit(type.inputs, o.type));
    const port = output && firstFit(type.inputs, output.type);
    if (output && port)
      edits.push({op: 'connect', from: reference(level, {node: behind.name, port: output.name}), to: name, port: port.name});
  } else if (request.wire) {
    const {node, port, side} = request.wire;
    if (side === 'source') {
      const input = firstFit(type.inputs, port.type);
      if (input) edits.push({op: 'connect', from: reference(level, {node, port: port.name}), to: name, port: input.name});
    } else {
      const output = firstFit(type.outputs, port.type);
      if (output) edits.push({op: 'connect', from: type.outputs[0] === output ? name : `${name}.${output.name}`, to: node, port: port.name});
    }
  }
  selectAdded(await session.edit('add ' + type.name, ...edits));
}

// Below what stands there already.
function freeRow(x: number, y: number): number {
  for (let row = y; ; row += 24)
    if (!session.level.nodes.some((n) => Math.abs(n.x - x) < cardWidth && row < n.y + cardHeight(n, n.pinned) && n.y < row + 90))
      return row;
}

export async function removeSelected() {
  if (isLocked()) return;
  if (canvas.bend) return removeBend(canvas.bend.wire, canvas.bend.index);
  const nodes = canvas.selected, wires = canvas.selectedWires, frames = canvas.selectedFrames;
  const edits: Edit[] = [];
  // From the last of a list to the first, so that indices stay right.
  for (const id of [...wires].sort((a, b) => wireOf(b).index - wireOf(a).index))
    if (!nodes.includes(wireOf(id).node)) edits.push(disconnection(id));
  if (nodes.length) edits.push({op: 'remove', nodes});
  for (const id of frames) edits.push({op: 'frame', id, set: null});
  if (!edits.length) return;
  const label = nodes.length ? `remove ${count(nodes)}` : wires.length ? 'remove a wire' : 'remove a frame';
  if (await session.edit(label, ...edits)) focusCanvas();
}

export async function copySelected(remove = false) {
  if (!canvas.selected.length) return;
  const nodes = canvas.selected;
  const answer = await session.call<{text: string}>('copy', {level: session.levelName, nodes});
  if (!answer) return;
  try {
    await navigator.clipboard.writeText(answer.text);
  } catch {
    return session.say('The browser does not let this page write to the clipboard.', 'error');
  }
  if (remove) await removeSelected();
  else session.say(`${count(nodes)} copied as JSON`);
}

export async function paste(text?: string) {
  if (isLocked()) return;
  let pasted = text;
  try {
    pasted ??= await navigator.clipboard.readText();
  } catch {
    return session.say('The browser does not let this page read the clipboard; press Ctrl+V instead.', 'error');
  }
  const at = canvas.pointer ? canvas.pane?.toCanvas(canvas.pointer) : canvas.pane?.centre().canvas;
  selectAdded(await session.edit('paste', {op: 'paste', text: pasted, x: Math.round(at?.x ?? 0), y: Math.round(at?.y ?? 0)}));
}

export async function duplicate() {
  if (isLocked()) return;
  const nodes = canvas.selected;
  if (!nodes.length) return;
  const answer = await session.call<{text: string}>('copy', {level: session.levelName, nodes});
  const placed = session.level.nodes.filter((n) => nodes.includes(n.name));
  const x = Math.min(...placed.map((n) => n.x)) + 32, y = Math.max(...placed.map((n) => n.y + cardHeight(n, n.pinned))) + 24;
  if (answer) selectAdded(await session.edit(`duplicate ${count(nodes)}`, {op: 'paste', text: answer.text, x, y}));
}

export function setOnSelected(key: 'mute' | 'pin') {
  if (isLocked()) return;
  const nodes = session.level.nodes.filter((n) => canvas.selected.includes(n.name));
  if (!nodes.length) return;
  if (key === 'pin') {
    const on = !nodes.every((n) => n.pinned);
    return void session.edit(on ? 'pin pictures' : 'unpin pictures', {op: 'pin', nodes: nodes.map((n) => n.name), on});
  }
  const on = !nodes.every((n) => n.mute);
  void session.edit(`${on ? 'mute' : 'unmute'} ${count(canvas.selected)}`, ...nodes.map((n): Edit => on
    ? {op: 'set', node: n.name, key: 'mute', value: true} : {op: 'unset', node: n.name, key: 'mute'}));
}

export function rename(name: string) {
  if (isLocked()) return;
  ui.ask('Rename the node', name, async (to) => {
    if (!to || to === name) return;
    await session.tryEdit(`rename ${name}`, {op: 'rename', node: name, to});
    selectAdded([to]);
  }, 'Wires and expressions follow.');
}

export function group() {
  if (isLocked()) return;
  const nodes = canvas.selected;
  if (nodes.length) ui.ask('Group as a subgraph', uniqueName(session.level, 'part'), async (name) => {
    await session.tryEdit(`group ${count(nodes)}`, {op: 'group', nodes, name});
    selectAdded([name]);
  }, 'The name of the subgraph and of its node.');
}

export const ungroup = (node: string) => session.edit(`ungroup ${node}`, {op: 'ungroup', node}).then(selectAdded);

export type Alignment = 'left' | 'right' | 'top' | 'middle' | 'columns' | 'rows';
export function align(how: Alignment) {
  const nodes = session.level.nodes.filter((n) => canvas.selected.includes(n.name));
  if (nodes.length < 2) return;
  const height = (n: (typeof nodes)[0]) => canvas.nodes.find((c) => c.id === n.name)?.measured?.height ?? cardHeight(n, n.pinned);
  const xs = nodes.map((n) => n.x), ys = nodes.map((n) => n.y);
  const middle = nodes.reduce((sum, n) => sum + n.y + height(n) / 2, 0) / nodes.length;
  const positions: Record<string, [number, number]> = {};
  let next = how === 'rows' ? Math.min(...ys) : Math.min(...xs);
  for (const n of [...nodes].sort((a, b) => how === 'rows' ? a.y - b.y : a.x - b.x)) {
    positions[n.name] = [n.x, n.y];
    if (how === 'left') positions[n.name] = [Math.min(...xs), n.y];
    if (how === 'right') positions[n.name] = [Math.max(...xs), n.y];
    if (how === 'top') positions[n.name] = [n.x, Math.min(...ys)];
    if (how === 'middle') positions[n.name] = [n.x, Math.round(middle - height(n) / 2)];
    if (how === 'columns') { positions[n.name] = [next, Math.min(...ys)]; next += cardWidth + 48; }
    if (how === 'rows') { positions[n.name] = [Math.min(...xs), next]; next += height(n) + 24; }
  }
  void session.edit(`align ${count(canvas.selected)}`, {op: 'move', positions});
}

export function nudge(dx: number, dy: number) {
  if (nudgeBend(dx, dy)) return;
  const chosen = session.level.frames.filter((f) => canvas.selectedFrames.includes(f.id));
  const frames = session.level.frames.filter((f) => chosen.some((c) => c === f || isOn(c, f, true)));
  const isInside = (n: GraphNode) => chosen.some((f) => isOn(f, {x: n.x, y: n.y, width: cardWidth, height: cardHeight(n, n.pinned)}, false));
  const nodes = session.level.nodes.filter((n) => canvas.selected.includes(n.name) || isInside(n));
  const positions = Object.fromEntries(nodes.map((n) => [n.name, [n.x + dx, n.y + dy]]));
  const edits: Edit[] = nodes.length ? [{op: 'move', positions}, ...bendEdits(new Set(nodes.map((n) => n.name)), dx, dy)] : [];
  for (const {id, ...f} of frames) edits.push({op: 'frame', id, set: {...f, x: f.x + dx, y: f.y + dy}});
  if (edits.length) void session.edit(frames.length ? 'move a frame' : `move ${count(canvas.selected)}`, ...edits);
}

export function retitle(id: string) {
  const frame = session.level.frames.find((f) => f.id === id);
  if (!frame || isLocked()) return;
  const {id: _, ...old} = frame;
  ui.ask('Title of the frame', old.title, (title) => session.tryEdit('rename a frame', {op: 'frame', id, set: {...old, title}}));
}

export function frame() {
  if (isLocked()) return;
  const nodes = session.level.nodes.filter((n) => canvas.selected.includes(n.name));
  const centre = canvas.pane?.centre().canvas ?? {x: 0, y: 0};
  const x = nodes.length ? Math.min(...nodes.map((n) => n.x)) - 20 : centre.x - 150;
  const y = nodes.length ? Math.min(...nodes.map((n) => n.y)) - 40 : centre.y - 100;
  const width = nodes.length ? Math.max(...nodes.map((n) => n.x + cardWidth)) + 20 - x : 300;
  const height = nodes.length ? Math.max(...nodes.map((n) => n.y + cardHeight(n, n.pinned))) + 20 - y : 200;
  ui.ask('Frame', '', (title) => session.tryEdit('add a frame', {op: 'frame', set: {title, x, y, width, height}}), 'Its title.');
}

export function openPalette(screen?: Point, wire?: {node: string; port: Port; side: 'source' | 'target'}) {
  if (isLocked()) return;
  const where = screen ?? canvas.pointer ?? canvas.pane?.centre().screen ?? {x: 300, y: 200};
  ui.palette = {screen: where, at: canvas.pane?.toCanvas(where), wire};
}

export function openBehind() {
  if (isLocked()) return;
  const {current} = canvas;
  if (!current) return openPalette();
  const box = document.querySelector(`.svelte-flow__node[data-id="${CSS.escape(current)}"]`)?.getBoundingClientRect();
  ui.palette = {screen: {x: (box?.right ?? 300) + 12, y: box?.top ?? 200}, behind: current};
}
