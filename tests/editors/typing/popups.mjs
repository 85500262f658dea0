// Whether popups cover what is being typed.

/** Frames after which a popup does not go away by itself, however slow the server is. */
export const STAYS = 600;

/**
 * Types, and returns the seconds that it took with the popups that covered the line of the cursor, or the one above. If it is
 * `patient`, each key waits until they are gone, and those that stay count.
 */
export async function coverage(page, patient, typed) {
  await page.evaluate((patient) => {
    globalThis.covered = {};
    globalThis.isPatient = patient;
  }, patient);
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
  globalThis.covering = {};
  // The editor moves a popup up to two frames after the text: a lens above the line, or a new line, is drawn first.
  const FRAMES = 3;
  const frames = new Map();
  const check = () => {
    const seen = {};
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
          // One that wraps is as high as all its rows.
          const holdsCursor = ({ top, bottom }) => top < cursor.top + 3 && cursor.top + 3 < bottom;
          const line = lines.find((one) => holdsCursor(one.getBoundingClientRect()))?.textContent;
          const what = `${name} over ${where}`;
          seen[what] = `${what}: ${line?.replaceAll("\u00a0", " ")}`;
          frames.set(what, (frames.get(what) ?? 0) + 1);
          if (frames.get(what) === FRAMES && !globalThis.isPatient) {
            globalThis.covered[what] ??= seen[what];
          }
        }
      }
    }
    for (const what of frames.keys()) {
      if (!(what in seen)) {
        frames.delete(what);
      }
    }
    globalThis.covering = seen;
    requestAnimationFrame(check);
  };
  check();
}
