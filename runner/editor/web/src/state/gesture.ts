// What is dragged with the pointer: all edits of one drag are one step of undo.
let current = '', count = 0;
const tabTime = Date.now().toString(36);

export const startGestures = () => {
  addEventListener('pointerdown', () => { current = `${tabTime}-${++count}`; }, true);
  // What is done when the pointer is let go belongs to it.
  const end = () => { const ended = current; setTimeout(() => { if (current === ended) current = ''; }); };
  addEventListener('pointerup', end, true);
  addEventListener('pointercancel', end, true);
};

/// Empty while no pointer is down.
export const gestureNow = () => current;
