// The preview's page in a browser, with a mock of VS Code.
import { readFileSync } from "node:fs";
import { createRequire } from "node:module";
import path from "node:path";

import { chromium } from "playwright-core";

import { THEMES } from "./themes.mjs";

export const ROOT = path.resolve(import.meta.dirname, "../../..");
const EXTENSION = path.join(ROOT, "editors", "vscode");
const ORIGIN = "http://preview.test";

const esbuild = createRequire(path.join(EXTENSION, "package.json"))("esbuild");

/** A file of an editor's folder, bundled. */
async function bundleOf(file, options) {
  const entryPoints = [path.join(ROOT, "editors", file)];
  const { outputFiles } = await esbuild.build({ entryPoints, bundle: true, write: false, ...options });
  return Buffer.from(outputFiles[0].contents);
}

/** A module of an editor's folder, bundled for Node. */
export async function moduleOf(file) {
  const bundle = await bundleOf(file, { platform: "node", format: "esm" });
  return import(`data:text/javascript;base64,${bundle.toString("base64")}`);
}

// Not from the extension's dist/: what packs the extension at the same time builds that again.
const { page: html } = await moduleOf("vscode/src/preview/page.ts");
const SCRIPT = await bundleOf("vscode/webview/preview.ts", { platform: "browser", format: "iife" });
const STYLE = readFileSync(path.join(ROOT, "editors", "preview", "page", "style.css"));

export function launch() {
  return chromium.launch({ executablePath: process.env.CHROMIUM, args: ["--no-sandbox"] });
}

export class Panel {
  /** The messages of the page. */
  received = [];
  /** Errors and violations of the content security policy. */
  errors = [];
  /** Called with each message of the page. */
  onMessage = () => undefined;

  static async open(browser, { theme = "light", width = 760, height = 560, state, ...options } = {}) {
    const panel = new Panel();
    const context = await browser.newContext({ viewport: { width, height }, deviceScaleFactor: 2, ...options });
    panel.page = await context.newPage();
    panel.page.setDefaultTimeout(60_000);
    const { page } = panel;
    page.on("pageerror", (error) => panel.errors.push(String(error)));
    page.on("console", (message) => {
      if (message.type() === "error") panel.errors.push(message.text());
    });
    await page.exposeFunction("toHost", (message) => {
      panel.received.push(message);
      panel.onMessage(message);
    });
    await page.addInitScript((initial) => {
      let state = initial;
      // Before the page receives it.
      window.addEventListener("message", ({ data }) => {
        if (data.type === "path") window.receivedAt = performance.now();
      });
      window.acquireVsCodeApi = () => ({
        postMessage: (message) => void window.toHost(message),
        getState: () => state,
        setState: (changed) => {
          state = structuredClone(changed);
          window.savedState = state;
        },
      });
    }, state);
    const files = {
      "/": { contentType: "text/html", body: html({ source: ORIGIN, script: "/preview.js", style: "/preview.css", nonce: "abc" }) },
      "/preview.js": { contentType: "text/javascript", body: SCRIPT },
      "/preview.css": { contentType: "text/css", body: STYLE },
    };
    await page.route("**/*", (route) => {
      const file = files[new URL(route.request().url()).pathname];
      return file ? route.fulfill(file) : route.abort();
    });
    await page.goto(`${ORIGIN}/`);
    await panel.setTheme(theme);
    return panel;
  }

  /** Sets a theme as VS Code does, by a class and variables. */
  setTheme(theme) {
    return this.page.evaluate(({ kind, variables }) => {
      document.body.className = kind;
      for (const [name, value] of Object.entries(variables)) document.documentElement.style.setProperty(name, value);
    }, THEMES[theme]);
  }

  post(message) {
    return this.page.evaluate((data) => window.postMessage(data, "*"), message);
  }

  part(name) {
    return this.page.locator(`[data-part="${name}"]`);
  }

  /** A data attribute of the page. */
  data(name) {
    return this.page.locator("main").getAttribute(`data-${name}`);
  }

  async until(name, value) {
    await this.page.locator(`main[data-${name}="${value}"]`).waitFor({ state: "attached" });
  }

  /** Waits for a message of this type; messages leave the browser asynchronously. */
  async message(type) {
    let found;
    while (!(found = this.received.findLast((message) => message.type === type))) {
      await new Promise((resolve) => (this.onMessage = resolve));
    }
    return found;
  }

  close() {
    return this.page.context().close();
  }
}
