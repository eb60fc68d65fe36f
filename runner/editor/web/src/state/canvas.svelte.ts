// The canvas as other parts of the page see it: what is selected, and where to look.
import { lanes } from '../canvas/route.ts';
import { edgesOf, nodesOf, rectangle, wireOf, type CanvasNode, type WireEdge } from '../canvas/model.ts';
import type { Point } from './ui.svelte.ts';
import { session } from './session.svelte.ts';

export interface Pane {
  fit: () => void;
  zoomBy: (factor: number) => void;
  zoomTo: (zoom: number) => void;
  toCanvas: (screen: Point) => Point;
  centre: () => {screen: Point; canvas: Point};
  reveal: (name: string) => void;
}

class Canvas {
  nodes = $state.raw<CanvasNode[]>([]);
  edges = $state.raw<WireEdge[]>([]);
  pane: Pane | null = null;
  pointer: Point | null = null;  // over the canvas, on the screen
  dropWire = $state<string | null>(null);  // the wire that a dragged node would be put into

  pulledWire = $state<string | null>(null);  // the wire that is being pulled off its input
  isAbandoned = false;  // what is dragged is given up
  valueOver = $state<string | null>(null);  // the node that a dragged value would go to

  pickedBend = $state.raw<{wire: string; index: number} | null>(null);

  /// What wires lead around.
  boxes = $derived(this.nodes.filter((n) => n.type !== 'frame').map(rectangle));

  /// By output, so that wires that go the same way lie beside each other.
  lanes = $derived(new Map([...new Set(this.edges.map((e) => `${e.source}.${e.sourceHandle}`))].map((output, index) => [output, index % lanes])));
  moves = $derived(this.nodes.some((n) => n.dragging));

  selected = $derived(this.nodes.filter((n) => n.selected && n.type === 'card').map((n) => n.id));
  selectedFrames = $derived(this.nodes.filter((n) => n.selected && n.type === 'frame').map((n) => n.id.slice(6)));
  selectedWires = $derived(this.edges.filter((e) => e.selected).map((e) => e.id));
  /// The bend that keys are about: of the selected wire.
  bend = $derived(this.pickedBend && this.selectedWires.includes(this.pickedBend.wire) ? this.pickedBend : null);
  /// The node that panels and the view are about.
  current = $derived(this.selected.length === 1 ? this.selected[0]! : null);

  take(levelName: string, sameLevel: boolean) {
    const none = new Map<string, never>();
    this.nodes = nodesOf(levelName, session.level, sameLevel ? new Map(this.nodes.map((n) => [n.id, n])) : none);
    this.edges = edgesOf(session.level, sameLevel ? new Map(this.edges.map((e) => [e.id, e])) : none);
  }

  select(names: Iterable<string>, wires: Iterable<string> = []) {
    const wanted = new Set(names), lines = new Set(wires);
    this.pickedBend = null;
    this.nodes = this.nodes.map((n) => !!n.selected === wanted.has(n.id) ? n : {...n, selected: wanted.has(n.id)});
    this.edges = this.edges.map((e) => !!e.selected === lines.has(e.id) ? e : {...e, selected: lines.has(e.id)});
  }

  /// Selects a node, besides others, moves the view there if it is outside, and puts the keyboard's focus on it.
  go(name: string, besides: string[] = []) {
    this.select([...besides, name]);
    this.pane?.reveal(name);
    requestAnimationFrame(() => focusNode(name));
  }

  wiresOf(name: string) { return this.edges.filter((e) => e.source === name || wireOf(e.id).node === name); }
}

export function focusNode(name: string) {
  document.querySelector<HTMLElement>(`.svelte-flow__node[data-id="${CSS.escape(name)}"]`)?.focus({preventScroll: true});
}
export const focusCanvas = () => document.querySelector<HTMLElement>('#canvas')?.focus({preventScroll: true});

export const canvas = new Canvas();
