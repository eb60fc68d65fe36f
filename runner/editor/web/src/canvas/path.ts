// The course of a wire: from source to target, past the points where somebody has bent it.
import type { Point } from '../state/ui.svelte.ts';

interface Piece {from: Point; first: Point; second: Point; to: Point}

// Smooth at the points; horizontal at both ends, as wires without bends are.
function pieces(source: Point, target: Point, bends: Point[]): Piece[] {
  const points = [source, ...bends, target], last = points.length - 1;
  const length = (a: Point, b: Point) => Math.hypot(b.x - a.x, b.y - a.y);
  const tangent = (at: number): Point => {
    if (at === 0 || at === last) {
      const near = points[at === 0 ? 1 : last - 1]!;
      return {x: Math.max(40, Math.abs(near.x - points[at]!.x)), y: 0};
    }
    const before = points[at - 1]!, after = points[at + 1]!, whole = length(before, after) || 1;
    const reach = Math.min(length(before, points[at]!), length(points[at]!, after));
    return {x: (after.x - before.x) / whole * reach, y: (after.y - before.y) / whole * reach};
  };
  return points.slice(1).map((to, index) => {
    const from = points[index]!, a = tangent(index), b = tangent(index + 1);
    return {from, to, first: {x: from.x + a.x * 0.4, y: from.y + a.y * 0.4}, second: {x: to.x - b.x * 0.4, y: to.y - b.y * 0.4}};
  });
}

export const bentPath = (source: Point, target: Point, bends: Point[]) => `M${source.x},${source.y}` +
  pieces(source, target, bends).map(({first, second, to}) => ` C${first.x},${first.y} ${second.x},${second.y} ${to.x},${to.y}`).join('');

function pointOf({from, first, second, to}: Piece, t: number): Point {
  const s = 1 - t, mix = (a: number, b: number, c: number, d: number) => s * s * s * a + 3 * s * s * t * b + 3 * s * t * t * c + t * t * t * d;
  return {x: mix(from.x, first.x, second.x, to.x), y: mix(from.y, first.y, second.y, to.y)};
}

const steps = 16;

/// Between which two points of the wire this one is: where it goes among the bends.
export function placeOnWire(source: Point, target: Point, bends: Point[], at: Point): number {
  let best = 0, least = Infinity;
  for (const [index, piece] of pieces(source, target, bends).entries())
    for (let step = 0; step <= steps; ++step) {
      const p = pointOf(piece, step / steps), distance = Math.hypot(p.x - at.x, p.y - at.y);
      if (distance < least) { least = distance; best = index; }
    }
  return best;
}

/// The middle of the longest piece, and where a bend there goes among the others.
export function middleOfWire(source: Point, target: Point, bends: Point[]): {index: number; point: Point} {
  const all = pieces(source, target, bends), length = ({from, to}: Piece) => Math.hypot(to.x - from.x, to.y - from.y);
  const index = all.reduce((best, piece, at) => length(piece) > length(all[best]!) ? at : best, 0);
  return {index, point: pointOf(all[index]!, 0.5)};
}

/// Straight lines with rounded corners.
export function roundedPath(points: Point[], radius = 9): string {
  const last = points.length - 1;
  return `M${points[0]!.x},${points[0]!.y}` + points.slice(1, last).map((corner, i) => {
    const towards = (other: Point) => {
      const length = Math.hypot(other.x - corner.x, other.y - corner.y) || 1, reach = Math.min(radius, length / 2);
      return `${corner.x + (other.x - corner.x) / length * reach},${corner.y + (other.y - corner.y) / length * reach}`;
    };
    return ` L${towards(points[i]!)} Q${corner.x},${corner.y} ${towards(points[i + 2]!)}`;
  }).join('') + ` L${points[last]!.x},${points[last]!.y}`;
}
