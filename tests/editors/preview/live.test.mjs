// The live preview as used: the page that the language server serves, in a browser, next to an editor.
import assert from "node:assert/strict";
import { createServer } from "node:http";
import { mkdirSync, readFileSync } from "node:fs";
import path from "node:path";
import { after, before, test } from "node:test";
import { pathToFileURL } from "node:url";

import { launch, ROOT } from "./panel.mjs";
import { rangeOf, Server } from "./server.mjs";

const EXAMPLES = path.join(ROOT, "examples");
const OUT = path.join(import.meta.dirname, "out");
const PICTURES = process.env.UPDATE_EXPECT ? path.join(ROOT, "docs", "images", "editors") : OUT;
const FILE = path.join(EXAMPLES, "crossing.pyr");
const URI = pathToFileURL(FILE).href;
const TEXT = readFileSync(FILE, "utf8");

let browser;
/** A session for each test, whose page ends with it. */
let server;
/** What the server asked the editor to show, and who waits for more. */
let shown;
let waiting;

before(async () => {
  for (const folder of [OUT, PICTURES]) mkdirSync(folder, { recursive: true });
  browser = await launch();
});

after(() => browser?.close());

/** A page of a new session with a program. */
async function open({ colorScheme = "light", width = 760, height = 560, contrast } = {}) {
  shown = [];
  waiting = [];
  server = await Server.start(EXAMPLES, { window: { showDocument: { support: true } } });
  server.connection.onRequest("window/showDocument", (params) => {
    shown.push(params);
    for (const resolve of waiting.splice(0)) resolve();
    return { success: true };
  });
  await server.open(URI, TEXT);
  const { address } = await server.request("workspace/executeCommand", { command: "pydslrep.openPreview", arguments: [{ uri: URI }] });
  const context = await browser.newContext({ viewport: { width, height }, deviceScaleFactor: 2, colorScheme, contrast });
  const page = await context.newPage();
  page.setDefaultTimeout(60_000);
  const errors = [];
  page.on("pageerror", (error) => errors.push(String(error)));
  page.on("console", (message) => {
    if (message.type() === "error") errors.push(message.text());
  });
  await page.goto(address);
  const main = page.locator("main");
  await page.locator('main[data-state="ready"]').waitFor();
  return { address, page, errors, data: (name) => main.getAttribute(`data-${name}`), until: (name, value) => page.locator(`main[data-${name}="${value}"]`).waitFor({ state: "attached" }) };
}

async function close({ page }) {
  await page.context().close();
  await server.stop();
}

test("the page draws the path, follows typing, and shows errors", async () => {
  const live = await open();
  const { page } = live;
  assert.equal(shown[0].external, true);
  assert.equal(await page.title(), "Path: crossing.pyr");
  assert.deepEqual(await page.locator(".robots .name").allTextContents(), ["north", "east", "south", "west"]);
  const end = page.locator(".robots small").first();
  const before = await end.textContent();
  await server.change(URI, rangeOf(TEXT, "2.1", TEXT.indexOf("movement down")), "2.9");
  await page.waitForFunction((text) => document.querySelector(".robots small").textContent !== text, before);
  assert.equal(await live.data("state"), "ready");
  await server.change(URI, rangeOf(TEXT, "2.1", TEXT.indexOf("movement down")), "x");
  // Until the line is left, the next key may settle it.
  await server.leaveLine(URI);
  await live.until("state", "stale");
  assert.match(await page.locator('[data-part="banner"]').textContent(), /crossing has errors: .+ line \d+ — Showing the last valid path\./);
  assert.deepEqual(live.errors, []);
  await close(live);
});

test("the cursor selects in the page, and a click in the page in the editor", async () => {
  const live = await open();
  const { page } = live;
  const action = rangeOf(TEXT, "turn left", TEXT.indexOf("movement down"));
  await server.request("textDocument/documentHighlight", { textDocument: { uri: URI }, position: action.start });
  await page.waitForFunction(() => document.querySelector("main").dataset.highlighted !== "");
  assert.match(await live.data("highlighted"), /^down \d+$/);
  await page.keyboard.press("n");
  await page.keyboard.press("Enter");
  while (shown.length < 2) await new Promise((resolve) => waiting.push(resolve));
  assert.equal(shown[1].uri, URI);
  assert.equal(shown[1].takeFocus, true);
  assert.ok(shown[1].selection.end.character > 0);
  await close(live);
});

test("a run's path is drawn, and the picture can be saved", async () => {
  const live = await open();
  await server.request("workspace/executeCommand", { command: "pydslrep.run", arguments: [{ uri: URI, environment: "crossing" }] });
  await live.until("driven", "crossing");
  const [download] = await Promise.all([live.page.waitForEvent("download"), live.page.keyboard.press("e")]);
  assert.equal(download.suggestedFilename(), "crossing.png");
  assert.equal(readFileSync(await download.path()).subarray(1, 4).toString(), "PNG");
  assert.deepEqual(live.errors, []);
  await close(live);
});

test("the page says when the session has ended", async () => {
  const live = await open();
  await server.stop();
  await live.page.getByText("The editor's session has ended").waitFor();
  await live.page.context().close();
});

test("pages of other origins get nothing", async (current) => {
  const live = await open();
  const secret = new URL(live.address);
  const hostile = createServer((_, response) => response.setHeader("content-type", "text/html").end("<!DOCTYPE html><title>x</title>"));
  current.after(() => hostile.close());
  await new Promise((resolve) => hostile.listen(0, "127.0.0.1", resolve));
  const context = await browser.newContext();
  const page = await context.newPage();
  page.setDefaultTimeout(60_000);
  // Another port of the same host, and another name for it.
  for (const host of ["127.0.0.1", "localhost"]) {
    await page.goto(`http://${host}:${hostile.address().port}/`);
    const got = await page.evaluate(async (address) => {
      const attempt = async (work) => {
        try {
          return await work();
        } catch {
          return "nothing";
        }
      };
      const load = (tag, attribute, name) =>
        new Promise((resolve) => {
          const element = document.createElement(tag);
          element.onload = () => resolve("loaded");
          element.onerror = () => resolve("nothing");
          if (tag === "link") element.rel = "stylesheet";
          element[attribute] = address + name;
          document.body.append(element);
        });
      const post = { method: "POST", body: '{"jsonrpc":"2.0","id":1,"method":"pydslrep/plannedAt","params":{}}' };
      const text = async (response) => (await response).text();
      const frame = document.createElement("iframe");
      const framed = new Promise((resolve) => (frame.onload = () => resolve(frame.contentDocument === null ? "nothing" : "read")));
      frame.src = address;
      document.body.append(frame);
      return [
        await attempt(() => text(fetch(address))),
        await attempt(() => text(fetch(`${address}messages`, post))),
        await attempt(() => text(fetch(`${address}messages`, { ...post, headers: { "content-type": "application/json" } }))),
        (await attempt(() => text(fetch(`${address}page.js`, { mode: "no-cors" })))) || "nothing",
        (await attempt(() => text(fetch(`${address}messages`, { ...post, mode: "no-cors" })))) || "nothing",
        await load("script", "src", "page.js"),
        await load("link", "href", "page.css"),
        await new Promise((resolve) => {
          const events = new EventSource(`${address}events`);
          events.onmessage = () => resolve("event");
          events.onerror = () => resolve("nothing");
        }),
        await framed,
      ];
    }, secret.href);
    assert.deepEqual([...new Set(got)], ["nothing"], `${host}: ${got}`);
    assert.equal(page.frames().length, 2);
    assert.equal(await page.frames()[1].locator("main").count(), 0);
  }
  await context.close();
  await close(live);
});

test("pictures", async () => {
  for (const [file, options] of [
    ["live-preview", { width: 900, height: 560 }],
    ["live-dark", { colorScheme: "dark" }],
    ["live-contrast", { colorScheme: "dark", contrast: "more" }],
    ["live-contrast-light", { contrast: "more" }],
    ["live-narrow", { width: 380, height: 640, colorScheme: "dark" }],
  ]) {
    const live = await open(options);
    await server.request("pydslrep/plannedAt", { textDocument: { uri: URI }, position: rangeOf(TEXT, "move 1.4").start });
    await live.page.waitForFunction(() => document.querySelector("main").dataset.highlighted !== "");
    await live.page.locator('[data-part="slider"]').evaluate((input) => {
      input.value = String(Number(input.max) * 0.4);
      input.dispatchEvent(new Event("input"));
    });
    await live.page.screenshot({ path: path.join(file === "live-preview" ? PICTURES : OUT, `${file}.png`) });
    assert.deepEqual(live.errors, []);
    await close(live);
  }
});
