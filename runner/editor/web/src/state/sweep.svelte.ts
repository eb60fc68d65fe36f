// The contact sheet of a sweep: what the node looked at gives with each of several values.
import { look } from './look.svelte.ts';
import { ask, type Edit, type Param } from './protocol.ts';
import { runs } from './runs.svelte.ts';
import { session, tab } from './session.svelte.ts';

export interface Cell {label: string; values: Record<string, string>; url?: string; coarse?: boolean; failure?: string}
/// What can be swept: a parameter of the graph, or of a node.
export interface Target {name: string; label: string; param: Param; value: unknown; node?: string}

interface CellEvent {id: string; cell: number; url?: string; coarse?: boolean; message?: string}

const isNumber = (param: Param) => ['number', 'int', 'integer'].includes(param.type);

/// Values worth trying, as the command line spells them.
export function suggested({param, value}: Target): string {
  const now = typeof value === 'number' ? value : typeof param.default === 'number' ? param.default : 0;
  if (param.choices?.length) return param.choices.join(',');
  if (param.type === 'boolean' || param.type === 'bool') return 'false,true';
  if (!isNumber(param)) return typeof value === 'string' ? value : '';
  if (param.name === 'seed' || param.type !== 'number') return `${now}..${now + 8}`;
  const low = param.min ?? 0, high = param.max !== undefined && param.max < 100 ? param.max : Math.max(2 * now, low + 1);
  return Array.from({length: 6}, (_, i) => Number((low + (high - low) * i / 5).toPrecision(3))).join(',');
}

class Sweep {
  open = $state(false);
  cells = $state.raw<Cell[]>([]);
  running = $state(false);
  failure = $state('');
  chosen = $state(-1);
  #id = '';
  /// Asked for, and what was heard of it before the answer came: pictures that are cached are there sooner.
  #asked: {id: string; news: Partial<Cell>[]; ended: boolean} | null = null;

  targets(): Target[] {
    const graph = session.document?.levels[''];
    const of = (graph?.parameters ?? []).map((param): Target =>
      ({name: param.name, label: param.name, param, value: param.value ?? param.default}));
    // Nodes inside of subgraphs get their values from the graph itself.
    for (const node of graph?.nodes ?? []) for (const param of node.params)
      if (isNumber(param) || param.choices?.length || param.type === 'boolean' || param.type === 'size')
        of.push({name: `${node.name}.${param.name}`, label: `${node.name}: ${param.name}`, param, value: node.values[param.name] ?? param.default, node: node.name});
    return of;
  }

  async start(sweeps: string[]) {
    if (!runs.looked) return;
    const asked = this.#asked = {id: tab + Math.random().toString(36).slice(2), news: [] as Partial<Cell>[], ended: false};
    this.failure = '';
    try {
      const {cells} = await ask<{cells: Cell[]}>('sweep', {
        id: asked.id, ...runs.looked, map: look.picture?.map ?? '', side: 320, sweeps});
      if (this.#asked !== asked) return;
      this.#id = asked.id;
      this.cells = cells.map((cell, index) => ({...cell, ...asked.news[index]}));
      this.chosen = -1;
      this.running = !asked.ended;
    } catch (error) {
      if (this.#asked !== asked) return;
      this.failure = (error as Error).message;
    }
    this.#asked = null;
  }
  close() {
    this.open = false;
    if (this.running) void session.call('end_sweep');
  }

  /// Sets the values of a cell.
  async take(cell: Cell) {
    const targets = this.targets();
    const edits = Object.entries(cell.values).flatMap(([name, text]): Edit[] => {
      const target = targets.find((t) => t.name === name);
      if (!target) return [];
      let value: unknown = text;
      if (!['choice', 'text', 'path'].includes(target.param.type)) try { value = JSON.parse(text); } catch { /* 512x512, or an expression */ }
      return [target.node ? {op: 'set', level: '', node: target.node, key: name.slice(target.node.length + 1), value}
        : {op: 'value', level: '', name, value}];
    });
    if (!edits.length || !await session.edit(`take ${cell.label}`, ...edits)) return;
    session.say(`Took ${cell.label}`);
    this.open = false;
  }

  takePicture({id, cell, url, coarse}: CellEvent) { this.#change(id, cell, {url, coarse, failure: undefined}); }
  takeFailure({id, cell, message}: CellEvent) { this.#change(id, cell, {failure: message}); }
  ended({id}: {id: string}) {
    if (id === this.#asked?.id) this.#asked.ended = true;
    if (id === this.#id) this.running = false;
  }
  #change(id: string, cell: number, to: Partial<Cell>) {
    const news = id === this.#asked?.id ? this.#asked.news : null;
    if (news) news[cell] = {...news[cell], ...to};
    if (id === this.#id) this.cells = this.cells.map((c, index) => index === cell ? {...c, ...to} : c);
  }
}

export const sweep = new Sweep();
