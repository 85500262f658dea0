// A real editor to test in: code-server with a fresh profile and the extension in it, open in a headless Chromium.
import { execFileSync, spawn } from "node:child_process";
import { cpSync, mkdirSync, mkdtempSync, readFileSync, renameSync, rmSync, writeFileSync } from "node:fs";
import net from "node:net";
import os from "node:os";
import path from "node:path";

import { chromium } from "playwright-core";

const { VSIX, CHROMIUM, CODE_SERVER, PICTURES } = process.env;
for (const [name, value] of Object.entries({ VSIX, CHROMIUM, CODE_SERVER })) {
  if (!value) {
    throw new Error(`${name} is not set: start the tests by tests/editors/run.sh vscode`);
  }
}
const entry = path.join(CODE_SERVER, "node_modules/code-server/out/node/entry.js");

export const repository = path.resolve(import.meta.dirname, "../../..");

/** The extension that changes settings for the tests. */
const HELPER = path.join(import.meta.dirname, "api");

/** How long anything may take that is waited for, milliseconds. */
const PATIENCE = Number(process.env.PATIENCE ?? 90_000);

/** Nothing on the screen that is not the extension's. */
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

/** An editor with a workspace of these files: names in it, and texts or files of the repository. */
export class Stage {
  /** @param {{files: Record<string, string>, settings?: object, trusted?: boolean, env?: object, open?: string, testsPath?: string, prepare?: (page) => Promise<void>, size?: {width: number, height: number}}} options */
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

  /** Opens an editor for a test and closes it afterwards; of a test that fails a picture is kept in `target`. */
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

  /** What is on the screen, for whoever wants to know why a test failed. */
  async keepPicture() {
    const file = path.join(repository, "target", "editors", `vscode-failed-${Date.now()}.png`);
    await this.page.screenshot({ path: file });
    console.log(`what was on the screen: ${file}`);
  }

  async #start({ files, settings = {}, trusted = true, env = {}, open, testsPath, prepare, size }) {
    this.scratch = mkdtempSync(path.join(os.tmpdir(), "pyr-"));
    this.folder = path.join(this.scratch, "ws");
    mkdirSync(path.join(this.scratch, "data/User"), { recursive: true });
    for (const [name, text] of Object.entries(files)) {
      mkdirSync(path.dirname(path.join(this.folder, name)), { recursive: true });
      writeFileSync(path.join(this.folder, name), text, { mode: text.startsWith("#!") ? 0o755 : 0o644 });
    }
    writeFileSync(path.join(this.scratch, "data/User/settings.json"), JSON.stringify({ ...SETTINGS, ...settings }));
    // Paths of programs are settings of the machine: those of the person reach it only from an editor on the same one.
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
    // What is in the folder when the first extension is installed is taken for installed, too.
    cpSync(HELPER, path.join(this.scratch, "extensions/api-tests"), { recursive: true });
    execFileSync(process.execPath, [entry, ...base, "--install-extension", VSIX], { ...inScratch, stdio: "ignore" });
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
    this.page.setDefaultTimeout(PATIENCE);
    const payload = open ? [["openFile", this.inEditor(open)]] : [];
    if (testsPath) {
      await this.page.addInitScript(allowTests);
      payload.push(["extensionDevelopmentPath", this.inEditor(HELPER)], ["extensionTestsPath", this.inEditor(testsPath)]);
    }
    await prepare?.(this.page);
    const search = new URLSearchParams({ folder: this.folder, payload: JSON.stringify(payload) });
    await this.page.goto(`http://${this.address}/?${search}`);
    await this.page.locator(".monaco-workbench").waitFor();
    if (open) {
      await this.line("").first().waitFor();
      // Before that, the editor does not know the extension.
      await this.page.locator(".statusbar-item", { hasText: "PyDSLRep" }).first().waitFor();
      await this.page.keyboard.press("Control+B");
      await this.page.locator(".part.sidebar").waitFor({ state: "hidden" });
    }
  }

  /** Changes settings of the person, by the extension that is there for it. */
  set(settings) {
    const file = path.join(this.scratch, "wanted.json");
    // At once, or half of it may be read.
    writeFileSync(`${file}.new`, JSON.stringify(settings));
    renameSync(`${file}.new`, file);
  }

  /** Opens a file of the workspace, as a person does by its name. */
  async openFile(name) {
    await this.page.keyboard.press("Control+P");
    const input = this.page.locator(".quick-input-widget input").first();
    await input.fill(name);
    await this.page.locator(".quick-input-widget .monaco-list-row.focused", { hasText: path.basename(name) }).waitFor();
    await this.page.keyboard.press("Enter");
    await this.page.locator(`.tab.active[data-resource-name="${path.basename(name)}"]`).waitFor();
  }

  /** The address of a file as the editor in the browser has it; with the authority, or marks are not drawn. */
  inEditor(file) {
    return `vscode-remote://${this.address}${path.resolve(this.folder, file)}`;
  }

  /** Lines of the editor that contain this text. */
  line(text) {
    return this.page.locator(".editor-instance .view-line", { hasText: text });
  }

  /** The tab of a file. */
  tab(name) {
    return this.page.locator(`.tab[data-resource-name="${name}"]`);
  }

  /** Puts the cursor into a word of a line. */
  async clickWord(line, word) {
    await this.line(line).first().locator("span span", { hasText: word }).first().click();
  }

  /** The editor's text as one sees it, with single spaces. */
  async text() {
    return spaced(await this.page.locator(".editor-instance .view-lines").first().innerText());
  }

  /** A file of the workspace. */
  read(file) {
    return readFileSync(path.join(this.folder, file), "utf8");
  }

  /** Calls a command by its title in the palette. */
  async call(title) {
    await this.page.keyboard.press("F1");
    const input = this.page.locator(".quick-input-widget input").first();
    await input.waitFor();
    await input.fill(`>${title}`);
    await this.page.locator(".quick-input-widget .monaco-list-row", { hasText: title.split(": ").at(-1) }).first().waitFor();
    await this.page.keyboard.press("Enter");
  }

  /** Presses keys until what they open is there: a busy editor may close it again at once, as it would to a person. */
  async summon(keys, widget) {
    await until(`${keys} opens something`, async () => {
      await this.page.keyboard.press(keys);
      const isThere = await widget.waitFor({ timeout: 5000 }).then(() => true, () => false);
      if (!isThere) {
        await this.page.keyboard.press("Escape");
      }
      return isThere;
    });
  }

  /** Types at the cursor, as a person does: key by key. */
  async type(text) {
    await this.page.keyboard.type(text, { delay: 15 });
  }

  /** The messages on the screen. */
  get toasts() {
    return this.page.locator(".notification-toast");
  }

  /** Waits for a message, which has to be the only one, and presses its button or takes it away. */
  async toast(text, button) {
    const message = this.toasts.filter({ hasText: text });
    await message.first().waitFor();
    // A message that is pointed at stays.
    await message.first().hover();
    const all = await this.toasts.allInnerTexts();
    if (all.length !== 1) {
      throw new Error(`one message was expected, not ${all.length}: ${spaced(all.join(" | "))}`);
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

  /** The frame of a webview that has an element like this. */
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

  /** A picture for the documentation, if pictures are wanted. */
  async picture(name, options = {}) {
    if (PICTURES) {
      mkdirSync(PICTURES, { recursive: true });
      await this.page.screenshot({ path: path.join(PICTURES, `vscode-${name}.png`), ...options });
    }
  }

  /** The processes of the extension's own server, by their numbers. */
  servers() {
    const list = execFileSync("ps", ["-eo", "pid=,args="], { encoding: "utf8" }).split("\n");
    const ours = list.filter((line) => line.includes(this.scratch) && / (lsp )?--stdio\b/.test(line));
    return ours.map((line) => Number.parseInt(line, 10));
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
 * A built editor runs tests in its extension host only where its page says that it is there to be tested. It then keeps
 * messages in the bell, where a person would see them: so tests of what is on the screen do without.
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

/** A whole folder of the repository, as files for a stage. */
export function copyInto(stage, from, to) {
  cpSync(path.join(repository, from), path.join(stage.folder, to), { recursive: true });
}

/** Text from the editor: it has spaces that do not break, and as many as the layout wants. */
export function spaced(text) {
  return text.replace(/[\u00a0\s]+/g, " ");
}

/** Waits until something is so, and returns it; what was waited for is said where it never is. */
export async function until(what, check, patience = PATIENCE) {
  const end = Date.now() + patience;
  for (;;) {
    const value = await check();
    if (value) {
      return value;
    }
    if (Date.now() > end) {
      throw new Error(`waited ${patience / 1000} s in vain until ${what}`);
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
