// A real editor for tests: code-server with a fresh profile and the extension, in a headless Chromium.
import { execFileSync, spawn } from "node:child_process";
import { cpSync, existsSync, mkdirSync, mkdtempSync, readFileSync, renameSync, rmSync, writeFileSync } from "node:fs";
import net from "node:net";
import os from "node:os";
import path from "node:path";

import { chromium } from "playwright-core";

const { EXTENSIONS, VSIX_WEB, CHROMIUM, CODE_SERVER, PICTURES } = process.env;
for (const [name, value] of Object.entries({ EXTENSIONS, VSIX_WEB, CHROMIUM, CODE_SERVER })) {
  if (!value) {
    throw new Error(`${name} is not set: start the tests with tests/editors/run.sh vscode`);
  }
}
const entry = path.join(CODE_SERVER, "node_modules/code-server/out/node/entry.js");

export const repository = path.resolve(import.meta.dirname, "../../..");

/** The extension that changes settings for tests. */
const TEST_EXTENSION = path.join(import.meta.dirname, "api");

/** The extension with a workspace in memory, for VS Code for the Web. */
const VIRTUAL_FILES = path.join(import.meta.dirname, "virtual");

/** The timeout of all waits, milliseconds. */
const TIMEOUT = Number(process.env.PATIENCE ?? 90_000);

/** Hides what does not belong to the extension. */
const SETTINGS = {
  "workbench.startupEditor": "none",
  "workbench.colorTheme": "Default Dark Modern",
  "workbench.tips.enabled": false,
  "workbench.secondarySideBar.defaultVisibility": "hidden",
  "workbench.layoutControl.enabled": false,
  "workbench.reduceMotion": "on",
  "remote.autoForwardPorts": false,
  "chat.disableAIFeatures": true,
  "window.commandCenter": false,
  "editor.minimap.enabled": false,
  "editor.accessibilitySupport": "off",
  "files.autoSave": "off",
  "telemetry.telemetryLevel": "off",
  "update.mode": "none",
  "extensions.autoUpdate": false,
  "extensions.autoCheckUpdates": false,
};

/** An editor with a workspace. */
export class Stage {
  /** @param {{files: Record<string, string>, settings?: object, trusted?: boolean, env?: object, open?: string, virtual?: string, testsPath?: string, prepare?: (page) => Promise<void>, size?: {width: number, height: number}}} options */
  static async open(options) {
    const stage = new Stage();
    try {
      await stage.#start(options);
      return stage;
    } catch (error) {
      await stage.close();
      throw error;
    }
  }

  /** Opens an editor for a test and closes it afterwards; keeps a screenshot of a failed test in `target`. */
  static async with(options, test) {
    const stage = await Stage.open(options);
    try {
      await test(stage);
    } catch (error) {
      await stage.keepPicture();
      throw error;
    } finally {
      await stage.close();
    }
  }

  /** As `with`, after the tests in `api` have run in the extension host; the test gets their results. */
  static async withApi(options, test) {
    const out = path.join(os.tmpdir(), `pyr-api-${process.pid}.json`);
    const testsPath = path.join(TEST_EXTENSION, "all.cjs");
    const prepare = async (page) => {
      await page.exposeFunction("codeAutomationExit", () => undefined);
      await page.exposeFunction("codeAutomationLog", () => undefined);
    };
    rmSync(out, { force: true });
    await Stage.with({ env: { API_RESULTS: out }, prepare, testsPath, ...options }, async (stage) => {
      const written = () => existsSync(out) && readFileSync(out, "utf8");
      await test(stage, JSON.parse(await until("the tests have ended", written, 240_000)));
    });
    rmSync(out, { force: true });
  }

  /** Saves a screenshot, to find out why a test failed. */
  async keepPicture() {
    const file = path.join(repository, "target", "editors", `vscode-failed-${Date.now()}.png`);
    await this.page.screenshot({ path: file });
    console.log(`screenshot: ${file}\n${await this.#inWords()}`);
  }

  /** What a screenshot shows, for those who only have the output: dialogues, messages, lists, and where the focus is. */
  async #inWords() {
    const texts = async (selector) => (await this.page.locator(selector).allInnerTexts()).map(spaced).join(" | ");
    const focus = await this.page.evaluate(() => {
      const { tagName, className } = document.activeElement ?? document.body;
      return `${tagName.toLowerCase()}.${String(className)}`;
    });
    const [dialogues, messages, lists, tabs] = [".monaco-dialog-box", ".notification-toast", ".quick-input-widget .monaco-list-row", ".tab.active"];
    return [
      `dialogues: ${await texts(dialogues)}`,
      `messages: ${await texts(messages)}`,
      `lists: ${await texts(lists)}`,
      `active: ${await texts(tabs)}`,
      `focus: ${focus}`,
    ].join("\n");
  }

  async #start({ files, settings = {}, trusted = true, env = {}, open, virtual, testsPath, prepare, size }) {
    this.scratch = mkdtempSync(path.join(os.tmpdir(), "pyr-"));
    this.folder = path.join(this.scratch, "ws");
    mkdirSync(path.join(this.scratch, "data/User"), { recursive: true });
    for (const [name, text] of Object.entries(files)) {
      mkdirSync(path.dirname(path.join(this.folder, name)), { recursive: true });
      writeFileSync(path.join(this.folder, name), text, { mode: text.startsWith("#!") ? 0o755 : 0o644 });
    }
    writeFileSync(path.join(this.scratch, "data/User/settings.json"), JSON.stringify({ ...SETTINGS, ...settings }));
    // Server paths have machine scope: user settings do not apply in a remote window.
    const machine = Object.fromEntries(Object.entries(settings).filter(([name]) => name.startsWith("pydslrep.server.")));
    mkdirSync(path.join(this.scratch, "data/Machine"), { recursive: true });
    writeFileSync(path.join(this.scratch, "data/Machine/settings.json"), JSON.stringify(machine));
    this.set({});
    writeFileSync(path.join(this.scratch, "config.yaml"), "auth: none\n");
    this.env = {
      ...process.env,
      XDG_CONFIG_HOME: this.scratch,
      XDG_DATA_HOME: this.scratch,
      TMPDIR: this.scratch,
      WANTED_SETTINGS: path.join(this.scratch, "wanted.json"),
      ...env,
    };
    const base = ["--config", "config.yaml", "--user-data-dir", "data", "--extensions-dir", "extensions"];
    const inScratch = { env: this.env, cwd: this.scratch };
    if (virtual) {
      this.#addWebExtensions(virtual);
    } else {
      this.#addExtensions();
    }
    const port = await freePort();
    this.address = `127.0.0.1:${port}`;
    const trust = trusted ? ["--disable-workspace-trust"] : [];
    const quiet = ["--disable-telemetry", "--disable-update-check", "--disable-getting-started-override"];
    this.server = spawn(
      process.execPath,
      [entry, ...base, "--auth", "none", "--bind-addr", this.address, ...quiet, ...trust, this.folder],
      { ...inScratch, detached: true, stdio: "ignore" },
    );
    this.ended = new Promise((resolve) => this.server.once("exit", resolve));
    await until("code-server answers", async () => (await fetch(`http://${this.address}/healthz`).catch(() => undefined))?.ok);
    this.browser = await chromium.launch({
      executablePath: CHROMIUM,
      args: ["--no-sandbox", "--disable-gpu", "--disable-quic", "--no-first-run", "--disable-background-networking"],
    });
    this.page = await this.browser.newPage({ viewport: size ?? { width: 1100, height: 680 } });
    this.page.setDefaultTimeout(TIMEOUT);
    const payload = open ? [["openFile", this.inEditor(open)]] : [];
    if (testsPath) {
      await this.page.addInitScript(allowTests);
      payload.push(["extensionDevelopmentPath", this.inEditor(TEST_EXTENSION)], ["extensionTestsPath", this.inEditor(testsPath)]);
    }
    await prepare?.(this.page);
    const place = virtual ? { workspace: path.join(this.folder, "virtual.code-workspace") } : { folder: this.folder };
    const search = new URLSearchParams({ ...place, payload: JSON.stringify(payload) });
    await this.page.goto(`http://${this.address}/?${search}`);
    await this.page.locator(".monaco-workbench").waitFor();
    if (open) {
      await this.line("").first().waitFor();
      // The extension is loaded once the language is shown.
      await this.page.locator(".statusbar-item", { hasText: "PyDSLRep" }).first().waitFor();
      await this.page.keyboard.press("Control+B");
      await this.page.locator(".part.sidebar").waitFor({ state: "hidden" });
    }
  }

  /** Copies the installed extension, and adds that of the tests. Without the list of what is installed, all folders are. */
  #addExtensions() {
    const extensions = path.join(this.scratch, "extensions");
    cpSync(EXTENSIONS, extensions, { recursive: true });
    rmSync(path.join(extensions, "extensions.json"));
    cpSync(TEST_EXTENSION, path.join(extensions, "api-tests"), { recursive: true });
  }

  /**
   * Installs the package for the web, and a workspace in memory. An editor with a server would run the extension there, so
   * that its entry for computers is removed.
   */
  #addWebExtensions(virtual) {
    const extensions = path.join(this.scratch, "extensions");
    const unpacked = path.join(this.scratch, "web");
    execFileSync("python3", ["-m", "zipfile", "-e", VSIX_WEB, unpacked]);
    const { main: _, ...manifest } = JSON.parse(readFileSync(path.join(unpacked, "extension/package.json"), "utf8"));
    writeFileSync(path.join(unpacked, "extension/package.json"), JSON.stringify(manifest));
    cpSync(path.join(unpacked, "extension"), path.join(extensions, "pydslrep"), { recursive: true });
    cpSync(VIRTUAL_FILES, path.join(extensions, "virtual-files"), { recursive: true });
    mkdirSync(this.folder, { recursive: true });
    writeFileSync(path.join(this.folder, "virtual.code-workspace"), JSON.stringify({ folders: [{ uri: virtual }] }));
  }

  /** Changes user settings through the test extension. */
  set(settings) {
    const file = path.join(this.scratch, "wanted.json");
    // Atomically, so that no partial file is read.
    writeFileSync(`${file}.new`, JSON.stringify(settings));
    renameSync(`${file}.new`, file);
  }

  /** Opens a file of the workspace with Quick Open, and waits until keys arrive in it. */
  async openFile(name) {
    await this.page.keyboard.press("Control+P");
    const input = this.page.locator(".quick-input-widget input").first();
    await input.fill(name);
    await this.page.locator(".quick-input-widget .monaco-list-row.focused", { hasText: path.basename(name) }).waitFor();
    await this.page.keyboard.press("Enter");
    await this.page.locator(`.tab.active[data-resource-name="${path.basename(name)}"]`).waitFor();
    await this.page.locator(".editor-instance .monaco-editor.focused").waitFor();
  }

  /** The URI of a file in the browser. It needs the authority, or else decorations are not drawn. */
  inEditor(file) {
    return file.includes(":/") ? file : `vscode-remote://${this.address}${path.resolve(this.folder, file)}`;
  }

  /** The visible lines that contain a text. */
  line(text) {
    return this.page.locator(".editor-instance .view-line", { hasText: text });
  }

  /** The tab of a file. */
  tab(name) {
    return this.page.locator(`.tab[data-resource-name="${name}"]`);
  }

  /** Puts the cursor at the beginning of the file. An editor whose tab was clicked gets the keys only some time later. */
  async toBeginning() {
    await until("the cursor is at the beginning", async () => {
      await this.page.keyboard.press("Control+Home");
      return /Ln 1, Col 1\b/.test(await this.page.locator(".statusbar").innerText());
    });
  }

  /** Puts the cursor in a line. */
  async clickLine(line) {
    await this.#clickUntil(`the cursor is in "${line}"`, line, "", ({ row, cursor }) => isWithin(cursor.y, row.top, row.bottom));
  }

  /** Puts the cursor in a word of a line. */
  async clickWord(line, word) {
    await this.#clickUntil(`the cursor is in "${word}" of "${line}"`, line, word, ({ row, word: place, cursor }) =>
      isWithin(cursor.y, row.top, row.bottom) && isWithin(cursor.x, place.left, place.right));
  }

  /** Puts the mouse over a word of a line. */
  async hoverWord(line, word) {
    await this.line(line).first().hover({ position: middleOf(await this.#placesIn(line, word)) });
  }

  /** Clicks a line until the cursor is where it should be: a code lens that appears moves the line from under the mouse. */
  async #clickUntil(what, line, word, check) {
    await until(what, async () => {
      const position = word && middleOf(await this.#placesIn(line, word));
      await this.line(line).first().click(position ? { position } : {});
      return check(await this.#placesIn(line, word));
    });
  }

  #placesIn(line, word) {
    return until(`"${line}" is drawn`, () => this.line(line).first().evaluate(placesIn, word));
  }

  /** The visible text of the editor, with single spaces. */
  async text() {
    return spaced(await this.page.locator(".editor-instance .view-lines").first().innerText());
  }

  /** The text of a file of the workspace. */
  read(file) {
    return readFileSync(path.join(this.folder, file), "utf8");
  }

  /** Runs a command of the palette by its title. A palette that opens too early does not list the extension's commands. */
  async call(title) {
    const input = this.page.locator(".quick-input-widget input").first();
    const row = this.page.locator(".quick-input-widget .monaco-list-row", { hasText: title.split(": ").at(-1) }).first();
    await until(`the palette lists ${title}`, async () => {
      await this.page.keyboard.press("F1");
      // Whatever takes the focus closes the palette again.
      const limit = { timeout: 10_000 };
      const look = async () => {
        await input.waitFor(limit);
        await input.fill(`>${title}`, limit);
        await row.waitFor(limit);
      };
      const isListed = await look().then(() => true, () => false);
      if (!isListed) {
        await this.page.keyboard.press("Escape");
      }
      return isListed;
    });
    await this.page.keyboard.press("Enter");
  }

  /** Waits until a key means a command: an editor that has just started may show what extensions offer before it knows their keys. */
  async keyOf(title, key) {
    const input = this.page.locator(".quick-input-widget input").first();
    const row = this.page.locator(".quick-input-widget .monaco-list-row", { hasText: title.split(": ").at(-1) });
    const bound = row.locator(".monaco-keybinding", { hasText: key }).first();
    await until(`${key} is the key of ${title}`, async () => {
      await this.page.keyboard.press("F1");
      // The keys are those of the moment when the list opened.
      const look = async () => {
        await input.fill(`>${title}`, { timeout: 10_000 });
        await bound.waitFor({ timeout: 3000 });
      };
      const isBound = await look().then(() => true, () => false);
      await this.page.keyboard.press("Escape");
      return isBound;
    });
    await input.waitFor({ state: "hidden" });
  }

  /** Accepts the path that the open file dialog proposes, or another one. */
  async acceptFile(proposed, chosen = proposed) {
    const input = this.page.locator(".quick-input-widget input").first();
    const holds = (file) => async () => (await input.inputValue({ timeout: 1000 }).catch(() => "")).endsWith(file);
    // The dialog writes its proposal once it has read the folder, over whatever was typed before.
    await until(`the file dialog proposes ${proposed}`, holds(proposed));
    if (chosen !== proposed) {
      await input.fill(chosen);
      await until(`the file dialog has ${chosen}`, holds(chosen));
    }
    // Enter does nothing while the dialog reads the folder of a changed path.
    await until("the file dialog is closed", async () => {
      await this.page.keyboard.press("Enter");
      return input.waitFor({ state: "hidden", timeout: 3000 }).then(() => true, () => false);
    });
  }

  /** Presses keys until a widget is open: a busy editor may close it at once. */
  async openWidget(keys, widget) {
    await until(`${keys} opens its widget`, async () => {
      await this.page.keyboard.press(keys);
      const isOpen = await widget.waitFor({ timeout: 5000 }).then(() => true, () => false);
      if (!isOpen) {
        await this.page.keyboard.press("Escape");
      }
      return isOpen;
    });
  }

  /** Clicks a lens until what it does has begun: one that is drawn again at that moment does not get the click. */
  async clickLens(title, begun) {
    const lens = this.page.locator(".codelens-decoration a").getByText(title, { exact: true }).first();
    await until(`the lens ${title} is clicked`, async () => {
      await lens.click();
      return begun.waitFor({ timeout: 10_000 }).then(() => true, () => false);
    });
  }

  /** Types at the cursor, key by key. */
  async type(text) {
    await this.page.keyboard.type(text, { delay: 15 });
  }

  /** The visible notifications. */
  get toasts() {
    return this.page.locator(".notification-toast");
  }

  /** Waits for a notification, which must be the only one but those `beside` it, and presses its button or closes it. */
  async toast(text, button, { beside } = {}) {
    const message = this.toasts.filter({ hasText: text });
    await message.first().waitFor();
    // A command that has ended may still show its progress; what is above moves when that is gone.
    const inProgress = this.page.locator(".monaco-progress-container.active");
    await this.toasts.filter({ has: inProgress }).first().waitFor({ state: "detached" });
    // A notification stays while the pointer is over it.
    await message.first().hover();
    const all = await this.toasts.filter({ hasNotText: beside }).allInnerTexts();
    if (all.length !== 1) {
      throw new Error(`expected one notification, found ${all.length}: ${spaced(all.join(" | "))}`);
    }
    if (button === undefined) {
      await message.locator(".codicon-notifications-clear, .codicon-notifications-hide").first().click();
    } else {
      await message.getByRole("button", { name: button }).click();
    }
    await message.waitFor({ state: "detached" });
  }

  /** Opens the walkthrough and returns the titles of the steps that are ticked off. */
  async walkthrough() {
    await this.call("Welcome: Open Walkthrough...");
    await this.page.locator(".quick-input-widget input").first().fill("PyDSLRep");
    await this.page.locator(".quick-input-widget .monaco-list-row.focused", { hasText: "PyDSLRep" }).waitFor();
    await this.page.keyboard.press("Enter");
    const steps = this.page.locator(".getting-started-step");
    await steps.first().waitFor();
    const done = steps.filter({ has: this.page.locator(".codicon-getting-started-step-checked") });
    return (await done.locator(".step-title").allInnerTexts()).map((title) => spaced(title).trim());
  }

  /** The webview with an element that matches the selector. */
  async webview(selector) {
    return until(`a webview with ${selector}`, async () => {
      for (const frame of this.page.frames()) {
        if (await frame.locator(selector).count().catch(() => 0)) {
          return frame;
        }
      }
      return undefined;
    });
  }

  /** A screenshot for the documentation, with `--pictures`. */
  async picture(name, options = {}) {
    if (PICTURES) {
      mkdirSync(PICTURES, { recursive: true });
      await this.page.screenshot({ path: path.join(PICTURES, `vscode-${name}.png`), ...options });
    }
  }

  /** The process ids of the bundled server. */
  servers() {
    const list = execFileSync("ps", ["-eo", "pid=,args="], { encoding: "utf8" }).split("\n");
    const servers = list.filter((line) => line.includes(this.scratch) && / (lsp )?--stdio\b/.test(line));
    return servers.map((line) => Number.parseInt(line, 10));
  }

  /** Ends everything and removes its files. */
  async close() {
    await this.browser?.close().catch(() => undefined);
    if (this.server) {
      process.kill(-this.server.pid, "SIGTERM");
      await Promise.race([this.ended, new Promise((resolve) => setTimeout(resolve, 5000).unref())]);
      await until("the language server is gone", () => this.servers().length === 0);
    }
    if (this.scratch && !process.env.KEEP) {
      rmSync(this.scratch, { recursive: true, force: true, maxRetries: 10, retryDelay: 200 });
    }
  }
}

/**
 * A release build runs tests in its extension host only if its page enables the smoke test driver. Notifications then stay in
 * the bell, so tests that look at the screen do not use this.
 */
function allowTests() {
  new MutationObserver((_, observer) => {
    const element = document.getElementById("vscode-workbench-web-configuration");
    if (element) {
      observer.disconnect();
      const options = JSON.parse(element.dataset.settings);
      options.developmentOptions = { ...options.developmentOptions, enableSmokeTestDriver: true };
      element.dataset.settings = JSON.stringify(options);
    }
  }).observe(document, { childList: true, subtree: true });
}

/** A program of the repository. */
export function program(name) {
  return readFileSync(path.join(repository, name), "utf8");
}

/** Collapses white space; the editor inserts non-breaking spaces for its layout. */
export function spaced(text) {
  return text.replace(/[\u00a0\s]+/g, " ");
}

/**
 * Where a row of the editor, a word of it and the middle of the cursor are in the window, once all is drawn. Runs in the page. A
 * row that has no colours yet is one element, however many words it has. Null if the editor has replaced the row meanwhile.
 */
async function placesIn(row, word) {
  const frame = () => new Promise((resolve) => requestAnimationFrame(resolve));
  await frame();
  await frame();
  if (!row.isConnected) {
    return null;
  }
  const boxOf = (part) => {
    const { left, right, top, bottom } = part.getBoundingClientRect();
    return { left, right, top, bottom };
  };
  const texts = document.createTreeWalker(row, NodeFilter.SHOW_TEXT);
  const range = document.createRange();
  let at = -1;
  while (at < 0 && texts.nextNode()) {
    at = texts.currentNode.data.indexOf(word);
    if (at >= 0) {
      range.setStart(texts.currentNode, at);
      range.setEnd(texts.currentNode, at + word.length);
    }
  }
  if (at < 0 && word) {
    throw new Error(`"${row.textContent}" has no "${word}" of one colour`);
  }
  const cursor = row.closest(".monaco-editor").querySelector(".cursor");
  const { left, right, top, bottom } = cursor ? boxOf(cursor) : {};
  return { row: boxOf(row), word: boxOf(range), cursor: { x: (left + right) / 2, y: (top + bottom) / 2 } };
}

/** The middle of a word in its row. */
function middleOf({ row, word }) {
  return { x: (word.left + word.right) / 2 - row.left, y: (word.top + word.bottom) / 2 - row.top };
}

function isWithin(value, least, most) {
  return least <= value && value <= most;
}

/** Waits until a check is truthy and returns its value; `what` describes it in the error. */
export async function until(what, check, timeout = TIMEOUT) {
  const end = Date.now() + timeout;
  for (;;) {
    const value = await check();
    if (value) {
      return value;
    }
    if (Date.now() > end) {
      throw new Error(`timed out after ${timeout / 1000} s waiting until ${what}`);
    }
    await new Promise((resolve) => setTimeout(resolve, 50));
  }
}

async function freePort() {
  const server = net.createServer();
  await new Promise((resolve) => server.listen(0, "127.0.0.1", resolve));
  const { port } = server.address();
  await new Promise((resolve) => server.close(resolve));
  return port;
}
