// The document as the program last told it, the connection, and what is asked of the program.
import { ask, askTypes, Refused, Unreachable, type DocumentState, type Edit, type GraphNode, type Level, type NodeType } from './protocol.ts';

/// What a step of undo is called. Edits with the same gesture, such as a drag, are one step.
export type StepOfUndo = string | {label: string; gesture: string};

export interface Toast {id: number; text: string; kind: 'error' | 'info'}

const noLevel: Level =
  {summary: '', help: '', parameters: [], inputs: [], outputs: [], presets: [], nodes: [], frames: [], bends: {}, boxes: {}};

class Session {
  document = $state.raw<DocumentState | null>(null);
  types = $state.raw<NodeType[]>([]);
  categories = $state.raw<string[]>([]);
  connected = $state(true);
  stopped = $state(false);  // the program said goodbye
  shutOut = $state(false);  // it was started again, and does not know this browser
  toasts = $state.raw<Toast[]>([]);
  /// From the main graph to the level that is shown: the node that each was entered through.
  path = $state.raw<{level: string; via: string}[]>([]);

  levelName = $derived(this.path.at(-1)?.level ?? '');
  level = $derived<Level>(this.document?.levels[this.levelName] ?? noLevel);
  readOnly = $derived(this.document?.readOnly ?? false);
  /// What the names of a run's nodes begin with at this level.
  prefix = $derived(this.path.map((step) => step.via + '/').join(''));

  #typesByName = $derived(new Map(this.types.map((type) => [type.name, type])));
  #lastToast = 0;
  #sent: Promise<unknown> = Promise.resolve();
  #waiting: {revision: number; done: () => void}[] = [];

  typeNamed(name: string): NodeType | undefined { return this.#typesByName.get(name); }
  node(name: string) { return this.level.nodes.find((node) => node.name === name); }

  say(text: string, kind: Toast['kind'] = 'info') {
    if (this.toasts.some((toast) => toast.text === text)) return;
    const id = ++this.#lastToast;
    this.toasts = [...this.toasts.slice(-3), {id, text, kind}];
    setTimeout(() => this.unsay(id), kind === 'error' ? 8000 : 4000);
  }
  unsay(id: number) { this.toasts = this.toasts.filter((toast) => toast.id !== id); }

  take(document: DocumentState) {
    // The first event may come before the types are known; refresh then asks for the state.
    if (!this.types.length) return;
    for (const level of Object.values(document.levels)) for (const node of level.nodes) this.#describe(node);
    // Answers and events may cross; an older state must not replace a newer one.
    if (this.document && document.revision < this.document.revision && this.connected) return;
    this.document = document;
    const gone = this.path.findIndex((step) => !(step.level in document.levels));
    if (gone >= 0 && !document.broken) this.path = this.path.slice(0, gone);
    for (const waiting of this.#waiting) if (document.revision >= waiting.revision) waiting.done();
    this.#waiting = this.#waiting.filter((waiting) => document.revision < waiting.revision);
  }

  // Nodes of the program's own types come without what the types say already.
  #describe(node: GraphNode) {
    if (node.params) return;
    const type = this.#typesByName.get(node.type);
    node.inputs = type?.inputs ?? [];
    node.outputs = type?.outputs ?? [];
    node.params = type?.parameters ?? [];
  }

  async refresh() {
    const [types, document] = await Promise.all([askTypes(), ask<DocumentState>('state')]);
    this.types = types.types;
    this.categories = types.categories;
    this.document = null;
    this.take(document);
  }

  /// Resolves once the page shows that revision.
  async #shown(revision: number) {
    if ((this.document?.revision ?? -1) >= revision) return;
    await new Promise<void>((done) => {
      this.#waiting.push({revision, done});
      // The event may have been lost with a connection.
      setTimeout(() => { void ask<DocumentState>('state').then((d) => this.take(d), () => undefined).then(done); }, 1500);
    });
  }

  /// Names of added nodes, or null if the edits were refused; the reason is shown.
  async edit(step: StepOfUndo, ...edits: Edit[]): Promise<string[] | null> {
    try {
      return await this.tryEdit(step, ...edits);
    } catch (error) {
      this.complain(error);
      return null;
    }
  }

  /// The same, but throws what the program refused.
  async tryEdit(step: StepOfUndo, ...edits: Edit[]): Promise<string[]> {
    if (this.readOnly) throw new Refused('This graph is shown read-only.', 403);
    const level = this.levelName, {label, gesture} = typeof step === 'string' ? {label: step, gesture: ''} : step;
    const sent = ask<{revision: number; names?: string[]; taken?: string[]}>('edit', {
      base: this.document?.revision ?? 0, label, tab, ...(gesture ? {gesture} : {}), edits: edits.map((edit) => ({level, ...edit})),
    });
    this.#sent = sent.catch(() => undefined);
    const answer = await sent;
    // What else went away with what was removed.
    if (answer.taken?.length) this.say(answer.taken.length === 1 && answer.taken[0]!.includes(' no longer ') ? answer.taken[0]! : `Also gone: ${answer.taken.join('; ')}`);
    await this.#shown(answer.revision);
    return answer.names ?? [];
  }

  async call<T>(name: string, body: object = {}): Promise<T | null> {
    try {
      return await ask<T>(name, body);
    } catch (error) {
      this.complain(error);
      return null;
    }
  }

  complain(error: unknown) {
    if (error instanceof Unreachable) this.connected = false;
    else this.say(error instanceof Error ? error.message : String(error), 'error');
  }

  // Of what was edited just now the page may not have heard yet: the program knows.
  async undo() { await this.#sent; await this.call('undo'); }
  async redo() { await this.#sent; await this.call('redo'); }

  enter(name: string) {
    const node = this.node(name);
    if (!node?.level) return false;
    this.path = [...this.path, {level: node.level, via: name}];
    return true;
  }
  /// Steps into a level by the shortest way of nodes that lead there.
  showLevel(level: string) {
    if (level === this.levelName) return;
    const ways: {level: string; via: string}[][] = [[]];
    for (let way = ways.shift(); way; way = ways.shift()) {
      const at = way.at(-1)?.level ?? '';
      if (at === level) { this.path = way; return; }
      if (way.length < 16)
        for (const node of this.document?.levels[at]?.nodes ?? [])
          if (node.level !== undefined) ways.push([...way, {level: node.level, via: node.name}]);
    }
    // No node leads there: it is shown by itself.
    this.path = [{level, via: level}];
  }
  leave(depth = this.path.length - 1) { this.path = this.path.slice(0, Math.max(0, depth)); }
}

export const session = new Session();
export const tab = Math.random().toString(36).slice(2);
