// The mask that is painted on a picture: values from black to white where the brush was, black elsewhere.
import type { Point } from '../state/ui.svelte.ts';

const black = [42, 107, 255], white = [255, 59, 107];  // how values look while they are painted
const most = 12;

function sized(width: number, height: number) {
  const canvas = document.createElement('canvas');
  canvas.width = width;
  canvas.height = height;
  return canvas;
}

class Mask {
  /// What is laid over the picture.
  canvas: HTMLCanvasElement | null = null;
  version = $state(0);
  brush = $state(32);
  value = $state(1);
  erases = $state(false);
  inverted = $state(false);
  isEmpty = $state(true);
  #values: HTMLCanvasElement | null = null;
  #history: ImageData[] = [];

  #contextOf(canvas: HTMLCanvasElement) { return canvas.getContext('2d', {willReadFrequently: true})!; }

  #of = '';

  /// It is of that node now; strokes on another one go.
  use(node: string) {
    if (node !== this.#of) this.clear();
    this.#of = node;
  }

  /// A stroke begins on a picture of that size.
  begin(width: number, height: number) {
    if (!this.#values || this.#values.width !== width || this.#values.height !== height) {
      this.canvas = sized(width, height);
      this.#values = sized(width, height);
      this.#history = [];
    }
    this.#history.push(this.#contextOf(this.#values).getImageData(0, 0, width, height));
    if (this.#history.length > most) this.#history.shift();
  }
  stroke(from: Point, to: Point) {
    const {value} = this, grey = Math.round(value * 255), tint = black.map((b, i) => Math.round(b + (white[i]! - b) * value));
    for (const [canvas, colour] of [[this.canvas!, tint], [this.#values!, [grey, grey, grey]]] as const) {
      const context = this.#contextOf(canvas);
      context.globalCompositeOperation = this.erases ? 'destination-out' : 'source-over';
      context.strokeStyle = `rgb(${colour.join(' ')})`;
      context.lineWidth = this.brush;
      context.lineCap = context.lineJoin = 'round';
      context.beginPath();
      context.moveTo(from.x, from.y);
      context.lineTo(to.x + 0.01, to.y);
      context.stroke();
    }
    this.version++;
  }
  end() { this.isEmpty = false; }
  back() {
    const before = this.#history.pop();
    if (!before) return;
    this.#contextOf(this.#values!).putImageData(before, 0, 0);
    const shown = new ImageData(before.width, before.height);
    for (let i = 0; i < before.data.length; i += 4) {
      for (let c = 0; c < 3; ++c) shown.data[i + c] = black[c]! + (white[c]! - black[c]!) * before.data[i]! / 255;
      shown.data[i + 3] = before.data[i + 3]!;
    }
    this.#contextOf(this.canvas!).putImageData(shown, 0, 0);
    this.version++;
  }
  clear() {
    this.canvas = this.#values = null;
    this.#history = [];
    this.isEmpty = true;
    this.version++;
  }

  /// A grey PNG, in base64.
  png(): string {
    const {width, height} = this.#values!, flat = sized(width, height), context = this.#contextOf(flat);
    const pixels = this.#contextOf(this.#values!).getImageData(0, 0, width, height);
    for (let i = 0; i < pixels.data.length; i += 4) {
      const painted = Math.round(pixels.data[i]! * pixels.data[i + 3]! / 255);
      pixels.data[i] = pixels.data[i + 1] = pixels.data[i + 2] = this.inverted ? 255 - painted : painted;
      pixels.data[i + 3] = 255;
    }
    context.putImageData(pixels, 0, 0);
    return flat.toDataURL('image/png').replace(/^.*,/, '');
  }
}

export const mask = new Mask();
