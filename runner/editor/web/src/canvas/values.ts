// Values that are wired into parameters: those of the graph's parameters, as $name, and sizes of results, as expressions.
import { Refused, type GraphNode, type GraphParam, type Level, type Param } from '../state/protocol.ts';
import { session } from '../state/session.svelte.ts';
import { ui, type Point } from '../state/ui.svelte.ts';
import { isExpression } from './telling.ts';

/// What a parameter can get its value from: how it is written, and what that is.
export interface ValueSource {text: string; label: string; summary: string}

const kind = (param: Param) => ({integer: 'int', bool: 'boolean', paragraph: 'text'})[param.type] ?? param.type;

const takes: Record<string, string[]> = {
  number: ['number', 'int'], int: ['int'], size: ['size', 'int'], text: ['text', 'choice', 'path'], path: ['path', 'text'],
  choice: ['choice', 'text'], boolean: ['boolean'], numbers: ['numbers', 'size'], texts: ['texts'], number_map: ['number_map'], text_map: ['text_map'],
};

/// Whether a graph's parameter gives what the other takes.
export function fitsValue(from: Param, to: Param): boolean {
  if (kind(from) === 'choice' && to.choices) return !!from.choices?.every((choice) => to.choices!.includes(choice));
  return takes[kind(to)]?.includes(kind(from)) ?? false;
}

/// What is known of a result before anything runs.
function facts(level: Level, node: GraphNode, param: Param): ValueSource[] {
  const known = [...level.inputs.filter((p) => ['image', 'material'].includes(p.type)).map((p) => p.name),
    ...level.nodes.filter((n) => n !== node && n.category === 'source' && n.outputs.some((o) => ['image', 'material'].includes(o.type))).map((n) => n.name)];
  const of = (fact: string, summary: string) => known.map((name) => ({text: `=@${name}.${fact}`, label: `${name}.${fact}`, summary: `${summary} of ${name}`}));
  if (kind(param) === 'size') return of('size', 'the size');
  if (kind(param) === 'int' || kind(param) === 'number') return [...of('size.x', 'the width'), ...of('size.y', 'the height')];
  return kind(param) === 'texts' ? of('maps', 'the names of the maps') : [];
}

export function valueSources(level: Level, node: GraphNode, param: Param): ValueSource[] {
  return [...level.parameters.filter((p) => fitsValue(p, param)).map((p) => ({text: '$' + p.name, label: '$' + p.name, summary: p.help || p.type})), ...facts(level, node, param)];
}

export interface ValueTarget {node: GraphNode; param: Param}

/// Where a graph's parameter can go: of one node, or of all. What shares its name comes first.
export function valueTargets(level: Level, from: GraphParam, node?: string): ValueTarget[] {
  return level.nodes.filter((n) => node === undefined || n.name === node)
    .flatMap((n) => n.params.filter((p) => fitsValue(from, p)).map((param) => ({node: n, param})))
    .sort((a, b) => Number(b.param.name === from.name) - Number(a.param.name === from.name));
}

/// Whether a node, or another parameter's default, reads a parameter of the graph.
export function isRead(level: Level, name: string): boolean {
  const named = new RegExp(`(^=.*(?<![\\w.@'])|\\$\\{?)${name}(?!\\w)`), reads = (value: unknown) => isExpression(value) && named.test(value);
  return level.nodes.some((n) => Object.values(n.values).some(reads)) || level.parameters.some((p) => reads(p.default));
}

export const wireValue = (node: string, param: string, text: string) => session.edit(`${node}.${param} from ${text}`, {op: 'set', node, key: param, value: text});

/// A parameter of the node becomes one of the graph, with the same range and help; asks for its name.
export function promote(node: GraphNode, param: Param) {
  const {name: key, group: _, ...declared} = param, now = node.values[key];
  const value = now !== undefined && !isExpression(now) ? now : param.default;
  const taken = (name: string) => session.level.parameters.some((p) => p.name === name);
  let free = key;
  for (let number = 2; taken(free); ++number) free = key + number;
  ui.ask('Make it a parameter of the graph', free, (name) => {
    if (taken(name)) throw new Refused(`There is a parameter ${name} already.`, 400);
    return name && session.tryEdit(`parameter ${name}`,
      {op: 'parameter', name, set: {...declared, ...(value !== undefined ? {default: value} : {})}}, {op: 'set', node: node.name, key, value: '$' + name});
  }, 'Its name; the node then says $name.');
}

/// A graph's parameter was dropped on a node: the only parameter that takes it, or a choice.
export function giveTo(name: string, node: string, at: Point) {
  const from = session.level.parameters.find((p) => p.name === name), fitting = from ? valueTargets(session.level, from, node) : [];
  if (!fitting.length) session.say(`No parameter of ${node} takes ${name}.`, 'error');
  else if (fitting.length > 1) ui.wiringTo = {name, node, at};
  else void wireValue(node, fitting[0]!.param.name, '$' + name);
}
