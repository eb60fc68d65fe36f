// What the view shows of the node looked at, and how.
import { canvas } from './canvas.svelte.ts';
import type { Level, Picture } from './protocol.ts';
import { runs } from './runs.svelte.ts';
import { session } from './session.svelte.ts';
import type { Piece } from '../view/piece.ts';
import type { Point } from './ui.svelte.ts';

export type Channel = 'all' | 'r' | 'g' | 'b' | 'a';

/// The node whose material a result was made from: the source farthest upstream, by name.
export function exemplarOf(level: Level, name: string): string | null {
  const seen = new Set<string>(), waiting = [name];
  let found: string | null = null;
  while (waiting.length) {
    const next = waiting.shift(), node = level.nodes.find((n) => n.name === next);
    if (!node || seen.has(node.name)) continue;
    seen.add(node.name);
    if (node.name !== name && node.category === 'source' && node.outputs.some((o) => o.type === 'material')) found ??= node.name;
    for (const wire of node.wires) waiting.push(wire.node);
  }
  return found;
}

class Look {
  locked = $state(false);
  lit = $state(false);
  channel = $state<Channel>('all');
  tile = $state(false);
  rolled = $state(false);
  beside = $state(false);
  painting = $state(false);
  /// The picture that is compared with, and where the border between the two stands.
  frozen = $state.raw<Picture | null>(null);
  wipe = $state(0.5);
  /// What was done last when it was taken, and what was since.
  frozenAs = $state('');
  now = $derived(session.document?.undo ?? 'as it was opened');
  /// Shared by all pictures of the view: pixels of the screen for one of the picture, and the picture's middle on the screen.
  zoom = $state(0);
  pan = $state.raw({x: 0.5, y: 0.5});
  /// The pixel under the pointer.
  hover = $state.raw<Point | null>(null);
  values = $state.raw<number[] | null>(null);
  /// Of a uv map, what the pixel under the pointer was taken from the exemplar together with.
  piece = $state.raw<Piece | null>(null);

  name = $derived(runs.looked?.node ?? null);
  level = $derived(session.document?.levels[runs.looked?.level ?? '']);
  exemplar = $derived(this.level && this.name ? exemplarOf(this.level, this.name) : null);
  pictures = $derived(runs.looked ? runs.picturesOf(runs.looked.level, runs.looked.node) : []);
  maps = $derived([...new Set(this.pictures.map(named))]);
  picture = $derived(best(this.pictures, runs.map));
  exemplarPicture = $derived(this.exemplar ? best(runs.picturesOf(runs.looked?.level ?? '', this.exemplar), this.picture?.map) : undefined);
  isUv = $derived(/uv/.test(this.picture?.semantic ?? ''));

  /// What one sees first, or after the node that was looked at has gone: the node that the first file comes from, or else
  /// the last node.
  begin(level: Level) {
    const {looked} = runs;
    if (looked && session.document?.levels[looked.level]?.nodes.some((n) => n.name === looked.node)) return;
    const sink = level.nodes.find((n) => n.category === 'sink' && n.wires.length);
    const node = level.nodes.find((n) => n.name === sink?.wires[0]?.node) ?? level.nodes.at(-1);
    runs.looked = node ? {level: session.levelName, node: node.name} : null;
  }

  /// The view shows what is selected, unless it is locked.
  follow() {
    // What is painted belongs to what it is painted on.
    if (this.locked || this.painting || !canvas.current) return;
    // What only writes has no picture of its own: what it writes is shown.
    const node = session.node(canvas.current), source = node && !node.outputs.length ? node.wires[0]?.node : undefined;
    const looked = {level: session.levelName, node: source && session.node(source) ? source : canvas.current};
    if (runs.looked?.node !== looked.node || runs.looked.level !== looked.level) runs.looked = looked;
  }
}

export const named = (picture: Picture) => picture.map ?? picture.output;

function best(pictures: Picture[], map: string | undefined): Picture | undefined {
  const candidates = pictures.filter((p) => named(p) === map);
  const among = candidates.length ? candidates : pictures.filter((p) => named(p) === named(pictures.find((q) => q.map === 'base_color') ?? pictures[0]!));
  return among[0];
}

export const look = new Look();
