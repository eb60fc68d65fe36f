// What a node says of itself in one short line.
import type { GraphNode, Param } from '../state/protocol.ts';
import { session } from '../state/session.svelte.ts';

// The parameters that tell most about a node, if none was changed or several were.
const telling = ['path', 'kind', 'preset', 'map', 'size', 'mode', 'basis', 'value', 'radius', 'scale', 'quality', 'margin', 'to', 'shape', 'k'];

export function spelled(value: unknown): string {
  if (typeof value === 'string') return value;
  if (Array.isArray(value)) return value.map(spelled).join(value.length === 2 ? ' × ' : ', ');
  if (value !== null && typeof value === 'object')
    return Object.entries(value).map(([key, item]) => `${key} ${spelled(item)}`).join(', ');
  return typeof value === 'number' ? String(Math.round(value * 1e6) / 1e6) : String(value ?? '');
}

/// A path as the document has it, from the graph's folder on; what is too long loses its beginning.
export function shortPath(path: string, most = Infinity): string {
  const home = (session.document?.file.folder ?? '') + '/';
  const own = path + '/' === home ? '.' : home.length > 1 && path.startsWith(home) ? path.slice(home.length) : path;
  if (own.length <= most) return own;
  const cut = own.indexOf('/', own.length - most + 1);
  return cut < 0 ? own : '…' + own.slice(cut);
}

export const isExpression = (value: unknown): value is string =>
  typeof value === 'string' && (value.startsWith('=') || /\$[A-Za-z_]/.test(value));

/// `whole`: what a shortened text says in full.
export function tellingLine(node: GraphNode): {name: string; text: string; whole: string} | null {
  const given = node.params.filter((p) => p.name in node.values);
  const rank = (p: Param) => { const at = telling.indexOf(p.name); return at < 0 ? telling.length : at; };
  const best = given.sort((a, b) => rank(a) - rank(b))[0] ??
    node.params.filter((p) => telling.includes(p.name) && p.default !== '' && p.default !== undefined)
      .sort((a, b) => rank(a) - rank(b))[0];
  if (!best) return null;
  const value = node.values[best.name] ?? best.default;
  const shown = node.shown[best.name];
  const whole = shown !== undefined && shown !== '' ? shown : spelled(value);
  return {name: best.name, text: best.type === 'path' ? shortPath(whole, 22) : whole, whole};
}

export const seconds = (value: number) =>
  value < 0.0095 ? '<10 ms' : value < 1 ? `${Math.round(value * 1000)} ms` : value < 60 ? `${value.toFixed(1)} s`
    : `${Math.floor(value / 60)}:${String(Math.round(value % 60)).padStart(2, '0')} min`;
