// What is open on the page, and how it looks. Kept for the next visit: the theme and the sizes of panels.
import type { Port } from './protocol.ts';

export interface Point {x: number; y: number}

export interface PaletteRequest {
  screen: Point;                                                     // where it opens
  at?: Point;                                                        // where the node goes, on the canvas
  wire?: {node: string; port: Port; side: 'source' | 'target'};      // a wire that was dropped: only what fits it
  behind?: string;                                                   // the node to add behind
}

/// Asks for a line of text. What the answer throws is shown, and can be mended.
export interface Asked {title: string; value: string; hint?: string; refusal?: string; answer: (text: string) => unknown}

export interface MenuItem {label: string; keys?: string; act?: () => void; disabled?: string | boolean; more?: MenuItem[]}

const stored = <T>(key: string, fallback: T): T => {
  try {
    const text = localStorage.getItem('terrazzo.' + key);
    return text === null ? fallback : JSON.parse(text) as T;
  } catch {
    return fallback;
  }
};

export type Theme = 'system' | 'dark' | 'light';
export type Dock = 'right' | 'left' | 'large';

class Ui {
  palette = $state.raw<PaletteRequest | null>(null);
  menu = $state.raw<{at: Point; items: MenuItem[]; label: string} | null>(null);
  /// From an output of the node; or, with a port, from wherever to that input.
  connecting = $state.raw<{node: string; port?: string; at?: Point} | null>(null);
  /// A value: into the parameter of a node, or from a parameter of the graph, into one of that node or of any.
  wiringFrom = $state.raw<{node: string; param: string; at?: Point} | null>(null);
  wiringTo = $state.raw<{name: string; node?: string; at?: Point} | null>(null);
  asking = $state.raw<Asked | null>(null);
  choosingFile = $state.raw<{value: string; choose: (path: string) => void} | null>(null);
  finding = $state(false);
  help = $state(false);
  tab = $state<'parameters' | 'problems' | 'text' | 'changes'>('parameters');
  theme = $state<Theme>(stored<Theme>('theme', 'system'));
  panel = $state(stored('panel', 372));
  viewShare = $state(stored('viewShare', 0.46));
  viewDock = $state<Dock>(stored<Dock>('viewDock', 'right'));
  viewOpen = $state(stored('viewOpen', true));
  minimap = $state(stored('minimap', true));
  /// Dragging on the empty canvas selects; it moves the canvas with the middle button only.
  marquee = $state(stored('marquee', false));
  /// Typed into the text of the document and not applied; null: the text is the document's.
  draft = $state<string | null>(null);
  /// The document's text when that was begun.
  draftOf = '';

  dark = $derived(this.theme === 'dark' || (this.theme === 'system' && this.#systemDark()));
  #system = matchMedia('(prefers-color-scheme: dark)');
  #systemIs = $state(this.#system.matches);
  #systemDark() { return this.#systemIs; }

  constructor() {
    this.#system.addEventListener('change', (event) => { this.#systemIs = event.matches; });
  }

  keep() {
    const {theme, panel, viewShare, viewDock, viewOpen, minimap, marquee} = this;
    for (const [key, value] of Object.entries({theme, panel, viewShare, viewDock, viewOpen, minimap, marquee}))
      localStorage.setItem('terrazzo.' + key, JSON.stringify(value));
  }

  ask(title: string, value: string, answer: Asked['answer'], hint?: string) {
    this.asking = {title, value, answer, hint};
  }
  anyOpen() {
    return !!(this.palette || this.menu || this.connecting || this.wiringFrom || this.wiringTo || this.asking || this.choosingFile || this.finding || this.help);
  }
}

export const ui = new Ui();
