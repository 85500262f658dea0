// What record.py asks of an editor in a browser: reads a JSON object with an action from each line of standard input, and
// prints an answer for each.
import { mkdirSync } from "node:fs";
import path from "node:path";
import readline from "node:readline";

import { STAYS } from "./popups.mjs";

/** Frames without a change after which nothing more is expected from the server, after the keys that make it format. */
const STILL = { Enter: 12, "}": 60 };

const NAMES = { Down: "ArrowDown", End: "End", Right: "ArrowRight", Enter: "Enter", Tab: "Tab" };

/** A key, or a character of a comment for which there is no key. */
function press(keyboard, key) {
  return key in NAMES ? keyboard.press(NAMES[key]) : keyboard.type(key);
}

/**
 * Presses keys, one each `pace` seconds. `frames` is a folder for ten screenshots. If it is `patient`, the next key is pressed
 * when the editor has drawn the one before and no popup covers the line any more, and after those that it formats when what
 * they change has been drawn, too.
 */
export async function type(page, { keys, pace, frames, patient }) {
  const start = performance.now();
  for (const [number, key] of keys.entries()) {
    // Late keys follow at once: the pace is under test, and the editor queues keys.
    const wait = start + number * pace * 1000 - performance.now();
    if (wait > 0) {
      await new Promise((resolve) => setTimeout(resolve, wait));
    }
    await press(page.keyboard, key);
    if (patient) {
      await drawn(page, STILL[key] ?? 1);
    }
    if (frames && Math.floor((number * 10) / keys.length) < Math.floor(((number + 1) * 10) / keys.length)) {
      await takeFrame(page, frames, Math.floor(((number + 1) * 10) / keys.length));
    }
  }
  return (performance.now() - start) / 1000;
}

/**
 * Waits until the text, `shownText` of the page, has been the same for some frames, and no popup covers the line: until the
 * answer of the server that closes or moves the one of the key before, since a list that was below a line is over it once that
 * wraps. A slow editor draws fewer frames.
 */
export function drawn(page, frames) {
  return page.evaluate(
    ([wanted, limit]) =>
      new Promise((resolve) => {
        let before;
        let still = -1;
        const look = () => {
          const text = globalThis.shownText();
          still = text === before ? still + 1 : 0;
          before = text;
          const { covered, covering } = globalThis;
          const isCovered = !Object.keys(covering).every((what) => what in covered);
          if (still >= wanted && !isCovered) resolve();
          else if (still > wanted + limit) resolve(Object.assign(covered, covering));
          else requestAnimationFrame(look);
        };
        look();
      }),
    [frames, STAYS],
  );
}

async function takeFrame(page, folder, number) {
  mkdirSync(folder, { recursive: true });
  await page.screenshot({ path: path.join(folder, `${String(number).padStart(2, "0")}.png`) });
}

/** Does what is asked until the input ends; `failed` keeps what helps to find out why it could not. */
export async function answer(actions, failed) {
  for await (const line of readline.createInterface({ input: process.stdin })) {
    const { action, ...details } = JSON.parse(line);
    try {
      process.stdout.write(`${JSON.stringify(await actions[action](details))}\n`);
    } catch (error) {
      await failed();
      throw error;
    }
  }
}
