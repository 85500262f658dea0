// The path preview in the real editor: opens next to the program and follows the text.
import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import path from "node:path";
import { after, afterEach, before, test } from "node:test";

import { Stage, program, until } from "./stage.mjs";

let stage;
let frame;
before(async () => {
  stage = await Stage.open({
    files: { "convoy.pyr": program("examples/convoy.pyr") },
    open: "convoy.pyr",
    settings: { "editor.codeLens": false, "editor.inlayHints.enabled": "off" },
  });
});
afterEach((t) => t.passed || stage?.keepPicture());
after(() => stage?.close());

/** How many paths the page has drawn. */
const drawCount = () => frame.locator("main.preview").getAttribute("data-drawn").then(Number);

test("the preview opens next to the program by its keys", async () => {
  await stage.keyOf("PyDSLRep: Show Path Preview", "Ctrl+K");
  await stage.clickLine("parallel movement cross_1");
  await stage.page.keyboard.press("Control+K");
  await stage.page.keyboard.press("v");
  frame = await stage.webview("main.preview");
  await until("a path is drawn", async () => (await drawCount()) > 0);
  assert.equal(await frame.locator("main.preview").getAttribute("data-state"), "ready");
  const icon = stage.page.locator(".tab", { hasText: "Path: " }).locator(".monaco-icon-label-iconpath");
  assert.match(await icon.getAttribute("style"), /file-(light|dark)\.svg/);
  await stage.picture("preview");
});

/** The content of the canvases. */
const picture = () =>
  frame.evaluate(() => [...document.querySelectorAll("canvas")].map((canvas) => canvas.toDataURL()).join());

test("the path follows an edited number", async () => {
  const before = await picture();
  const count = await drawCount();
  await cursorAfter("move 2 meters at 10", "2");
  await stage.page.keyboard.press("Backspace");
  await stage.type("3");
  await until("it is redrawn", async () => (await drawCount()) > count && (await picture()) !== before);
  // Between the two keys, the path may have been drawn as stale.
  await until("the path is valid", async () => (await frame.locator("main.preview").getAttribute("data-state")) === "ready");
});

test("an error keeps the last picture and says so", async () => {
  await stage.page.keyboard.press("Backspace");
  // Until the line is left, the next key may settle it.
  await stage.page.keyboard.press("ArrowUp");
  await until("the path is stale", async () => (await frame.locator("main.preview").getAttribute("data-state")) === "stale");
  await stage.page.keyboard.press("ArrowDown");
  await stage.type("2");
  await until("the path is valid", async () => (await frame.locator("main.preview").getAttribute("data-state")) === "ready");
});

test("the path is exported as SVG, PNG and replay", async () => {
  for (const [format, name, begins] of [["SVG", "road.svg", "<svg"], ["PNG", "road.png", "\x89PNG"], ["Replay", "road-replay.svg", "<svg"]]) {
    await stage.call("PyDSLRep: Export Path…");
    await stage.page.locator(".quick-input-widget .monaco-list-row", { hasText: format }).first().click();
    await stage.acceptFile(name);
    await stage.toast(`Path exported: ${name}`);
    const content = readFileSync(path.join(stage.folder, name), "latin1");
    assert.ok(content.startsWith(begins) || content.includes(begins), content.slice(0, 80));
    assert.equal(content.includes("<animate"), format === "Replay");
  }
});

test("latency from a key to the picture", async (t) => {
  await stage.page.evaluate(() => {
    window.addEventListener("keydown", () => (window.lastKey = performance.timeOrigin + performance.now()), { capture: true });
  });
  await frame.evaluate(() => {
    const main = document.querySelector("main.preview");
    const seen = () => (window.lastDrawn = { count: Number(main.dataset.drawn), time: performance.timeOrigin + performance.now() });
    // The frame after the one with the change: only then it is visible.
    new MutationObserver(() => requestAnimationFrame(() => requestAnimationFrame(seen))).observe(main, { attributeFilter: ["data-drawn"] });
  });
  const times = [];
  for (let round = 0; round < (process.env.LONG ? 40 : 6); round++) {
    const count = await drawCount();
    await stage.page.keyboard.press(round % 2 === 0 ? "5" : "Backspace");
    const last = await until("it is drawn", async () => {
      const seen = await frame.evaluate(() => window.lastDrawn);
      return seen?.count > count && seen;
    });
    times.push(last.time - (await stage.page.evaluate(() => window.lastKey)));
  }
  times.sort((a, b) => a - b);
  const at = (share) => times[Math.floor(share * (times.length - 1))].toFixed(0);
  t.diagnostic(`${times.length} keys in a program of four robots: median ${at(0.5)} ms, 90 % within ${at(0.9)} ms, maximum ${at(1)} ms`);
});

/** Puts the cursor after a word of a line. */
async function cursorAfter(line, word) {
  await stage.clickLine(line);
  await stage.page.keyboard.press("Home");
  const text = (await stage.line(line).first().innerText()).trimStart();
  for (let at = 0; at < text.indexOf(word) + word.length; at++) {
    await stage.page.keyboard.press("ArrowRight");
  }
}
