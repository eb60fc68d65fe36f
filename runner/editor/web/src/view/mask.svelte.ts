// The mask that is painted on a picture: white where the brush was.
class Mask {
  canvas: HTMLCanvasElement | null = null;
  version = $state(0);
  brush = $state(32);
  erases = $state(false);
  isEmpty = $state(true);
  #history: ImageData[] = [];

  get #context() { return this.canvas!.getContext('2d', {willReadFrequently: true})!; }

  /// A stroke begins on a picture of that size.
  begin(width: number, height: number) {
    if (this.canvas?.width !== width || this.canvas.height !== height) {
      this.canvas = document.createElement('canvas');
      this.canvas.width = width;
      this.canvas.height = height;
      this.#history = [];
    }
    this.#history.push(this.#context.getImageData(0, 0, width, height));
    if (this.#history.length > 12) this.#history.shift();
  }
  stroke(from: {x: number; y: number}, to: {x: number; y: number}) {
    const context = this.#context;
    context.globalCompositeOperation = this.erases ? 'destination-out' : 'source-over';
    context.strokeStyle = '#ff3b6b';
    context.lineWidth = this.brush;
    context.lineCap = context.lineJoin = 'round';
    context.beginPath();
    context.moveTo(from.x, from.y);
    context.lineTo(to.x + 0.01, to.y);
    context.stroke();
    this.version++;
  }
  end() { this.isEmpty = false; }
  back() {
    const before = this.#history.pop();
    if (before) this.#context.putImageData(before, 0, 0);
    this.version++;
  }
  clear() {
    this.canvas = null;
    this.#history = [];
    this.isEmpty = true;
    this.version++;
  }

  /// A PNG of white on black, in base64.
  png(): string {
    const {width, height} = this.canvas!, flat = document.createElement('canvas');
    flat.width = width;
    flat.height = height;
    const context = flat.getContext('2d')!;
    const pixels = this.#context.getImageData(0, 0, width, height);
    for (let i = 0; i < pixels.data.length; i += 4) {
      pixels.data[i] = pixels.data[i + 1] = pixels.data[i + 2] = pixels.data[i + 3]!;
      pixels.data[i + 3] = 255;
    }
    context.putImageData(pixels, 0, 0);
    return flat.toDataURL('image/png').replace(/^.*,/, '');
  }
}

export const mask = new Mask();
