// What the page and the program say to each other, and the two ways in which the page asks.

export interface Port {name: string; type: string; required: boolean; list: boolean; help: string}

export interface Param {
  name: string; type: string; default?: unknown; min?: number; max?: number; step?: number; choices?: string[];
  unit?: string; help: string; group?: string; min_count?: number; max_count?: number;
}

export interface GraphParam extends Param {value?: unknown; pointer?: string; visible_if?: string; hidden?: boolean}

export interface Wire {port: string; index: number; node: string; output: string; pointer?: string}

export interface GraphNode {
  name: string; type: string; known: boolean; category: string; summary: string; comment?: string; mute: boolean | string;
  foreach?: unknown; level?: string; inputs: Port[]; outputs: Port[]; params: Param[]; values: Record<string, unknown>;
  hidden?: string[];            // parameters of a graph that have no effect now
  shown: Record<string, string>; wires: Wire[]; x: number; y: number; pinned: boolean;
}

export interface Frame {id: string; title: string; x: number; y: number; width: number; height: number}

/// `beside`: it lies in the file of presets beside the graph. Values by target: "seed", "node.parameter".
export interface Preset {name: string; summary?: string; beside: boolean; values: Record<string, unknown>}

export interface Level {
  summary: string; help: string; parameters: GraphParam[]; inputs: Port[];
  outputs: {name: string; type: string; from: string}[]; presets: Preset[]; nodes: GraphNode[];
  frames: Frame[];
  bends: Record<string, [number, number][]>;   // by "node.output > node.input"
  boxes: Record<string, [number, number]>;     // where the boxes of the inputs and outputs were moved to
}

export interface Problem {
  severity: 'error' | 'warning' | 'note'; code: string; message: string; pointer?: string; node?: string; level?: string;
  key?: string; line?: number; column?: number;
}

export interface DocumentState {
  revision: number; file: {name: string; folder: string}; saved: boolean; isNew?: boolean; readOnly: boolean;
  onDisk: 'same' | 'changed' | 'gone'; text: string; broken?: {line: number; column: number; message: string};
  levels: Record<string, Level>; problems: Problem[]; undo?: string; redo?: string; saveError?: string;
  conflict?: string;  // what was changed both here and on the disk
}

/// A node type, as `terrazzo nodes --json` describes it, with ports as those of nodes.
export interface NodeType {
  name: string; category: string; summary: string; help: string; inputs: Port[]; outputs: Port[]; parameters: Param[];
  uses: number; behind: Record<string, number>;  // in the stock graphs: how often, and how often behind which type
}

export interface Picture {
  level: string; node: string; output: string; map?: string; digest: string; url: string; small: string; width: number;
  height: number; of: 'preview' | 'full'; coarse: boolean; semantic: string;
  exemplar?: {width: number; height: number};  // of a uv map: the one that its values are places in
}

export interface PlannedStage {node: string; state: string; reason: string; seconds?: number}

export type Edit = {op: string; level?: string} & Record<string, unknown>;

export class Refused extends Error {
  constructor(message: string, readonly status: number, readonly pointer?: string) { super(message); }
}
/// The program did not answer at all.
export class Unreachable extends Error {}

/// Throws Refused with the program's words, or Unreachable.
export async function ask<T>(name: string, body: object = {}): Promise<T> {
  let answer: Response;
  try {
    answer = await fetch('/api/' + name, {
      method: 'POST', headers: {'Content-Type': 'application/json'}, body: JSON.stringify(body),
    });
  } catch {
    throw new Unreachable('terrazzo does not answer');
  }
  const text = await answer.text();
  let parsed: {error?: string; pointer?: string};
  try {
    parsed = JSON.parse(text);
  } catch {
    parsed = {error: text || answer.statusText};
  }
  if (!answer.ok) throw new Refused(parsed.error ?? answer.statusText, answer.status, parsed.pointer);
  return parsed as T;
}

interface DescribedPort {name: string; type: string; help?: string; optional?: boolean; required?: boolean; list?: boolean}
type Described = Omit<NodeType, 'inputs' | 'outputs' | 'parameters' | 'uses' | 'behind'> &
  {inputs: DescribedPort[]; outputs: DescribedPort[]; parameters?: Param[]; params?: Param[]};
interface Types {
  types: Described[]; graphs?: Described[]; categories?: string[]; uses?: Record<string, {count: number; behind: Record<string, number>}>;
}

const portOf = (p: DescribedPort): Port =>
  ({name: p.name, type: p.type, required: p.required ?? !p.optional, list: p.list ?? false, help: p.help ?? ''});

export async function askTypes(): Promise<{types: NodeType[]; categories: string[]}> {
  const answer = await ask<Types>('types');
  // Of types that are used equally often, those that come first in graphs.
  const place = new Map(Object.keys(answer.uses ?? {}).map((name, index) => [name, index / 1000]));
  const types = [...answer.types, ...(answer.graphs ?? [])].map((t) => ({
    ...t, inputs: t.inputs.map(portOf), outputs: t.outputs.map(portOf), parameters: t.parameters ?? t.params ?? [],
    uses: (answer.uses?.[t.name]?.count ?? 0) - (place.get(t.name) ?? 0), behind: answer.uses?.[t.name]?.behind ?? {},
  }));
  return {types, categories: answer.categories ?? [...new Set(types.map((t) => t.category))]};
}
