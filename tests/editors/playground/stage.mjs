// The playground in a browser, from a server of static files.
import assert from "node:assert/strict";
import { createReadStream, existsSync, mkdirSync, readFileSync } from "node:fs";
import { createServer } from "node:http";
import path from "node:path";

import { chromium } from "playwright-core";

export const ROOT = path.resolve(import.meta.dirname, "../../..");
export const DIST = process.env.PYDSLREP_PLAYGROUND || path.join(ROOT, "editors/playground/dist");
export const OUT = path.join(import.meta.dirname, "out");
/** Where pictures for the documentation go. */
export const PICTURES = process.env.UPDATE_EXPECT ? path.join(ROOT, "docs/images/playground") : OUT;

const TYPES = {
  ".css": "text/css",
  ".html": "text/html; charset=utf-8",
  ".js": "text/javascript",
  ".json": "application/json",
  ".mjs": "text/javascript",
  ".svg": "image/svg+xml",
  ".wasm": "application/wasm",
  ".zip": "application/zip",
};

/** The policy of the page. Sent with every file, it also binds the workers, which a page's own policy does not. */
const POLICY = /Content-Security-Policy"\s+content="([^"]*)"/.exec(readFileSync(path.join(DIST, "index.html"), "utf8"))[1];

/** Serves dist/. */
export async function serve() {
  const server = createServer((request, response) => {
    const { pathname } = new URL(request.url, "http://localhost");
    const file = path.join(DIST, pathname === "/" ? "index.html" : pathname);
    if (!file.startsWith(DIST) || !existsSync(file)) {
      response.writeHead(404).end();
      return;
    }
    const headers = { "Content-Type": TYPES[path.extname(file)] ?? "text/plain" };
    if (path.basename(file) !== "preview.html") headers["Content-Security-Policy"] = POLICY;
    response.writeHead(200, headers);
    createReadStream(file).pipe(response);
  });
  await new Promise((resolve) => server.listen(0, "127.0.0.1", resolve));
  return { address: `http://127.0.0.1:${server.address().port}/`, close: () => server.close() };
}

export function launch() {
  mkdirSync(OUT, { recursive: true });
  return chromium.launch({ executablePath: process.env.CHROMIUM, args: ["--no-sandbox"] });
}

export class Playground {
  /** Errors of the page, and violations of its policy. */
  errors = [];
  /** The addresses of everything that it loaded. */
  requests = [];

  static async open(browser, address, { colorScheme = "light", width = 1280, height = 800, fragment = "", ...options } = {}) {
    return Playground.openIn(await browser.newContext({ viewport: { width, height }, colorScheme, ...options }), address, { fragment });
  }

  /** Opens the playground in a new tab of a browser that may have others. */
  static async openIn(context, address, { fragment = "" } = {}) {
    const playground = new Playground();
    const page = (playground.page = await context.newPage());
    page.setDefaultTimeout(Number(process.env.PATIENCE ?? 60_000));
    page.on("pageerror", (error) => playground.errors.push(String(error)));
    page.on("console", (message) => {
      if (message.type() === "error") playground.errors.push(message.text());
    });
    page.on("request", (request) => playground.requests.push(request.url()));
    await page.goto(address + fragment);
    return playground;
  }

  /** The editor that is shown. */
  get editor() {
    return this.page.locator("#editor .cm-editor:not([hidden])");
  }

  get content() {
    return this.editor.locator(".cm-content");
  }

  get preview() {
    return this.page.frameLocator("#preview");
  }

  /** The text of the shown editor. */
  text() {
    return this.content.evaluate((content) => content.cmTile.root.view.state.doc.toString());
  }

  /** Waits until the shown editor has a text. */
  async becomes(expected) {
    await this.page.waitForFunction((text) => {
      const content = document.querySelector("#editor").shadowRoot.querySelector(".cm-editor:not([hidden]) .cm-content");
      return content.cmTile.root.view.state.doc.toString() === text;
    }, expected).catch(async () => assert.equal(await this.text(), expected));
  }

  /** Replaces the text, as pasting it does. */
  async write(text) {
    await this.content.evaluate((content, insert) => {
      const { view } = content.cmTile.root;
      view.dispatch({ changes: { from: 0, to: view.state.doc.length, insert }, userEvent: "input.paste" });
    }, text);
  }

  /** Places the cursor after a part of the text. */
  async place(part, { before = false } = {}) {
    await this.content.evaluate(
      (content, [wanted, isBefore]) => {
        const { view } = content.cmTile.root;
        const at = view.state.doc.toString().indexOf(wanted);
        if (at < 0) throw new Error(`no ${wanted}`);
        view.dispatch({ selection: { anchor: isBefore ? at : at + wanted.length }, scrollIntoView: true });
        view.focus();
      },
      [part, before],
    );
  }

  /** The line of the cursor, from 1. */
  line() {
    return this.content.evaluate((content) => {
      const { state } = content.cmTile.root.view;
      return state.doc.lineAt(state.selection.main.from).number;
    });
  }

  tab(name) {
    return this.page.getByRole("tab", { name });
  }

  choose(example) {
    return this.page.locator("#examples").selectOption(example);
  }

  /** Waits until the program's tab has a number of errors, or of warnings if there are no errors; none if it is 0. */
  async counts(number, severity = "error") {
    const badge = this.page.locator("#tab-program .badge");
    const wanted = this.page.locator(number === 0 ? "[hidden]" : `[data-severity="${severity}"]:not([hidden])`);
    const shown = number === 0 ? badge.and(wanted) : badge.and(wanted).and(this.page.getByText(`${number}`, { exact: true }));
    await shown.waitFor({ state: "attached" });
  }

  /** Waits until the preview shows the path of an environment. */
  async pathShown(environment) {
    const which = environment === undefined ? "" : `[data-environment="${environment}"]`;
    await this.preview.locator(`main[data-state="ready"]${which}`).waitFor({ state: "attached" });
  }

  async run() {
    await this.page.getByRole("button", { name: "Run" }).click();
  }

  /** Waits for the end of a run, and returns its exit code. */
  async ended(timeout = 120_000) {
    await this.page.locator("#output[data-code]").waitFor({ timeout });
    return Number(await this.page.locator("#output").getAttribute("data-code"));
  }

  /** What a button lets the user download. */
  async download(label) {
    const [download] = await Promise.all([
      this.page.waitForEvent("download"),
      this.page.locator("#downloads").getByRole("button", { name: label, exact: true }).click(),
    ]);
    return { name: download.suggestedFilename(), content: readFileSync(await download.path()) };
  }

  close() {
    return this.page.context().close();
  }
}
