// Types into Visual Studio Code for record.py: reads a JSON object with an action from each line of standard input and
// prints an answer for each.
import { mkdirSync } from "node:fs";
import path from "node:path";
import readline from "node:readline";

import { Stage } from "../vscode/stage.mjs";

let stage;

const ACTIONS = {
  async start({ files, settings }) {
    stage = await Stage.open({ files, open: "patrol.pyr", settings });
    // The server is running once the error is shown.
    await stage.page.locator(".squiggly-error").first().waitFor();
    await stage.page.evaluate(watch);
    return { folder: stage.folder };
  },

  async open({ name }) {
    await stage.openFile(name);
    return {};
  },

  /**
   * Presses keys, one each `pace` seconds. `frames` is a folder for ten screenshots. If it is `patient`, the next key is pressed
   * when the editor has drawn the one before, and after those that it formats when what they change has been drawn, too.
   */
  async type({ keys, pace, frames, patient }) {
    await stage.page.evaluate(() => {
      globalThis.covered = {};
    });
    const start = performance.now();
    for (const [number, key] of keys.entries()) {
      // Late keys follow at once: the pace is under test, and the editor queues keys.
      const wait = start + number * pace * 1000 - performance.now();
      if (wait > 0) {
        await new Promise((resolve) => setTimeout(resolve, wait));
      }
      await press(key);
      if (patient) {
        await stage.page.evaluate(drawn, STILL[key] ?? 1);
      }
      if (frames && Math.floor((number * 10) / keys.length) < Math.floor(((number + 1) * 10) / keys.length)) {
        await takeFrame(frames, Math.floor(((number + 1) * 10) / keys.length));
      }
    }
    const seconds = (performance.now() - start) / 1000;
    return { seconds, covered: Object.values(await stage.page.evaluate(() => globalThis.covered)) };
  },

  async save() {
    await stage.page.keyboard.press("Control+S");
    return {};
  },
};

/** Frames without a change after which nothing more is expected from the server, after the keys that make it format. */
const STILL = { Enter: 12, "}": 60 };

/** In the page: waits until the text has been the same for some frames. A slow editor draws fewer. */
function drawn(frames) {
  return new Promise((resolve) => {
    let before;
    let still = -1;
    const look = () => {
      const text = document.querySelector(".monaco-editor.focused .view-lines")?.textContent;
      still = text === before ? still + 1 : 0;
      before = text;
      if (still >= frames) resolve();
      else requestAnimationFrame(look);
    };
    look();
  });
}

const NAMES = { Down: "ArrowDown", End: "End", Right: "ArrowRight", Enter: "Enter", Tab: "Tab" };

async function press(key) {
  await stage.page.keyboard.press(NAMES[key] ?? (key === " " ? "Space" : key));
}

async function takeFrame(folder, number) {
  mkdirSync(folder, { recursive: true });
  await stage.page.screenshot({ path: path.join(folder, `${String(number).padStart(2, "0")}.png`) });
}

/** In the page: records at every frame whether a popup covers the line of the cursor or the one above. */
function watch() {
  const POPUPS = {
    completion: ".suggest-widget.visible",
    "details of a completion": ".suggest-details-container",
    "parameter hints": ".parameter-hints-widget.visible",
    hover: ".monaco-hover:not(.hidden), .monaco-resizable-hover",
    fixes: ".action-widget",
    rename: ".rename-box",
  };
  // At the end of the window the editor itself puts its lists above the line, in every language.
  const STATUS_BAR = 30;
  const hasRoomBelow = (cursor, box) => cursor.bottom + box.height + STATUS_BAR < globalThis.innerHeight;
  globalThis.covered = {};
  // The editor moves a popup up to two frames after the text: a lens above the line, or a new line, is drawn first.
  const FRAMES = 3;
  const frames = new Map();
  const check = () => {
    const seen = new Set();
    const cursor = document.querySelector(".monaco-editor.focused .cursors-layer .cursor")?.getBoundingClientRect();
    for (const [name, selector] of cursor?.height ? Object.entries(POPUPS) : []) {
      for (const popup of document.querySelectorAll(selector)) {
        const box = popup.getBoundingClientRect();
        // A border may touch the line.
        const isOver = (top, bottom) => box.width > 0 && box.top < bottom - 2 && box.bottom > top + 2;
        const where = isOver(cursor.top, cursor.bottom)
          ? "the line being typed"
          : isOver(cursor.top - cursor.height, cursor.top) &&
            hasRoomBelow(cursor, box) &&
            "the line above the one being typed";
        if (where) {
          const lines = [...document.querySelectorAll(".monaco-editor.focused .view-line")];
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

for await (const line of readline.createInterface({ input: process.stdin })) {
  const { action, ...details } = JSON.parse(line);
  try {
    process.stdout.write(`${JSON.stringify(await ACTIONS[action](details))}\n`);
  } catch (error) {
    await stage?.keepPicture();
    await stage?.close();
    throw error;
  }
}
await stage?.close();
