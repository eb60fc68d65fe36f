// Where one has been looking in each level; kept while the tab lives, also when the page is loaded again.
import type { Viewport } from '@xyflow/svelte';
import { session } from '../state/session.svelte.ts';

const key = () => `terrazzo.view ${session.document?.file.folder}/${session.document?.file.name} ${session.levelName}`;

export const views = {
  get(): Viewport | null {
    try {
      return JSON.parse(sessionStorage.getItem(key()) ?? 'null') as Viewport | null;
    } catch {
      return null;
    }
  },
  set(at: Viewport) { sessionStorage.setItem(key(), JSON.stringify(at)); },
};
