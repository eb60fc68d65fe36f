// Values while a slider is dragged: at most one edit of a field is under way, and only the newest waits.
const queues = new Map<string, {next?: () => Promise<unknown>}>();

/// Resolves true once nothing of this field waits any more, false for a value that a newer one replaced.
export async function sendLatest(key: string, send: () => Promise<unknown>): Promise<boolean> {
  const queue = queues.get(key);
  if (queue) {
    queue.next = send;
    return false;
  }
  const mine: {next?: () => Promise<unknown>} = {};
  queues.set(key, mine);
  try {
    for (let now: typeof send | undefined = send; now; now = mine.next) {
      mine.next = undefined;
      await now();
      if (!mine.next) break;
    }
  } finally {
    queues.delete(key);
  }
  return true;
}
