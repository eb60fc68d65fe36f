// How well a text is what somebody means who typed a few letters.

/// 0: not at all. Letters in order; beginnings of words and runs of letters count more.
export function likeness(typed: string, text: string): number {
  const letters = typed.toLowerCase().replaceAll(' ', ''), low = text.toLowerCase();
  if (!letters) return 1;
  if (low === letters) return 1000;
  if (low.startsWith(letters)) return 800 - low.length;
  const word = low.search(new RegExp('(?<![a-z0-9])' + letters.replace(/[^a-z0-9]/g, '\\$&')));
  if (word >= 0) return 600 - word - low.length / 10;
  const inside = low.indexOf(letters);
  if (inside >= 0) return 400 - inside - low.length / 10;
  let score = 200, at = -1;
  for (const letter of letters) {
    const next = low.indexOf(letter, at + 1);
    if (next < 0) return 0;
    const begins = next === 0 || !/[a-z0-9]/.test(low[next - 1]!);
    score -= begins ? 0 : Math.min(20, next - at - 1) * 2;
    at = next;
  }
  return Math.max(1, score - low.length / 10);
}

/// Names before what is said of them: a word of the help must be typed as it stands.
export function rank(typed: string, name: string, summary: string, help: string): number {
  const byName = likeness(typed, name), words = typed.toLowerCase().trim().split(/\s+/);
  if (byName > 1 || !typed.trim()) return byName * 2;
  const inText = (text: string) => words.every((word) => word.length > 1 && text.toLowerCase().includes(word));
  return inText(summary) ? 90 : inText(help) ? 40 : inText(`${name} ${summary} ${help}`) ? 20 + Math.max(...words.map((word) => likeness(word, name))) / 50 : 0;
}
