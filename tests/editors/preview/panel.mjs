// The panel's page in a browser, where VS Code is played by a few lines.
import { readFileSync } from "node:fs";
import { createRequire } from "node:module";
import path from "node:path";

import { chromium } from "playwright-core";

import { THEMES } from "./themes.mjs";

export const ROOT = path.resolve(import.meta.dirname, "../../..");
const EXTENSION = path.join(ROOT, "editors", "vscode");
const ORIGIN = "http://preview.test";

const esbuild = createRequire(path.join(EXTENSION, "package.json"))("esbuild");

/** A module of the extension, for Node. */
export async function extensionModule(file) {
  const { outputFiles } = await esbuild.build({
    entryPoints: [path.join(EXTENSION, "src", "preview", file)],
    bundle: true,
    write: false,
    platform: "node",
    format: "esm",
  });
  return import(`data:text/javascript;base64,${Buffer.from(outputFiles[0].contents).toString("base64")}`);
}

const { page: html } = await extensionModule("page.ts");

export function launch() {
  return chromium.launch({ executablePath: process.env.CHROMIUM, args: ["--no-sandbox"] });
}

export class Panel {
  /** What the page has said. */
  said = [];
  /** What must not happen: errors, and what the page's policy forbids. */
  complaints = [];
  /** Called with each message of the page. */
  hear = () => undefined;

  static async open(browser, { theme = "light", width = 760, height = 560, state, ...options } = {}) {
    const panel = new Panel();
    const context = await browser.newContext({ viewport: { width, height }, deviceScaleFactor: 2, ...options });
    panel.page = await context.newPage();
    const { page } = panel;
    page.on("pageerror", (error) => panel.complaints.push(String(error)));
    page.on("console", (message) => {
      if (message.type() === "error") panel.complaints.push(message.text());
    });
    await page.exposeFunction("toHost", (message) => {
      panel.said.push(message);
      panel.hear(message);
    });
    await page.addInitScript((before) => {
      let kept = before;
      // Before the page hears it.
      window.addEventListener("message", ({ data }) => {
        if (data.type === "path") window.toldAt = performance.now();
      });
      window.acquireVsCodeApi = () => ({
        postMessage: (message) => void window.toHost(message),
        getState: () => kept,
        setState: (now) => {
          kept = structuredClone(now);
          window.keptState = kept;
        },
      });
    }, state);
    const files = {
      "/": { contentType: "text/html", body: html({ source: ORIGIN, script: "/preview.js", style: "/preview.css", nonce: "abc" }) },
      "/preview.js": { contentType: "text/javascript", body: readFileSync(path.join(EXTENSION, "dist", "preview.js")) },
      "/preview.css": { contentType: "text/css", body: readFileSync(path.join(EXTENSION, "dist", "preview.css")) },
    };
    await page.route("**/*", (route) => {
      const file = files[new URL(route.request().url()).pathname];
      return file ? route.fulfill(file) : route.abort();
    });
    await page.goto(`${ORIGIN}/`);
    await panel.dress(theme);
    return panel;
  }

  /** Puts on a theme, as VS Code does: a class and variables. */
  dress(theme) {
    return this.page.evaluate(({ kind, variables }) => {
      document.body.className = kind;
      for (const [name, value] of Object.entries(variables)) document.documentElement.style.setProperty(name, value);
    }, THEMES[theme]);
  }

  tell(message) {
    return this.page.evaluate((data) => window.postMessage(data, "*"), message);
  }

  part(name) {
    return this.page.locator(`[data-part="${name}"]`);
  }

  /** What the page says of itself. */
  data(name) {
    return this.page.locator("main").getAttribute(`data-${name}`);
  }

  async until(name, value) {
    await this.page.locator(`main[data-${name}="${value}"]`).waitFor({ state: "attached", timeout: 15_000 });
  }

  /** The last message of a kind, once the page has said one: what it says takes its own way out of the browser. */
  async heard(type) {
    let message;
    while (!(message = this.said.findLast((said) => said.type === type))) {
      await new Promise((resolve) => (this.hear = resolve));
    }
    return message;
  }

  close() {
    return this.page.context().close();
  }
}
