// One stream of events from the program; it comes back after the program or the network was away.
import { ask, Refused, type DocumentState } from './protocol.ts';
import { runs } from './runs.svelte.ts';
import { session, tab } from './session.svelte.ts';
import { sweep } from './sweep.svelte.ts';

const checkEvery = 25_000;

export function listen(): () => void {
  let source: EventSource | null = null, retry = 0, timer: ReturnType<typeof setTimeout> | undefined;

  const open = () => {
    source?.close();
    source = new EventSource('/api/events?tab=' + tab);
    const on = (name: string, take: (data: never) => void) =>
      source!.addEventListener(name, (event) => take(JSON.parse((event as MessageEvent<string>).data) as never));
    source.onopen = () => {
      const wasLost = !session.connected;
      retry = 0;
      if (wasLost || !session.document)
        session.refresh().then(() => { session.connected = true; session.stopped = session.shutOut = false; }, lost);
    };
    source.onerror = () => {
      lost();
      // The stream does not say why.
      ask('state').then(() => { session.shutOut = false; }, (error: unknown) => { session.shutOut = error instanceof Refused && error.status === 403; });
    };
    on('state', (document: DocumentState) => session.take(document));
    on('plan', (plan: {stages: []; summary: string}) => runs.takePlan(plan));
    on('picture', (picture: never) => runs.takePicture(picture));
    on('ran', (how: never) => runs.ended(how));
    on('sweep_picture', (event: never) => sweep.takePicture(event));
    on('sweep_failed', (event: never) => sweep.takeFailure(event));
    on('swept', (event: never) => sweep.ended(event));
    on('bye', () => { session.stopped = true; lost(); });
    for (const kind of ['start', 'progress', 'done', 'cached', 'failed', 'skipped', 'note'])
      on(kind, (event: never) => runs.takeEvent(kind, event));
  };

  const lost = () => {
    session.connected = false;
    runs.running = false;
    source?.close();
    clearTimeout(timer);
    timer = setTimeout(open, Math.min(4000, 300 * 2 ** retry++));
  };

  // A laptop that slept has a dead stream without an error.
  const watch = setInterval(() => {
    if (source?.readyState === EventSource.CLOSED && session.connected) lost();
  }, checkEvery);

  open();
  return () => { source?.close(); clearInterval(watch); clearTimeout(timer); };
}
