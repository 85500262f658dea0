// What the editor compares the typed letters with to filter a list of completions.

/**
 * The filter of each word: the word without its last letter, so that it disappears from the list once it is typed in full, and no
 * list is open that the next key could be meant for. A word that others continue stays, and is the first of them.
 */
export function filterTexts(words: readonly string[]): string[] {
  const lower = words.map((word) => word.toLowerCase());
  const shortened = lower.map((word) => word.slice(0, -1));
  return words.map((word, index) => {
    const own = lower[index] ?? "";
    const isContinued = shortened.some((other, at) => lower[at] !== own && hasLetters(other, own));
    // The editor would rank both alike.
    const isContinuation = lower.some((other) => other !== own && other === shortened[index]);
    // An empty text would count as none.
    return isContinued || isContinuation ? word : word.slice(0, -1) || " ";
  });
}

/** Whether a text has these letters in this order, as the editor's own filter requires. */
function hasLetters(text: string, letters: string): boolean {
  let found = -1;
  return Array.from(letters).every((letter) => {
    found = text.indexOf(letter, found + 1);
    return found >= 0;
  });
}
