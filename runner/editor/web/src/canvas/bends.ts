// Bends of wires: added, moved and removed by mouse and by keyboard.
import { canvas } from '../state/canvas.svelte.ts';
import { session } from '../state/session.svelte.ts';
import type { Point } from '../state/ui.svelte.ts';
import { keyOfWire, portPlace, type WireEdge } from './model.ts';
import { middleOfWire, placeOnWire } from './path.ts';

const edgeOf = (id: string) => canvas.edges.find((e) => e.id === id);
const bendsOf = (edge: WireEdge): Point[] => edge.data?.bends ?? [];

export function setBends(id: string, points: Point[], label = 'bend a wire') {
  const edge = edgeOf(id);
  if (!edge) return Promise.resolve(null);
  return session.edit(label, {op: 'bend', wire: keyOfWire(edge), points: points.map(({x, y}) => [Math.round(x), Math.round(y)])});
}

function insert(id: string, index: number, point: Point) {
  const edge = edgeOf(id);
  if (!edge || session.readOnly) return;
  const points = [...bendsOf(edge)];
  points.splice(index, 0, point);
  canvas.select([], [id]);
  canvas.pickedBend = {wire: id, index};
  void setBends(id, points);
}

function ends(edge: WireEdge): [Point, Point] {
  const node = (name: string) => canvas.nodes.find((n) => n.id === name);
  return [portPlace(node(edge.source), edge.sourceHandle ?? '', 'source'), portPlace(node(edge.target), edge.targetHandle ?? '', 'target')];
}

export function addBend(id: string, at: Point) {
  const edge = edgeOf(id);
  if (edge) insert(id, placeOnWire(...ends(edge), bendsOf(edge), at), at);
}

export function removeBend(id: string, index: number) {
  const edge = edgeOf(id);
  canvas.pickedBend = null;
  if (edge && !session.readOnly) void setBends(id, bendsOf(edge).filter((_, at) => at !== index), 'remove a bend');
}

/// A bend in the middle of the selected wire.
export function bendSelected() {
  const edge = edgeOf(canvas.selectedWires[0] ?? '');
  if (!edge) return session.say('Select a wire first: W goes through those of a node.');
  const {index, point} = middleOfWire(...ends(edge), bendsOf(edge));
  insert(edge.id, index, point);
}

export function nextBend() {
  const edge = edgeOf(canvas.selectedWires[0] ?? '');
  if (!edge || !bendsOf(edge).length) return;
  const at = canvas.bend?.wire === edge.id ? canvas.bend.index : -1;
  canvas.pickedBend = {wire: edge.id, index: (at + 1) % bendsOf(edge).length};
}

export function nudgeBend(dx: number, dy: number): boolean {
  const {bend} = canvas, edge = bend && edgeOf(bend.wire);
  if (!bend || !edge || session.readOnly) return false;
  void setBends(bend.wire, bendsOf(edge).map((p, at) => at === bend.index ? {x: p.x + dx, y: p.y + dy} : p));
  return true;
}
