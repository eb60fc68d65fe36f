// How numbers are dragged and written.
import type { Param } from '../state/protocol.ts';

export interface Range {low: number; high: number; step: number}

/// What a slider covers: the declared range if a hand can use it, else a useful part of it; null: no slider.
export function sliderRange(param: Param, value: number): Range | null {
  const {min, max} = param, isWhole = param.type === 'integer' || param.type === 'int';
  if (min === undefined || max === undefined) return null;
  const fallback = typeof param.default === 'number' ? param.default : 0;
  let low = min, high = max;
  if (max - min > 1000) {
    const reach = Math.max(1, 4 * Math.abs(fallback), 2 * Math.abs(value));
    high = Math.min(max, nice(reach));
    low = min < 0 ? Math.max(min, -nice(reach)) : min;
  } else if (fallback > 0 && max > 40 * fallback) {
    high = Math.min(max, nice(Math.max(8 * fallback, 2 * value)));
  }
  const step = param.step ?? (isWhole ? 1 : 10 ** Math.floor(Math.log10((high - low) / 150)));
  return {low, high, step};
}

function nice(value: number): number {
  const power = 10 ** Math.floor(Math.log10(value));
  return [1, 2, 5, 10].map((factor) => factor * power).find((candidate) => candidate >= value)!;
}

export const tidy = (value: number) => Number(value.toPrecision(7));

export function clamp(param: Param, value: number): number {
  const whole = param.type === 'integer' || param.type === 'int' || param.type === 'size' ? Math.round(value) : value;
  return tidy(Math.min(param.max ?? Infinity, Math.max(param.min ?? -Infinity, whole)));
}

export const rangeWords = (param: Param) =>
  param.min !== undefined && param.max !== undefined ? `${param.min} to ${param.max}`
    : param.min !== undefined ? `at least ${param.min}` : param.max !== undefined ? `at most ${param.max}` : '';

export const same = (a: unknown, b: unknown) => {
  if (Array.isArray(a) !== Array.isArray(b)) {
    const list = Array.isArray(a) ? a : b, one = Array.isArray(a) ? b : a;
    // A size may be one number.
    return Array.isArray(list) && list.length > 0 && list.every((item) => item === one);
  }
  return JSON.stringify(a) === JSON.stringify(b);
};
