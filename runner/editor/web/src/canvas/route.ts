// The course of a wire around the cards that it does not belong to: horizontal and vertical pieces, as few and as short
// as there are.
import type { Point } from '../state/ui.svelte.ts';
import type { Box } from './model.ts';

/// What a wire keeps away from cards; what a bend costs in length, and what a piece that passes close by a card.
const margin = 6, bendCost = 60, closeCost = 14;
/// Beside each other.
export const lanes = 7;
/// Cards farther from both ends are looked at only where the first course runs into one.
const reach = 320;

interface Lines {at: number[]; isClose: boolean[]}

/// Coordinates that pieces may have: beside each card, and in the middle between cards.
function lines(ends: number[], spans: (readonly [number, number])[], clear: number, shift: number): Lines {
  const found = new Map<number, boolean>(), between = [...spans].sort((a, b) => a[0] - b[0]);
  for (const [from, to] of spans) { found.set(from - clear, true); found.set(to + clear, true); }
  for (let i = 1, end = between[0]?.[1] ?? 0; i < between.length; ++i) {
    const [from, to] = between[i]!;
    if (from - end > 2 * margin) found.set((from + end) / 2 + Math.min(shift, (from - end) / 2 - margin), false);
    end = Math.max(end, to);
  }
  for (const end of ends) found.set(end, false);
  const at = [...found.keys()].sort((a, b) => a - b);
  return {at, isClose: at.map((value) => found.get(value)!)};
}

/// The least first.
class Queue {
  #costs: number[] = [];
  #states: number[] = [];
  push(cost: number, state: number) {
    const costs = this.#costs, states = this.#states;
    let at = costs.length;
    for (let up = (at - 1) >> 1; at > 0 && costs[up]! > cost; at = up, up = (at - 1) >> 1) {
      costs[at] = costs[up]!;
      states[at] = states[up]!;
    }
    costs[at] = cost;
    states[at] = state;
  }
  /// -1: there is none.
  pop(): number {
    const costs = this.#costs, states = this.#states, first = states[0] ?? -1, cost = costs.pop()!, state = states.pop()!, count = costs.length;
    if (first < 0 || !count) return first;
    let at = 0;
    for (let down = 1; down < count; down = 2 * at + 1) {
      if (down + 1 < count && costs[down + 1]! < costs[down]!) ++down;
      if (costs[down]! >= cost) break;
      costs[at] = costs[down]!;
      states[at] = states[down]!;
      at = down;
    }
    costs[at] = cost;
    states[at] = state;
    return first;
  }
}

function between(begin: Point, end: Point, boxes: Box[], lane: number): Point[] | null {
  const clear = margin + 3 + 1.5 * lane, shift = 4 * (lane - (lanes - 1) / 2);
  const columns = lines([begin.x, end.x], boxes.map((b) => [b.x, b.x + b.width] as const), clear, shift);
  const rows = lines([begin.y, end.y], boxes.map((b) => [b.y, b.y + b.height] as const), clear, shift);
  const xs = columns.at, ys = rows.at, width = xs.length, across = new Uint8Array(width * ys.length), down = new Uint8Array(width * ys.length);
  // A piece goes from its place to the next one on the right, or below.
  const inside = (all: number[], low: number, high: number) => {
    let first = all.findIndex((value) => value > low), last = first;
    if (first < 0) first = last = all.length;
    while (last < all.length && all[last]! < high) ++last;
    return [first, last] as const;
  };
  for (const b of boxes) {
    const [left, right] = inside(xs, b.x - margin, b.x + b.width + margin), [top, bottom] = inside(ys, b.y - margin, b.y + b.height + margin);
    for (let y = top; y < bottom; ++y) for (let x = Math.max(0, left - 1); x < right; ++x) across[y * width + x] = 1;
    for (let y = Math.max(0, top - 1); y < bottom; ++y) for (let x = left; x < right; ++x) down[y * width + x] = 1;
  }
  // Each place twice: reached along a row, or along a column.
  const count = 2 * width * ys.length, cost = new Float64Array(count).fill(Infinity), from = new Int32Array(count).fill(-1), queue = new Queue();
  const state = (p: Point) => 2 * (ys.indexOf(p.y) * width + xs.indexOf(p.x)), goal = state(end), start = state(begin);
  cost[start] = 0;
  queue.push(0, start);
  for (let now = queue.pop(); now >= 0 && now !== goal; now = queue.pop()) {
    const place = now >> 1, turned = now & 1, x = place % width, y = (place - x) / width;
    const go = (next: number, isDown: 0 | 1, length: number, isClose: boolean) => {
      const total = cost[now]! + length + (isDown === turned ? 0 : bendCost) + (isClose && isDown !== turned ? closeCost : 0), to = 2 * next + isDown;
      if (total >= cost[to]!) return;
      cost[to] = total;
      from[to] = now;
      const px = next % width, py = (next - px) / width;
      queue.push(total + Math.abs(xs[px]! - end.x) + Math.abs(ys[py]! - end.y), to);
    };
    if (x + 1 < width && !across[place]) go(place + 1, 0, xs[x + 1]! - xs[x]!, rows.isClose[y]!);
    if (x > 0 && !across[place - 1]) go(place - 1, 0, xs[x]! - xs[x - 1]!, rows.isClose[y]!);
    if (y + 1 < ys.length && !down[place]) go(place + width, 1, ys[y + 1]! - ys[y]!, columns.isClose[x]!);
    if (y > 0 && !down[place - width]) go(place - width, 1, ys[y]! - ys[y - 1]!, columns.isClose[x]!);
    // The end is reached along a row; from a column it takes a bend more.
    if (now === goal + 1) go(goal >> 1, 0, 0, false);
  }
  if (cost[goal] === Infinity) return null;
  const points: Point[] = [];
  for (let now = goal; now >= 0; now = from[now]!) {
    const place = now >> 1, point = {x: xs[place % width]!, y: ys[Math.floor(place / width)]!}, [b, a] = [points.at(-1), points.at(-2)];
    if (b && b.x === point.x && b.y === point.y) continue;
    if (a && b && (a.x === b.x && b.x === point.x || a.y === b.y && b.y === point.y)) points.pop();
    points.push(point);
  }
  return points.reverse();
}

const holds = (b: Box, p: Point) => p.x > b.x - margin && p.x < b.x + b.width + margin && p.y > b.y - margin && p.y < b.y + b.height + margin;
const meets = (b: Box, p: Point, q: Point) => Math.min(p.x, q.x) < b.x + b.width && Math.max(p.x, q.x) > b.x &&
  Math.min(p.y, q.y) < b.y + b.height && Math.max(p.y, q.y) > b.y;

const courses = new Map<string, Point[]>();
/// By ends only: what is kept while cards move.
const latest = new Map<string, Point[]>();
function remember(map: Map<string, Point[]>, key: string, course: Point[]) {
  if (map.size > 2000) map.clear();
  map.set(key, course);
}

/// From the right side of a card to the left side of another; `lane` keeps wires of several outputs apart. Where
/// every way is barred, cards in the way are passed behind. While cards move, a course that is still free stays.
export function courseAround(source: Point, target: Point, boxes: Box[], lane: number, moves: boolean): Point[] {
  const ends = [source.x, source.y, target.x, target.y, lane].join(), before = latest.get(ends);
  if (moves && before && !boxes.some((b) => before.some((p, i) => i > 0 && meets(b, before[i - 1]!, p)))) return before;
  const stub = 12 + 2.5 * lane, begin = {x: source.x + stub, y: source.y}, end = {x: target.x - stub, y: target.y};
  const within = (far: number) => {
    const left = Math.min(begin.x, end.x) - far, right = Math.max(begin.x, end.x) + far;
    const top = Math.min(begin.y, end.y) - far, bottom = Math.max(begin.y, end.y) + far;
    return boxes.filter((b) => b.x < right && b.x + b.width > left && b.y < bottom && b.y + b.height > top);
  };
  const near = within(reach);
  const key = [ends, ...near.flatMap((b) => [b.x, b.y, b.width, b.height])].join();
  const known = courses.get(key);
  if (known) remember(latest, ends, known);
  if (known) return known;
  const isFree = (b: Box) => !holds(b, begin) && !holds(b, end);
  const find = (among: Box[]) => between(begin, end, among.filter(isFree), lane);
  let found = find(near);
  if (!found || boxes.some((b) => isFree(b) && found!.some((p, i) => i > 0 && meets(b, found![i - 1]!, p)))) found = find(within(3 * reach)) ?? found;
  const course = [source, ...(found ?? [begin, {x: begin.x, y: end.y}, end]), target];
  const straight = course.filter((p, i) => !(course[i - 1]?.y === p.y && course[i + 1]?.y === p.y));
  remember(courses, key, straight);
  remember(latest, ends, straight);
  return straight;
}

/// Whether a curve from one to the other, as it is drawn where nothing is in the way, passes behind a card.
export function isBarred(source: Point, target: Point, boxes: Box[]): boolean {
  const top = Math.min(source.y, target.y), bottom = Math.max(source.y, target.y), steps = 32;
  const near = boxes.filter((b) => b.x < target.x && b.x + b.width > source.x && b.y < bottom && b.y + b.height > top);
  if (!near.length) return false;
  for (let step = 1; step < steps; ++step) {
    // A cubic curve whose handles reach half way across.
    const t = step / steps, s = 1 - t, ease = 3 * s * t * t + t * t * t;
    const x = source.x + (target.x - source.x) * (1.5 * s * s * t + 1.5 * s * t * t + t * t * t), y = source.y + (target.y - source.y) * ease;
    if (near.some((b) => x > b.x - 2 && x < b.x + b.width + 2 && y > b.y - 2 && y < b.y + b.height + 2)) return true;
  }
  return false;
}
