// Colours of parameters are spelled as the browser's chooser spells them: sRGB, but from 0 to 1.
export const toHex = (values: number[]) => '#' + values.slice(0, 3).map((v) =>
  Math.round(255 * Math.min(1, Math.max(0, v))).toString(16).padStart(2, '0')).join('');

export const fromHex = (hex: string) => [1, 3, 5].map((at) => Math.round(parseInt(hex.slice(at, at + 2), 16) / 2.55) / 100);
