// Pictures by address, decoded once, and their channels as greys.
import type { Channel } from '../state/look.svelte.ts';

type Drawable = HTMLImageElement | HTMLCanvasElement;
const images = new Map<string, Promise<HTMLImageElement>>();
const channels = new Map<string, HTMLCanvasElement>();
const most = 24;

function remember<Value>(map: Map<string, Value>, key: string, value: Value): Value {
  map.set(key, value);
  if (map.size > most) map.delete(map.keys().next().value!);
  return value;
}

export function imageOf(url: string): Promise<HTMLImageElement> {
  const image = new Image();
  return images.get(url) ?? remember(images, url, new Promise((done, failed) => {
    image.onload = () => done(image);
    image.onerror = () => { images.delete(url); failed(new Error('The picture cannot be shown.')); };
    image.src = url;
  }));
}

export async function drawableOf(url: string, channel: Channel): Promise<Drawable> {
  const image = await imageOf(url);
  if (channel === 'all') return image;
  const key = channel + url, known = channels.get(key);
  if (known) return known;
  const canvas = document.createElement('canvas');
  canvas.width = image.naturalWidth;
  canvas.height = image.naturalHeight;
  const context = canvas.getContext('2d', {willReadFrequently: true})!;
  context.drawImage(image, 0, 0);
  const pixels = context.getImageData(0, 0, canvas.width, canvas.height), at = {r: 0, g: 1, b: 2, a: 3}[channel];
  for (let i = 0; i < pixels.data.length; i += 4) {
    const value = pixels.data[i + at]!;
    pixels.data[i] = pixels.data[i + 1] = pixels.data[i + 2] = value;
    pixels.data[i + 3] = 255;
  }
  context.putImageData(pixels, 0, 0);
  return remember(channels, key, canvas);
}

export const sizeOf = (image: Drawable) => image instanceof HTMLImageElement
  ? {width: image.naturalWidth, height: image.naturalHeight} : {width: image.width, height: image.height};
