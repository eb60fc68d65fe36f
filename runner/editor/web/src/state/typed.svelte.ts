// Values that were typed or entered and are not in the document: it has changed meanwhile, or the program is away.
import { SvelteMap } from 'svelte/reactivity';

export interface Typed {
  base: unknown;                // the value that it was typed over
  mine?: {value: unknown};      // what was entered; absent while it is being typed
}

/// By key of the field, so that nothing is lost when another node is selected.
export const typed = new SvelteMap<string, Typed>();

export const equal = (a: unknown, b: unknown) => JSON.stringify(a) === JSON.stringify(b);
