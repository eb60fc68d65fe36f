// Which wires fit, and why others do not.
import type { GraphNode, Level, NodeType, Port } from '../state/protocol.ts';

export interface End {node: string; port: string}
export const inputsId = '@inputs', outputsId = '@outputs';
/// The port of these two that makes a new one.
export const newPort = '@new';

const article = (word: string) => (/^[aeiou]/.test(word) && !/^u[vn]/.test(word) ? 'an ' : 'a ') + word;
export const typeWords = (type: string) => article(type.replace('uv_map', 'uv map'));

export function outputPort(level: Level, {node, port}: End): Port | undefined {
  if (node === inputsId) return level.inputs.find((p) => p.name === port);
  return level.nodes.find((n) => n.name === node)?.outputs.find((p) => p.name === port);
}
export function inputPort(level: Level, {node, port}: End): Port | undefined {
  return level.nodes.find((n) => n.name === node)?.inputs.find((p) => p.name === port);
}

/// Whether `node` gets something from `other`, directly or not.
export function comesFrom(level: Level, node: string, other: string): boolean {
  const seen = new Set<string>(), waiting = [node];
  while (waiting.length) {
    const name = waiting.pop()!;
    if (name === other) return true;
    if (seen.has(name)) continue;
    seen.add(name);
    for (const wire of level.nodes.find((n) => n.name === name)?.wires ?? []) waiting.push(wire.node);
  }
  return false;
}

/// Empty if the wire fits.
export function whyNot(level: Level, from: End, to: End): string {
  const output = outputPort(level, from), input = inputPort(level, to);
  if (to.node === outputsId || from.node === inputsId && from.port === newPort) {
    const other = to.node === outputsId ? output : input;
    return other && (to.node !== outputsId || from.node !== inputsId) ? '' : 'An input cannot be an output at once.';
  }
  if (!output || !input) return 'A wire goes from an output to an input.';
  if (output.type !== input.type)
    return `${from.node === inputsId ? from.port : from.node} gives ${typeWords(output.type)}; ` +
      `“${input.name}” of ${to.node} takes ${typeWords(input.type)}.`;
  if (from.node === to.node || comesFrom(level, from.node, to.node)) return `${to.node} would need its own result.`;
  return '';
}

/// The edit's spelling of an output: the first needs no port.
export function reference(level: Level, from: End): string {
  if (from.node === inputsId) return from.port;
  const node = level.nodes.find((n) => n.name === from.node);
  return node?.outputs[0]?.name === from.port ? from.node : `${from.node}.${from.port}`;
}

export function firstFit(ports: Port[], type: string): Port | undefined {
  return ports.find((p) => p.type === type && p.required) ?? ports.find((p) => p.type === type);
}

/// Free inputs first, then those that would lose their wire.
export function targets(level: Level, from: End): {node: GraphNode; port: Port; taken: boolean}[] {
  const found = level.nodes.flatMap((node) => node.inputs
    .filter((port) => !whyNot(level, from, {node: node.name, port: port.name}))
    .map((port) => ({node, port, taken: !port.list && node.wires.some((w) => w.port === port.name)})));
  return found.sort((a, b) => Number(a.taken) - Number(b.taken));
}

/// Where an input may get its wire from; in a subgraph also from its inputs.
export function sources(level: Level, to: End): End[] {
  const all = [...level.inputs.map((p) => ({node: inputsId, port: p.name})), ...level.nodes.flatMap((n) => n.outputs.map((p) => ({node: n.name, port: p.name})))];
  return all.filter((from) => !whyNot(level, from, to));
}

export function uniqueName(level: Level, type: string): string {
  const base = type.replace(/^.*:/, '').replace(/[^A-Za-z0-9_]/g, '_');
  const taken = new Set([...level.nodes.map((n) => n.name), ...level.parameters.map((p) => p.name), ...level.inputs.map((p) => p.name)]);
  if (!taken.has(base)) return base;
  for (let number = 2; ; ++number) if (!taken.has(base + number)) return base + number;
}

export const fitsWire = (type: NodeType, port: Port, side: 'source' | 'target') =>
  firstFit(side === 'source' ? type.inputs : type.outputs, port.type) !== undefined;
