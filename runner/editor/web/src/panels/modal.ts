// What opens over the page takes the keyboard's focus and gives it back.
export function modal(element: HTMLElement) {
  const before = document.activeElement as HTMLElement | null;
  const first = element.querySelector<HTMLElement>('[data-first], input, textarea, select, button, [tabindex="0"]');
  (first ?? element).focus();
  if (first instanceof HTMLInputElement) first.select();
  const onkeydown = (event: KeyboardEvent) => {
    if (event.key !== 'Tab' || event.defaultPrevented) return;
    const stops = [...element.querySelectorAll<HTMLElement>('button:not(:disabled), input, select, textarea, a[href], [tabindex="0"]')];
    const at = stops.indexOf(document.activeElement as HTMLElement);
    const next = event.shiftKey ? at - 1 : at + 1;
    event.preventDefault();
    stops[(next + stops.length) % stops.length]?.focus();
  };
  element.addEventListener('keydown', onkeydown);
  return {
    destroy() {
      element.removeEventListener('keydown', onkeydown);
      if (document.activeElement === document.body || element.contains(document.activeElement)) {
        if (before?.isConnected && before !== document.body) before.focus({preventScroll: true});
        else document.querySelector<HTMLElement>('#canvas')?.focus({preventScroll: true});
      }
    },
  };
}
