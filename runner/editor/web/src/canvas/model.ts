// From a level of the document to what the canvas draws.
import type { Edge, Node } from '@xyflow/svelte';
import type { Frame, GraphNode, Level, Port } from '../state/protocol.ts';
import type { Point } from '../state/ui.svelte.ts';
import { inputsId, outputsId } from './fit.ts';

export type CardNode = Node<{node: GraphNode}, 'card'>;
export type FrameNode = Node<{frame: Frame}, 'frame'>;
export type PortsNode = Node<{title: string; ports: Port[]; side: 'inputs' | 'outputs'}, 'ports'>;
export type CanvasNode = CardNode | FrameNode | PortsNode;
export type WireEdge = Edge<{type: string; muted: boolean; bends: Point[]}, 'wire'>;

export const cardWidth = 176, boxWidth = 150;
const headHeight = 25, portHeight = 17, lineHeight = 18, thumbnailHeight = 96;

export const cardHeight = (node: GraphNode, thumbnail: boolean) =>
  headHeight + portHeight * Math.max(node.inputs.length, node.outputs.length) + 6 + lineHeight +
  (thumbnail ? thumbnailHeight : 0);

export interface Box extends Point {width: number; height: number}

export function rectangle(node: CanvasNode): Box {
  const {width = cardWidth, height = node.height ?? node.initialHeight ?? 80} = node.measured ?? {width: node.width};
  return {...node.position, width, height};
}

/// Where a wire begins or ends, also of a card that is not drawn at present.
export function portPlace(node: CanvasNode | undefined, port: string, side: 'source' | 'target'): Point {
  if (!node) return {x: 0, y: 0};
  const ports = node.type === 'card' ? side === 'source' ? node.data.node.outputs : node.data.node.inputs : node.type === 'ports' ? node.data.ports : [];
  const row = Math.max(0, ports.findIndex((p) => p.name === port));
  return {x: node.position.x + (side === 'source' ? rectangle(node).width : 0), y: node.position.y + headHeight + 3 + portHeight * (row + 0.5)};
}

/// The key of a wire in the layout, which does not change when other wires do.
export const keyOfWire = ({source, sourceHandle, target, targetHandle}: Pick<WireEdge, 'source' | 'sourceHandle' | 'target' | 'targetHandle'>) =>
  `${source === inputsId ? sourceHandle : `${source}.${sourceHandle}`} > ${target}.${targetHandle}`;

export const wireId = (node: string, port: string, index: number) => `${node}|${port}|${index}`;
export function wireOf(id: string) {
  const [node, port, index] = id.split('|');
  return {node: node!, port: port!, index: Number(index)};
}

// Nodes that did not change stay the same object, so that they are not drawn anew.
const known = new Map<string, {text: string; node: GraphNode}>();
function stable(levelName: string, node: GraphNode): GraphNode {
  // What types say does not change, and is most of a node.
  const own = node.level === undefined && /^[a-z0-9_]+$/.test(node.type) ? {...node, inputs: 0, outputs: 0, params: 0} : node;
  const key = levelName + '/' + node.name, text = JSON.stringify(own), before = known.get(key);
  if (before?.text === text) return before.node;
  known.set(key, {text, node});
  return node;
}

export function nodesOf(levelName: string, level: Level, before: Map<string, CanvasNode>): CanvasNode[] {
  const keep = <T extends CanvasNode>(made: T): T => {
    const old = before.get(made.id);
    if (!old || old.type !== made.type) return made;
    const position = old.dragging ? old.position : made.position;
    const same = old.position.x === position.x && old.position.y === position.y &&
      (made.type === 'card' ? old.data === made.data || (old.data as CardNode['data']).node === (made.data as CardNode['data']).node
        : JSON.stringify(old.data) === JSON.stringify(made.data));
    return same ? old as T : {...made, selected: old.selected, dragging: old.dragging, measured: old.measured, position};
  };
  const nodes: CanvasNode[] = level.frames.map((frame) => keep<FrameNode>({
    id: 'frame:' + frame.id, type: 'frame', position: {x: frame.x, y: frame.y}, data: {frame}, width: frame.width,
    height: frame.height, zIndex: -1, ariaLabel: `frame ${frame.title}`,
  }));
  for (const node of level.nodes) nodes.push(keep<CardNode>({
    id: node.name, type: 'card', position: {x: node.x, y: node.y}, data: {node: stable(levelName, node)},
    width: cardWidth, initialHeight: cardHeight(node, node.pinned), ariaLabel: `${node.name}, ${node.type}${node.mute ? ', muted' : ''}`,
  }));
  if (levelName === '') return nodes;
  const xs = level.nodes.map((n) => n.x), mean = (ys: number[]) => ys.length ? Math.round(ys.reduce((sum, y) => sum + y, 0) / ys.length) : null;
  const top = level.nodes.length ? Math.min(...level.nodes.map((n) => n.y)) : 0;
  // Beside what they lead to, unless somebody has put them elsewhere.
  const readers = level.nodes.filter((n) => n.wires.some((w) => level.inputs.some((p) => p.name === w.node)));
  const makers = level.nodes.filter((n) => level.outputs.some((o) => o.from.replace(/^@/, '').split('.')[0] === n.name));
  const place = (id: string, x: number, y: number): Point => level.boxes[id] ? {x: level.boxes[id][0], y: level.boxes[id][1]} : {x, y};
  nodes.push(keep<PortsNode>({
    id: inputsId, type: 'ports', data: {title: 'inputs', ports: level.inputs, side: 'inputs'}, deletable: false,
    position: place(inputsId, Math.min(...readers.map((n) => n.x), xs.length ? Infinity : 0, ...(readers.length ? [] : xs)) - boxWidth - 56, mean(readers.map((n) => n.y)) ?? top),
    ariaLabel: 'inputs of this subgraph',
  }));
  nodes.push(keep<PortsNode>({
    id: outputsId, type: 'ports', deletable: false,
    position: place(outputsId, Math.max(...makers.map((n) => n.x), xs.length ? -Infinity : 0, ...(makers.length ? [] : xs)) + cardWidth + 56, mean(makers.map((n) => n.y)) ?? top),
    data: {title: 'outputs', side: 'outputs', ports: level.outputs.map((o) => ({...o, required: true, list: false, help: ''}))},
    ariaLabel: 'outputs of this subgraph',
  }));
  return nodes;
}

export function edgesOf(level: Level, before: Map<string, WireEdge>): WireEdge[] {
  const byName = new Map(level.nodes.map((node) => [node.name, node]));
  const edges: WireEdge[] = [];
  const add = (id: string, from: {node: string; output?: string}, target: string, port: string, fallback: string) => {
    const source = byName.get(from.node), isInput = !source && level.inputs.some((p) => p.name === from.node);
    if (!source && !isInput) return;  // leads nowhere: a problem says so
    const output = isInput ? from.node : from.output || source!.outputs[0]?.name || '';
    const ports = isInput ? level.inputs : source!.outputs;
    const type = ports.find((p) => p.name === output)?.type ?? fallback;
    const muted = source?.mute === true || byName.get(target)?.mute === true;
    const ends = {source: isInput ? inputsId : from.node, sourceHandle: output, target, targetHandle: port};
    const bends = (level.bends[keyOfWire(ends)] ?? []).map(([x, y]) => ({x, y}));
    const made: WireEdge = {
      id, type: 'wire', ...ends, data: {type, muted, bends}, ariaLabel: `wire from ${isInput ? output : from.node} to ${port} of ${target}`,
    };
    const old = before.get(id);
    edges.push(old && old.source === made.source && old.sourceHandle === output && old.data?.type === type &&
      old.data.muted === muted && JSON.stringify(old.data.bends) === JSON.stringify(bends) ? old : {...made, selected: old?.selected});
  };
  for (const node of level.nodes) for (const wire of node.wires)
    add(wireId(node.name, wire.port, wire.index ?? 0), {node: wire.node, output: wire.output}, node.name, wire.port,
        node.inputs.find((p) => p.name === wire.port)?.type ?? '');
  for (const output of level.outputs) {
    const [node = '', port] = output.from.replace(/^@/, '').split('.');
    add(wireId(outputsId, output.name, 0), {node, output: port}, outputsId, output.name, output.type);
  }
  return edges;
}
