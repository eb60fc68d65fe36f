// Parts of a JSON text with comments, by what they are.
const parts = /(\/\/[^\n]*|\/\*[\s\S]*?\*\/)|("(?:[^"\\\n]|\\.)*")(\s*:)?|(-?\d[\d.eE+-]*)|(true|false|null)/g;

export function coloured(text: string): [string, string][] {
  // Colours of a very long text would make typing slow.
  if (text.length > 60_000) return [['', text]];
  const found: [string, string][] = [];
  let from = 0;
  for (const match of text.matchAll(parts)) {
    if (match.index > from) found.push(['', text.slice(from, match.index)]);
    const [all, comment, quoted, colon, number] = match;
    if (comment) found.push(['comment', comment]);
    else if (quoted) {
      found.push([colon ? 'key' : /^"[@=$]/.test(quoted) ? 'reference' : 'string', quoted]);
      if (colon) found.push(['', colon]);
    } else found.push([number ? 'number' : 'word', all]);
    from = match.index + all.length;
  }
  found.push(['', text.slice(from)]);
  return found;
}
