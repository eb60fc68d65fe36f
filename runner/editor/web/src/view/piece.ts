// The piece of a uv map under the pointer: asked for, and lit up.
import { ask, type Picture } from '../state/protocol.ts';
import type { Point } from '../state/ui.svelte.ts';

export interface Piece {
  digest: string;
  exemplar: {width: number; height: number};
  shift: [number, number];  // from a pixel of the result to the exemplar's, modulo the exemplar's size
  area: number;
  x: number; y: number; width: number; height: number;  // what it covers in the result
  runs: number[];           // y, begin, end of each
  mask: HTMLCanvasElement;
}

export async function pieceAt(picture: Picture, at: Point): Promise<Piece | null> {
  const {digest, exemplar} = picture;
  if (!exemplar) return null;
  const {shift, area, runs} = await ask<{shift: [number, number]; area: number; runs: number[]}>('piece', {digest, ...at, exemplar});
  let left = Infinity, right = 0;
  for (let i = 0; i < runs.length; i += 3) {
    left = Math.min(left, runs[i + 1]!);
    right = Math.max(right, runs[i + 2]!);
  }
  const top = runs[0]!, height = runs.at(-3)! - top + 1, width = right - left;
  const mask = document.createElement('canvas');
  mask.width = width;
  mask.height = height;
  const context = mask.getContext('2d')!;
  context.fillStyle = '#ffd54a';
  for (let i = 0; i < runs.length; i += 3) context.fillRect(runs[i + 1]! - left, runs[i]! - top, runs[i + 2]! - runs[i + 1]!, 1);
  return {digest, exemplar, shift, area, runs, x: left, y: top, width, height, mask};
}

export function holds(piece: Piece, at: Point): boolean {
  for (let i = 0; i < piece.runs.length; i += 3)
    if (piece.runs[i] === at.y && piece.runs[i + 1]! <= at.x && at.x < piece.runs[i + 2]!) return true;
  return false;
}

/// Where it lies in a result, or with `inExemplar` in the exemplar; twice or four times where it crosses the border.
export function placesOf(piece: Piece, inExemplar: boolean): Point[] {
  if (!inExemplar) return [{x: piece.x, y: piece.y}];
  const {width: w, height: h} = piece.exemplar;
  const x = (piece.x + piece.shift[0]) % w, y = (piece.y + piece.shift[1]) % h;
  const out: Point[] = [];
  for (let left = x; left > -piece.width; left -= w) for (let top = y; top > -piece.height; top -= h) out.push({x: left, y: top});
  return out;
}

/// Darkens all but the piece, and draws a line around it. `corners`: where copies of the picture begin on the screen;
/// `scale`: pixels of the screen for one of the result, or of the exemplar.
export function drawPiece(context: CanvasRenderingContext2D, piece: Piece, places: Point[], corners: Point[], scale: number,
                          area: {x: number; y: number; width: number; height: number}) {
  const {canvas} = context, ratio = devicePixelRatio;
  const layer = document.createElement('canvas');
  layer.width = canvas.width;
  layer.height = canvas.height;
  const over = layer.getContext('2d')!;
  over.setTransform(ratio, 0, 0, ratio, 0, 0);
  over.imageSmoothingEnabled = false;
  const stamp = (dx: number, dy: number) => {
    for (const corner of corners) for (const place of places)
      over.drawImage(piece.mask, corner.x + place.x * scale + dx, corner.y + place.y * scale + dy, piece.width * scale, piece.height * scale);
  };
  const cut = () => { over.globalCompositeOperation = 'destination-out'; stamp(0, 0); over.globalCompositeOperation = 'source-over'; };
  over.fillStyle = 'rgb(0 0 0 / 55%)';
  over.fillRect(area.x, area.y, area.width, area.height);
  const line = 1.5;
  for (const [dx, dy] of [[-1, 0], [1, 0], [0, -1], [0, 1], [-0.7, -0.7], [0.7, -0.7], [-0.7, 0.7], [0.7, 0.7]]) stamp(dx! * line, dy! * line);
  cut();
  context.save();
  context.beginPath();
  context.rect(area.x, area.y, area.width, area.height);
  context.clip();
  context.setTransform(1, 0, 0, 1, 0, 0);
  context.drawImage(layer, 0, 0);
  context.restore();
}
