// Dragging nodes: frames carry what stands on them, and a node that is dropped on a wire goes into it.
import type { Edit } from '../state/protocol.ts';
import { canvas } from '../state/canvas.svelte.ts';
import { session } from '../state/session.svelte.ts';
import type { Point } from '../state/ui.svelte.ts';
import { firstFit, outputPort } from './fit.ts';
import { cardWidth, keyOfWire, rectangle, wireOf, type Box, type CanvasNode } from './model.ts';

interface Carried {frame: string; from: Point; nodes: {id: string; x: number; y: number}[]}
let carried: Carried[] = [];
/// Bends of wires whose ends both move, and where their sources were.
let following: {edge: string; source: string; from: Point; bends: Point[]}[] = [];

/// Whether something stands on a frame: a card with its middle, another frame with all of it.
export function isOn(frame: Box, {x, y, width, height}: Box, isFrame: boolean): boolean {
  if (isFrame) return x >= frame.x && y >= frame.y && x + width <= frame.x + frame.width && y + height <= frame.y + frame.height;
  const across = x + width / 2, down = y + height / 2;
  return across > frame.x && across < frame.x + frame.width && down > frame.y && down < frame.y + frame.height;
}

export function carry(nodes: CanvasNode[]) {
  const taken = new Set(nodes.map((n) => n.id));
  carried = nodes.filter((n) => n.type === 'frame').map((f) => {
    const inside = canvas.nodes.filter((n) => n.type !== 'ports' && !taken.has(n.id) && isOn(rectangle(f), rectangle(n), n.type === 'frame'));
    for (const n of inside) taken.add(n.id);
    return {frame: f.id, from: {...f.position}, nodes: inside.map((n) => ({id: n.id, ...n.position}))};
  });
  following = bentBetween(taken).map((edge) => ({
    edge: edge.id, source: edge.source, from: {...canvas.nodes.find((n) => n.id === edge.source)!.position}, bends: edge.data!.bends}));
}

/// The bent wires whose ends are both among these.
const bentBetween = (ids: Set<string>) => canvas.edges.filter((e) => e.data!.bends.length && ids.has(e.source) && ids.has(e.target));

export const bendEdits = (moved: Set<string>, dx = 0, dy = 0): Edit[] => bentBetween(moved).map((edge) =>
  ({op: 'bend', wire: keyOfWire(edge), points: edge.data!.bends.map(({x, y}) => [Math.round(x + dx), Math.round(y + dy)])}));

function moveBends() {
  if (!following.length) return;
  const bends = new Map(following.map((f) => {
    const now = canvas.nodes.find((n) => n.id === f.source)?.position ?? f.from;
    return [f.edge, f.bends.map(({x, y}) => ({x: x + now.x - f.from.x, y: y + now.y - f.from.y}))];
  }));
  canvas.edges = canvas.edges.map((e) => bends.has(e.id) ? {...e, data: {...e.data!, bends: bends.get(e.id)!}} : e);
}

export function hover(nodes: CanvasNode[]) {
  for (const {frame, from, nodes: inside} of carried) {
    const now = nodes.find((n) => n.id === frame)?.position;
    if (!now || !inside.length) continue;
    const places = new Map(inside.map((n) => [n.id, {x: n.x + now.x - from.x, y: n.y + now.y - from.y}]));
    canvas.nodes = canvas.nodes.map((n) => places.has(n.id) ? {...n, position: places.get(n.id)!} : n);
  }
  moveBends();
  canvas.dropWire = nodes.length === 1 && nodes[0]!.type === 'card' ? wireUnder(nodes[0]!) : null;
}

// The wire that passes nearest to the middle of the card; only for a node without wires that has an input and an output of
// the wire's type.
function wireUnder(dragged: CanvasNode): string | null {
  const node = session.node(dragged.id);
  if (!node || canvas.wiresOf(node.name).length) return null;
  const samples = 32, r = rectangle(dragged);
  let best: string | null = null, least = Infinity;
  for (const edge of canvas.edges) {
    const type = outputPort(session.level, {node: edge.source, port: edge.sourceHandle ?? ''})?.type ?? '';
    if (!firstFit(node.inputs, type) || !firstFit(node.outputs, type)) continue;
    const path = document.querySelector<SVGPathElement>(`.svelte-flow__edge[data-id="${CSS.escape(edge.id)}"] path`);
    const length = path?.getTotalLength() ?? 0;
    for (let step = 0; path && step <= samples; ++step) {
      const {x, y} = path.getPointAtLength(length * step / samples);
      if (x < r.x || x > r.x + r.width || y < r.y || y > r.y + r.height) continue;
      const distance = Math.hypot(x - r.x - r.width / 2, y - r.y - r.height / 2);
      if (distance < least) { least = distance; best = edge.id; }
    }
  }
  return best;
}

/// The node that goes into a wire gets a column of its own: what stands where its end is, or behind, moves to the right.
function makeRoom(dropped: CanvasNode, wire: string, positions: Record<string, [number, number]>): Edit[] {
  const gap = 40, edge = canvas.edges.find((e) => e.id === wire)!, edits: Edit[] = [];
  const source = canvas.nodes.find((n) => n.id === edge.source), target = canvas.nodes.find((n) => n.id === edge.target);
  if (!source || !target) return [];
  const {height} = rectangle(dropped), [left, top] = positions[dropped.id]!, others = canvas.nodes.filter((n) => n.type === 'card' && n.id !== dropped.id);
  const x = Math.round(Math.max(left, source.position.x + rectangle(source).width + gap));
  const begin = target.position.x, by = Math.round(Math.max(0, x + cardWidth + gap - begin));
  const place = (n: CanvasNode) => ({...rectangle(n), x: n.position.x + (n.position.x >= begin ? by : 0)});
  if (by > 0 && target.type === 'card') {
    for (const n of others) if (n.position.x >= begin) positions[n.id] = [Math.round(n.position.x + by), Math.round(n.position.y)];
    for (const n of canvas.nodes) if (n.type === 'frame') {
      const {id, ...frame} = n.data.frame;
      if (frame.x >= begin) edits.push({op: 'frame', id, set: {...frame, x: frame.x + by}});
      else if (frame.x + frame.width > begin) edits.push({op: 'frame', id, set: {...frame, width: frame.width + by}});
    }
  }
  // The nearest free row.
  const isFree = (y: number) => others.map(place).every((r) => Math.abs(r.x - x) >= cardWidth + 8 || y + height + 12 <= r.y || r.y + r.height + 12 <= y);
  let y = top;
  for (let step = 0; step < 400 && !isFree(y); ++step) y = top + (step % 2 ? 8 : -8) * Math.ceil(step / 2);
  positions[dropped.id] = [x, Math.round(y)];
  return edits;
}

/// Everything goes back to where the document has it.
function abandon() {
  canvas.isAbandoned = false;
  canvas.dropWire = null;
  carried = [];
  following = [];
  canvas.take(session.levelName, true);
}

export function drop(nodes: CanvasNode[]) {
  if (canvas.isAbandoned) return abandon();
  const edits: Edit[] = [], positions: Record<string, [number, number]> = {};
  const moved = new Set([...nodes.map((n) => n.id), ...carried.flatMap((c) => c.nodes.map((n) => n.id))]);
  for (const node of canvas.nodes)
    if (moved.has(node.id) && node.type !== 'frame') positions[node.id] = [Math.round(node.position.x), Math.round(node.position.y)];
  const names = Object.keys(positions), into = canvas.dropWire;
  if (into && nodes[0]) edits.push(...makeRoom(nodes[0], into, positions));
  moveBends();
  if (names.length) edits.push({op: 'move', positions}, ...bendEdits(moved));
  for (const node of canvas.nodes) if (node.type === 'frame' && moved.has(node.id)) {
    const {id, ...frame} = node.data.frame;
    edits.push({op: 'frame', id, set: {...frame, x: Math.round(node.position.x), y: Math.round(node.position.y)}});
  }
  if (into && nodes[0]) edits.push({op: 'insert', node: nodes[0].id, wire: wireOf(into)});
  canvas.dropWire = null;
  carried = [];
  following = [];
  const label = into ? `put ${nodes[0]!.id} into a wire` : nodes.some((n) => n.type === 'frame') ? 'move a frame' : names.length === 1 ? `move ${names[0]}` : `move ${names.length} nodes`;
  // A refused move goes back to where the document has it.
  if (edits.length) void session.edit(label, ...edits).then((done) => { if (!done) canvas.take(session.levelName, true); });
}
