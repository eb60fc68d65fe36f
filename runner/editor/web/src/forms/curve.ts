// Curves through points, as the node `curve` draws them (core/filter/curve.cpp), and where lists of points are.
import type { GraphNode, Level, Param } from '../state/protocol.ts';
import { tidy } from './ranges.ts';

export interface Knot {x: number; y: number}
/// By channel; the first bin begins at `low`, the last ends at `high`.
export interface Counts {low: number; high: number; counts: number[][]}
export interface Sketch {counts: Counts | null; smooth: boolean}

/// Null for what is not a list of points.
export function knotsOf(value: unknown): Knot[] | null {
  if (!Array.isArray(value) || value.length < 2 || value.length % 2 || !value.every((v) => typeof v === 'number')) return null;
  const numbers = value as number[];
  const knots = Array.from({length: numbers.length / 2}, (_, i) => ({x: numbers[2 * i]!, y: numbers[2 * i + 1]!}));
  return knots.every((k, i) => i === 0 || k.x > knots[i - 1]!.x) ? knots : null;
}
export const listOf = (knots: Knot[]) => knots.flatMap(({x, y}) => [tidy(x), tidy(y)]);

/// Fritsch & Butland 1984; straight lines if not smooth.
export function curveThrough(knots: Knot[], smooth: boolean): (x: number) => number {
  const last = knots.length - 1, slopes = knots.map(() => 0);
  const width = (i: number) => knots[i + 1]!.x - knots[i]!.x, rise = (i: number) => (knots[i + 1]!.y - knots[i]!.y) / width(i);
  const isSmooth = smooth && knots.length > 2;
  if (isSmooth) {
    slopes[0] = rise(0);
    slopes[last] = rise(last - 1);
    for (let i = 1; i < last; ++i) {
      const a = rise(i - 1), b = rise(i);
      if (a * b <= 0) continue;
      const before = 2 * width(i) + width(i - 1), after = width(i) + 2 * width(i - 1);
      slopes[i] = (before + after) / (before / a + after / b);
    }
  }
  return (x) => {
    if (!(x > knots[0]!.x)) return knots[0]!.y;
    if (x >= knots[last]!.x) return knots[last]!.y;
    const i = knots.findIndex((k) => k.x > x) - 1, {x: x0, y: y0} = knots[i]!, y1 = knots[i + 1]!.y, w = width(i), t = (x - x0) / w;
    if (!isSmooth) return y0 + (y1 - y0) * t;
    const t2 = t * t, t3 = t2 * t;
    return y0 * (2 * t3 - 3 * t2 + 1) + y1 * (3 * t2 - 2 * t3) + w * (slopes[i]! * (t3 - 2 * t2 + t) + slopes[i + 1]! * (t3 - t2));
  };
}

type Levels = Record<string, Level>;

/// Whether the parameter of the node is a list of points; of a graph in the document, whether what it is given to is.
export function isCurve(levels: Levels, node: GraphNode, param: Param, depth = 0): boolean {
  if (param.type !== 'numbers') return false;
  if (node.type === 'curve') return param.name === 'points';
  return node.level !== undefined && depth < 16 && feedsCurve(levels, node.level, param, depth + 1);
}
export const feedsCurve = (levels: Levels, level: string, param: Param, depth = 0): boolean =>
  !!levels[level]?.nodes.some((n) => n.params.some((p) => n.values[p.name] === '$' + param.name && isCurve(levels, n, p, depth)));

/// The outline of a histogram in a box; roots, so that rare values are seen beside frequent ones.
export function outline({low, high, counts}: Counts, channel: number, x: (value: number) => number, bottom: number, height: number): string {
  const bins = counts[channel] ?? [], inner = bins.slice(1, -1), most = Math.max(1, ...(inner.some((n) => n > 0) ? inner : bins));
  const at = (i: number) => x(low + (high - low) * i / bins.length).toFixed(1);
  return `M${at(0)},${bottom}` + bins.map((n, i) => {
    const y = (bottom - Math.min(1, Math.sqrt(n / most)) * height).toFixed(1);
    return `L${at(i)},${y}L${at(i + 1)},${y}`;
  }).join('') + `L${at(bins.length)},${bottom}Z`;
}
/// Colours of the channels of an image with so many; the last of two and of four is alpha, which is left out.
export const channelColours = (channels: number) => channels >= 3 ? ['#e5534b', '#3fa95c', '#4a86e8'] : ['var(--quiet)'];
