// Histograms of results, fetched once for each picture.
import type { Counts } from '../forms/curve.ts';
import type { GraphNode } from './protocol.ts';
import { ask } from './protocol.ts';
import { runs, type Looked } from './runs.svelte.ts';
import { session } from './session.svelte.ts';

/// The result that comes in at the node's first input of images, if a node of this level makes it.
export function sourceOf(node: GraphNode): (Looked & {output: string}) | null {
  const wire = node.wires.find((w) => node.inputs.find((p) => p.name === w.port)?.type === 'image') ?? node.wires[0];
  const source = wire && session.node(wire.node);
  return source ? {level: session.levelName, node: source.name, output: wire.output || source.outputs[0]?.name || ''} : null;
}

class Histograms {
  /// The newest of a result; while a newer one is being counted, the one before it.
  known = $state.raw<{key: string; digest: string; counts: Counts} | null>(null);

  of(node: GraphNode): Counts | null {
    const source = sourceOf(node);
    return source && this.known?.key === source.level + '/' + source.node + '.' + source.output ? this.known.counts : null;
  }

  async measure(node: GraphNode) {
    const source = sourceOf(node);
    if (!source) return;
    const pictures = runs.picturesOf(source.level, source.node).filter((p) => p.output === source.output && !p.map);
    const picture = pictures[0];
    if (!picture || this.known?.digest === picture.digest) return;
    const {digest} = picture, key = source.level + '/' + source.node + '.' + source.output;
    try {
      this.known = {key, digest, counts: await ask<Counts>('histogram', {digest})};
    } catch {
      // A newer picture has taken its place, and is counted next.
    }
  }
}

export const histograms = new Histograms();
