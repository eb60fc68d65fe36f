// What happens to nodes: plans, runs, pictures. Nodes are known by their names in a run: "wall/layout".
import { ask, type Picture, type PlannedStage } from './protocol.ts';
import { session, tab } from './session.svelte.ts';
import { SvelteMap } from 'svelte/reactivity';

export interface NodeRun {state: 'running' | 'done' | 'cached' | 'failed' | 'skipped'; fraction: number; seconds?: number; messages: string[]; revision: number}
export interface Looked {level: string; node: string}
export interface RunEvent {node: string; fraction?: number; seconds?: number; message?: string; because?: string}

class Runs {
  nodes = new SvelteMap<string, NodeRun>();
  plan = new SvelteMap<string, PlannedStage>();
  summary = $state('');
  running = $state(false);
  last = $state.raw<{ok: boolean; seconds: number; cancelled: boolean; files: string[]} | null>(null);
  /// What the graph was at the end of that run, and what was planned after it: if either is another, the run is history.
  #then: {revision: number; summary?: string} = {revision: 0};
  /// By level and node, the newest of each output and map.
  pictures = new SvelteMap<string, Picture[]>();
  looked = $state.raw<Looked | null>(null);
  /// What a histogram is wanted of.
  measured = $state.raw<Looked | null>(null);
  map = $state<string | undefined>();
  full = $state(false);

  /// What is being made to be looked at, outside of a run.
  making = $derived(this.running ? null : [...this.nodes].find(([, n]) => n.state === 'running' && n.fraction > 0) ?? [...this.nodes].find(([, n]) => n.state === 'running') ?? null);

  picturesOf(level: string, node: string) { return this.pictures.get(level + '/' + node) ?? []; }

  takePlan(plan: {stages?: PlannedStage[]; summary?: string}) {
    this.plan.clear();
    for (const stage of plan.stages ?? []) this.plan.set(stage.node, stage);
    this.summary = plan.stages?.length ? plan.summary ?? '' : '';
    // What failed before the graph was changed may be right by now, and some nodes may be gone.
    for (const [name, run] of this.nodes)
      if (['failed', 'skipped'].includes(run.state) && run.revision !== session.document?.revision || this.plan.size && !this.plan.has(name)) this.nodes.delete(name);
    this.#then.summary ??= this.summary;
    if (this.#then.revision !== session.document?.revision || this.#then.summary !== this.summary) this.last = null;
  }

  takePicture(picture: Picture) {
    const key = picture.level + '/' + picture.node;
    const others = (this.pictures.get(key) ?? []).filter(
      (p) => p.output !== picture.output || p.map !== picture.map);
    this.pictures.set(key, [...others, picture]);
  }

  takeEvent(kind: string, event: RunEvent) {
    const {node} = event, before = this.nodes.get(node);
    const said = kind === 'skipped' ? 'needs ' + event.because : kind === 'note' || kind === 'failed' ? event.message ?? '' : '';
    const old = kind === 'start' ? [] : before?.messages ?? [];
    // Every preview that comes from the cache says its notes again.
    const messages = said && !old.includes(said) ? [...old, said] : old;
    const state = kind === 'start' || kind === 'progress' ? 'running' : kind === 'note' ? before?.state ?? 'done'
      : kind as NodeRun['state'];
    this.nodes.set(node, {
      state, messages, revision: session.document?.revision ?? 0, seconds: event.seconds,
      fraction: kind === 'progress' ? event.fraction ?? 0 : state === 'running' ? 0 : 1,
    });
  }

  /// Previews run too, without a word in the bar.
  ended(how: {ok: boolean; seconds: number; cancelled: boolean; preview?: boolean; message?: string; summary?: string; files?: string[]}) {
    if (!how.preview && (this.running || how.summary !== undefined)) {
      this.running = false;
      this.last = {...how, files: how.files ?? []};
      this.#then = {revision: session.document?.revision ?? 0};
      if (how.message) session.say(how.message, 'error');
    }
    for (const [name, node] of this.nodes) if (node.state === 'running') this.nodes.delete(name);
  }

  async run(sinks: boolean, nodes?: Looked[]) {
    this.nodes.clear();
    this.last = null;
    this.running = true;
    if (await session.call('run', {sinks, ...(nodes ? {nodes} : {})}) === null) this.running = false;
  }

  /// Tells the program which pictures this tab wants: `also` besides those pinned and looked at.
  show(side: number, also: Looked[]) {
    const pinned = Object.entries(session.document?.levels ?? {}).flatMap(([level, {nodes}]) =>
      nodes.filter((node) => node.pinned).map((node) => ({level, node: node.name}))).concat(also, this.measured ?? []);
    const looked = this.looked ? {...this.looked, ...(this.map ? {map: this.map} : {})} : undefined;
    // A lost connection has its own banner; pictures are asked for again after it.
    void ask('show', {tab, pinned, looked, side, full: this.full}).catch(() => undefined);
  }
}

export const runs = new Runs();
