// Dragging nodes: frames carry what stands on them, and a node that is dropped on a wire goes into it.
import type { Edit } from '../state/protocol.ts';
import { canvas } from '../state/canvas.svelte.ts';
import { session } from '../state/session.svelte.ts';
import { firstFit, outputPort } from './fit.ts';
import { wireOf, type CanvasNode } from './model.ts';

let carried: {frame: string; from: {x: number; y: number}; nodes: {id: string; x: number; y: number}[]}[] = [];

export function carry(nodes: CanvasNode[]) {
  const dragged = new Set(nodes.map((n) => n.id));
  carried = nodes.filter((n) => n.type === 'frame').map((f) => ({
    frame: f.id, from: {...f.position},
    nodes: canvas.nodes.filter((n) => n.type === 'card' && !dragged.has(n.id)).filter((n) => {
      const x = n.position.x + (n.measured?.width ?? 0) / 2, y = n.position.y + (n.measured?.height ?? 0) / 2;
      return x > f.position.x && x < f.position.x + (f.width ?? 0) && y > f.position.y && y < f.position.y + (f.height ?? 0);
    }).map((n) => ({id: n.id, ...n.position})),
  }));
}

export function hover(nodes: CanvasNode[]) {
  for (const {frame, from, nodes: inside} of carried) {
    const now = nodes.find((n) => n.id === frame)?.position;
    if (!now || !inside.length) continue;
    const places = new Map(inside.map((n) => [n.id, {x: n.x + now.x - from.x, y: n.y + now.y - from.y}]));
    canvas.nodes = canvas.nodes.map((n) => places.has(n.id) ? {...n, position: places.get(n.id)!} : n);
  }
  canvas.dropWire = nodes.length === 1 && nodes[0]!.type === 'card' ? wireUnder(nodes[0]!.id) : null;
}

// Only for a node without wires that has an input and an output of the wire's type.
function wireUnder(name: string): string | null {
  const node = session.node(name);
  if (!node || canvas.wiresOf(name).length) return null;
  const box = document.querySelector(`.svelte-flow__node[data-id="${CSS.escape(name)}"]`)?.getBoundingClientRect();
  if (!box) return null;
  for (const [u, v] of [[0.5, 0.5], [0.25, 0.5], [0.75, 0.5], [0.5, 0.25], [0.5, 0.75]] as const)
    for (const element of document.elementsFromPoint(box.left + u * box.width, box.top + v * box.height)) {
      const id = element.closest<HTMLElement>('.svelte-flow__edge')?.dataset.id;
      const edge = id && canvas.edges.find((e) => e.id === id);
      if (!edge) continue;
      const type = outputPort(session.level, {node: edge.source, port: edge.sourceHandle ?? ''})?.type ?? '';
      if (firstFit(node.inputs, type) && firstFit(node.outputs, type)) return edge.id;
    }
  return null;
}

export function drop(nodes: CanvasNode[]) {
  const edits: Edit[] = [], positions: Record<string, [number, number]> = {};
  const moved = new Set([...nodes.filter((n) => n.type === 'card').map((n) => n.id), ...carried.flatMap((c) => c.nodes.map((n) => n.id))]);
  for (const node of canvas.nodes)
    if (moved.has(node.id)) positions[node.id] = [Math.round(node.position.x), Math.round(node.position.y)];
  const names = Object.keys(positions), into = canvas.dropWire;
  if (names.length) edits.push({op: 'move', positions});
  for (const node of nodes) if (node.type === 'frame') {
    const {id, ...frame} = node.data.frame;
    edits.push({op: 'frame', id, set: {...frame, x: Math.round(node.position.x), y: Math.round(node.position.y)}});
  }
  if (into && nodes[0]) edits.push({op: 'insert', node: nodes[0].id, wire: wireOf(into)});
  canvas.dropWire = null;
  carried = [];
  const label = into ? `put ${nodes[0]!.id} into a wire` : names.length === 1 ? `move ${names[0]}` : `move ${names.length} nodes`;
  // A refused move goes back to where the document has it.
  if (edits.length) void session.edit(label, ...edits).then((done) => { if (!done) canvas.take(session.levelName, true); });
}
