// The first hour of a new user: default settings, an empty file, and the mistakes of beginners.
import assert from "node:assert/strict";
import { existsSync, mkdtempSync, readdirSync, readFileSync, rmSync } from "node:fs";
import os from "node:os";
import path from "node:path";
import { after, afterEach, before, test } from "node:test";

import { Stage, program, spaced, until } from "./stage.mjs";

const SQUARE = program("examples/square.pyr");
// Its last movement is so long that the end of the file is out of sight.
const LONG = SQUARE.replace("right_square of scout {\n", `$&${"  turn left\n".repeat(20)}`);
const NO_ENVIRONMENT = LONG.slice(0, LONG.search(/^environment /mu));

const cache = mkdtempSync(path.join(os.tmpdir(), "pyr-cache-"));

let stage;
before(async () => {
  stage = await Stage.open({
    files: {
      "empty.pyr": "",
      "wide.pyr": "movement m of r {\n    move 1 meters\n}\n",
      "none.pyr": NO_ENVIRONMENT,
      "two.pyr": `${SQUARE}\nenvironment hall has { scout } robots with { left_square } moves\n`,
      "unopened.pyr": "wheel w with radius -1\n",
    },
    open: "empty.pyr",
    // Empty, as before the first run.
    env: { XDG_CACHE_HOME: cache },
  });
});
afterEach((t) => t.passed || stage?.keepPicture());
after(async () => {
  await stage?.close();
  rmSync(cache, { recursive: true, force: true });
});

/** The text of the status bar. */
const statusBar = async () => spaced(await stage.page.locator(".statusbar").innerText());

test("an empty file that was opened before the extension loaded is indented by two", async () => {
  await until("the status bar shows the indentation", async () => /Spaces: 2/.test(await statusBar()));
});

test("an empty file says what to do until the first character", async () => {
  await until("the hint is shown", async () => (await ghost()).includes("press Ctrl+Space"));
  await stage.clickLine("");
  await stage.type("r");
  await until("the hint is hidden", async () => (await ghost()) === "");
  await stage.page.keyboard.press("Backspace");
  await until("the hint is shown again", async () => (await ghost()).includes("Type a program"));
});

/** The decorations shown in the editor's lines. */
function ghost() {
  return stage.page.evaluate(() => {
    const shown = [...document.querySelectorAll(".view-line span")].map((span) => getComputedStyle(span, "::after").content);
    return shown.filter((text) => text !== "none" && text !== "normal").join("").replaceAll("\u00a0", " ");
  });
}

test("a file is indented by two, whatever it contains", async () => {
  await stage.openFile("wide.pyr");
  await until("the status bar shows the indentation", async () => /Spaces: 2/.test(await statusBar()));
  await stage.openFile("empty.pyr");
});

test("enter after a brace indents", async () => {
  await stage.clickLine("");
  await stage.type("robot r has { a } wheels");
  await stage.page.keyboard.press("Enter");
  await stage.type("movement m of r ");
  await openBlock();
  await stage.page.keyboard.press("Escape");
  await stage.page.keyboard.press("Enter");
  await stage.type("turn left");
  await stage.page.keyboard.press("Control+S");
  await until("it is saved", () => stage.read("empty.pyr") !== "");
  assert.equal(stage.read("empty.pyr"), "robot r has { a } wheels\nmovement m of r {\n  turn left\n}");
});

/** Types a brace until the editor closes it: VS Code closes none in a line that it has not coloured yet. */
function openBlock() {
  return until("the brace is closed", async () => {
    await stage.type("{");
    await stage.line("{").nth(1).waitFor();
    const isClosed = (await stage.line("movement m").innerText()).includes("{}");
    if (!isClosed) {
      await stage.page.keyboard.press("Backspace");
    }
    return isClosed;
  });
}

test("the packaged server is stripped", () => {
  const [name] = readdirSync(path.join(stage.scratch, "extensions")).filter((folder) => folder.startsWith("pydslrep."));
  const server = readFileSync(path.join(stage.scratch, "extensions", name, "server/pydslrep"));
  for (const section of [".symtab", ".debug_line", ".debug_info"]) {
    assert.ok(!server.includes(`${section}\0`), `it has no ${section}`);
  }
});

test("without an environment, F5 says so once and adds one", async () => {
  await stage.openFile("none.pyr");
  await stage.page.locator(".squiggly-info").first().waitFor();
  // The key works wherever the focus is.
  await stage.page.keyboard.press("Control+Shift+E");
  await stage.page.locator(".explorer-folders-view .monaco-list:focus-within").waitFor();
  await stage.page.keyboard.press("F5");
  await stage.toast("has no environment yet", "Add Environment");
  await stage.page.keyboard.press("Control+B");
  // Its name is selected, and the editor stays where it is: further up.
  await stage.page.locator(".breadcrumbs-control", { hasText: "area" }).waitFor();
  assert.equal(await linesWith("environment"), "");
  await stage.page.keyboard.press("Control+Z");
});

/** The visible lines that contain a word. */
async function linesWith(word) {
  const lines = await stage.line(word).allInnerTexts();
  return lines.map(spaced).join("\n");
}

test("F5 runs the environment at the cursor", async () => {
  await stage.openFile("two.pyr");
  await stage.page.keyboard.press("Control+End");
  await stage.page.locator(".codelens-decoration", { hasText: "Run" }).first().waitFor();
  await stage.page.keyboard.press("ArrowUp");
  await stage.page.keyboard.press("F5");
  const progress = stage.page.locator(".notification-toast", { hasText: "Running hall" });
  // The first run installs the client library.
  await progress.filter({ hasText: "preparing Python" }).waitFor();
  const frame = await stage.webview("main.preview");
  await frame.locator('[data-part="result"]', { hasText: /hall: .* simulated in/ }).waitFor();
  assert.equal(await progress.count(), 0);
  assert.equal(await stage.toasts.count(), 0);
  await frame.locator('main.preview[data-driven="hall"]').waitFor();
});

test("if several environments use what is at the cursor, a list asks which", async () => {
  await stage.tab("two.pyr").click();
  await stage.toBeginning();
  await stage.page.keyboard.press("Control+F5");
  const rows = stage.page.locator(".quick-input-widget .monaco-list-row");
  await until("both are offered", async () => (await rows.allInnerTexts()).map((text) => text.trim()).join() === "yard,hall");
  await stage.page.keyboard.press("Escape");
});

test("for a program without an environment, the preview does not show another program's path", async () => {
  const frame = await stage.webview("main.preview");
  await frame.locator('main.preview[data-state="ready"]').waitFor();
  await stage.openFile("none.pyr");
  await frame.getByText("The program has no environment yet").waitFor();
  assert.equal(await frame.locator("main.preview").getAttribute("data-state"), "empty");
  assert.equal(await frame.locator("aside.legend").isVisible(), false);
  await frame.locator('[data-part="suggestion"]').click();
  await frame.locator('main.preview[data-state="ready"][data-environment="area"]').waitFor();
  await until("the new name is selected", async () => /\(4 selected\)/.test(await stage.page.locator(".statusbar").innerText()));
});

test("the preview fits next to the program in a window of 700 pixels", async () => {
  await stage.page.setViewportSize({ width: 700, height: 560 });
  const frame = await stage.webview("main.preview");
  await until("everything is visible", () =>
    frame.evaluate(() => {
      const parts = [...document.querySelectorAll("button, select, input, output, canvas")].filter((part) => part.checkVisibility());
      return innerWidth < 400 && parts.every((part) => part.getBoundingClientRect().right <= innerWidth + 0.5);
    }),
  );
  await stage.picture("preview-narrow");
  await stage.page.setViewportSize({ width: 1100, height: 680 });
});

test("the check task does not duplicate problems", async () => {
  const problems = async () => spaced((await stage.page.locator("#status\\.problems").getAttribute("aria-label")) ?? "");
  await until("the problem of the unopened file is counted", async () => /[1-9]/.test(await problems()));
  await stage.page.keyboard.press("Control+Shift+M");
  await stage.page.locator(".viewpane-filter input, .markers-panel-action-filter input").first().fill("above zero");
  const rows = stage.page.locator(".markers-panel .monaco-list-row", { hasText: "must be above zero" });
  await until("it is listed", async () => (await rows.count()) === 1);
  await stage.call("Tasks: Run Build Task");
  await stage.page.locator(".quick-input-widget .monaco-list-row", { hasText: "check" }).first().click();
  // The task fails because of errors.
  await stage.page.locator(".single-terminal-tab .codicon-error").waitFor();
  await stage.page.keyboard.press("Control+Shift+M");
  await rows.first().waitFor();
  assert.equal(await rows.count(), 1);
  await stage.page.keyboard.press("Control+J");
});

test("statistics and versions are shown", async () => {
  await stage.openFile("two.pyr");
  await stage.call("PyDSLRep: Statistics");
  await stage.toast(/2 environments: \d+ lines of program generate \d+ lines of Python \(\d\d % fewer\)/);
  await stage.call("PyDSLRep: Show Version");
  await stage.toast(/PyDSLRep \d+\.\d+\.\d+, server \d+\.\d+\.\d+/);
});

test("a new file is a program; generating its script asks to save it", async () => {
  await stage.call("Create: New File...");
  await stage.page.locator(".quick-input-widget .monaco-list-row", { hasText: "PyDSLRep Program" }).click();
  await stage.tab("Untitled-1").waitFor();
  await until("it is indented by two", async () => /Spaces: 2 .*PyDSLRep|PyDSLRep.* Spaces: 2/.test(await statusBar()));
  await stage.page.keyboard.insertText(SQUARE);
  await stage.page.locator(".codelens-decoration", { hasText: "Generate script" }).first().waitFor({ state: "attached" });
  await stage.page.keyboard.press("Control+End");
  await stage.call("PyDSLRep: Generate Script");
  await stage.toast("Save the file first; the script is written next to it.", "Save As…");
  await stage.acceptFile(".pyr", path.join(stage.folder, "mine.pyr"));
  await until("program and script are written", () => existsSync(path.join(stage.folder, "mine.pyr")) && existsSync(path.join(stage.folder, "yard.py")));
  await stage.toast("Script written: yard.py", undefined, { beside: "Runtime of scripts" });
  await stage.tab("yard.py").waitFor();
});

test("steps done before the walkthrough is first opened are ticked off", async () => {
  assert.deepEqual(await stage.walkthrough(), ["Write a program", "Preview the path", "Run it", "Export the script"]);
});

test("a button of the walkthrough asks for the program where none is visible", async () => {
  await stage.call("View: Close All Editors");
  await stage.walkthrough();
  await stage.page.locator(".getting-started-step", { hasText: "Run it" }).first().click();
  await stage.page.locator(".getting-started-step.expanded").getByRole("button", { name: "Run in Simulator" }).click();
  const rows = stage.page.locator(".quick-input-widget .monaco-list-row");
  await rows.filter({ hasText: "none.pyr" }).first().waitFor();
  await stage.page.keyboard.press("Escape");
});
