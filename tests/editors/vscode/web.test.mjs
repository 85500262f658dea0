// VS Code for the Web: the package for it, in a virtual workspace, with the language server in a worker.
import assert from "node:assert/strict";
import { after, afterEach, before, test } from "node:test";

import { Stage, until } from "./stage.mjs";

let stage;
before(async () => {
  stage = await Stage.open({ files: {}, virtual: "memfs:/w", open: "memfs:/w/sub/area.pyr", settings: { "editor.inlayHints.enabled": "off" } });
});
afterEach((t) => t.passed || stage?.keepPicture());
after(() => stage?.close());

const squiggles = () => stage.page.locator(".squiggly-error");

test("the server runs in a worker, and imports are found in the virtual workspace", async () => {
  // Its lens shows that the environment has no errors.
  await stage.page.locator(".codelens-decoration", { hasText: "Generate script" }).first().waitFor();
  await until("the import is found", async () => (await squiggles().count()) === 0);
  assert.deepEqual(stage.servers(), []);
});

test("problems come while typing, and completion", async () => {
  await stage.clickWord("turn left", "turn");
  await stage.page.keyboard.press("End");
  await stage.type("x");
  // Until the line is left, the next key may settle it.
  await stage.page.keyboard.press("ArrowUp");
  await squiggles().first().waitFor();
  await stage.page.keyboard.press("ArrowDown");
  await stage.page.keyboard.press("Backspace");
  await squiggles().first().waitFor({ state: "detached" });
  await stage.page.keyboard.press("Enter");
  await stage.openWidget("Control+Space", stage.page.locator(".suggest-widget.visible .monaco-list-row", { hasText: "move" }).first());
  await stage.page.keyboard.press("Escape");
  await stage.page.keyboard.press("Control+Z");
});

test("the preview shows the path and follows the text", async () => {
  await stage.clickLine("movement lap");
  await stage.page.keyboard.press("Control+K");
  await stage.page.keyboard.press("v");
  const frame = await stage.webview("main.preview");
  const state = () => frame.locator("main.preview").getAttribute("data-state");
  const drawn = () => frame.locator("main.preview").getAttribute("data-drawn").then(Number);
  await until("a path is drawn", async () => (await drawn()) > 0 && (await state()) === "ready");
  const count = await drawn();
  await stage.clickWord("move 2 meters", "2");
  await stage.page.keyboard.press("End");
  await stage.page.keyboard.press("Enter");
  await stage.type("move 1 meters");
  await until("it is redrawn", async () => (await drawn()) > count && (await state()) === "ready");
  await stage.picture("web");
});

test("a file that changes beside the program is read again", async () => {
  await stage.call("Virtual Files: Change the Scene");
  await squiggles().first().waitFor();
  await stage.call("Virtual Files: Change the Scene");
});

test("what needs a process is not offered", async () => {
  await stage.page.keyboard.press("F1");
  await stage.page.locator(".quick-input-widget input").first().fill(">PyDSLRep: ");
  const rows = stage.page.locator(".quick-input-widget .monaco-list-row");
  await rows.filter({ hasText: "Show Path Preview" }).first().waitFor();
  const titles = (await rows.allInnerTexts()).join();
  assert.doesNotMatch(titles, /Run in Simulator|New Program|CoppeliaSim/);
  await stage.page.keyboard.press("Escape");
});
