// Whether popups cover what is being typed.

/** Types, and returns the seconds that it took with the popups that covered the line of the cursor, or the one above. */
export async function coverage(page, typed) {
  await page.evaluate(() => {
    globalThis.covered = {};
  });
  const seconds = await typed();
  return { seconds, covered: Object.values(await page.evaluate(() => globalThis.covered)) };
}

/**
 * Records at every frame whether a popup covers the line of the cursor, or the one above. The selectors of `popups`, the
 * `cursor` and each `line` are below the shadow root of `host`, if there is one. Where less than `roomBelow` pixels would be
 * left below a popup, it may be above the line; without `roomBelow` it always may.
 */
export function watch(page, parts) {
  return page.evaluate(watchInPage, parts);
}

function watchInPage({ host, popups, cursor: cursorOf, line: lineOf, roomBelow }) {
  const root = (host && document.querySelector(host).shadowRoot) || document;
  const hasRoomBelow = (cursor, box) => roomBelow !== undefined && cursor.bottom + box.height + roomBelow < globalThis.innerHeight;
  globalThis.covered = {};
  // The editor moves a popup up to two frames after the text: a lens above the line, or a new line, is drawn first.
  const FRAMES = 3;
  const frames = new Map();
  const check = () => {
    const seen = new Set();
    const cursor = root.querySelector(cursorOf)?.getBoundingClientRect();
    for (const [name, selector] of cursor?.height ? Object.entries(popups) : []) {
      for (const popup of root.querySelectorAll(selector)) {
        const box = popup.getBoundingClientRect();
        // A border may touch the line.
        const isOver = (top, bottom) => box.width > 0 && box.top < bottom - 2 && box.bottom > top + 2;
        const where = isOver(cursor.top, cursor.bottom)
          ? "the line being typed"
          : isOver(cursor.top - cursor.height, cursor.top) &&
            hasRoomBelow(cursor, box) &&
            "the line above the one being typed";
        if (where) {
          const lines = [...root.querySelectorAll(lineOf)];
          const line = lines.find((one) => Math.abs(one.getBoundingClientRect().top - cursor.top) < 3)?.textContent;
          const what = `${name} over ${where}`;
          seen.add(what);
          frames.set(what, (frames.get(what) ?? 0) + 1);
          if (frames.get(what) === FRAMES) {
            globalThis.covered[what] ??= `${what}: ${line?.replaceAll("\u00a0", " ")}`;
          }
        }
      }
    }
    for (const what of frames.keys()) {
      if (!seen.has(what)) {
        frames.delete(what);
      }
    }
    requestAnimationFrame(check);
  };
  check();
}
