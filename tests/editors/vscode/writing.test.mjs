// Writing a program in the editor: an error, quick fixes, completion, the script and a run.
import assert from "node:assert/strict";
import { existsSync } from "node:fs";
import path from "node:path";
import { after, afterEach, before, test } from "node:test";

import { Stage, spaced, until } from "./stage.mjs";

const PROGRAM = `wheel wheelL with radius 4.5
wheel wheelR with radius 4.5

robot rover type tw with port 23000 has { wheelL wheelR } wheels

movement patrol of rovr {
  move 2.0 meters
  turn left
  move 50 centimeters at 12.5
}

environment yard has { rover } robots with { patrol } moves
`;

let stage;
before(async () => {
  stage = await Stage.open({ files: { "yard.pyr": PROGRAM }, open: "yard.pyr" });
});
afterEach((t) => t.passed || stage?.keepPicture());
after(() => stage?.close());

test("an error is underlined, and the file has the language", async () => {
  await stage.page.locator(".squiggly-error").first().waitFor();
  const bar = spaced(await stage.page.locator(".statusbar").innerText());
  assert.match(bar, /PyDSLRep/);
});

test("no step of the walkthrough is ticked off at first", async () => {
  assert.deepEqual(await stage.walkthrough(), []);
  await stage.tab("yard.pyr").click();
  await stage.line("movement patrol").first().waitFor();
});

test("without settings the bundled server is used", () => {
  assert.equal(stage.servers().length, 1);
});

test("lenses are shown above declarations", async () => {
  await stage.page.locator(".codelens-decoration", { hasText: "Generate script" }).first().waitFor();
  await stage.page.locator(".codelens-decoration", { hasText: /^\d references?$/ }).first().waitFor();
});

test("a run with errors says so once and shows the first", async () => {
  await stage.page.locator(".view-line").first().click();
  await stage.page.keyboard.press("F5");
  await stage.toast(/`yard` has errors: .*rovr/, "Show Problem");
  await until("the cursor is at the error", async () => /Ln 6, Col/.test(spaced(await stage.page.locator(".statusbar").innerText())));
  await stage.page.keyboard.press("Escape");
  await stage.call("PyDSLRep: Generate Script");
  await stage.toast(/`yard` has errors: .*rovr/);
});

test("a problem's code, the light bulb and a command open its page", async () => {
  const page = stage.page.locator('.tab[data-resource-name="unresolved-reference.md"]');
  const close = async () => {
    await page.waitFor();
    // Rendered, not as Markdown.
    const frame = await stage.webview("h2:has-text('Why it matters')");
    assert.equal(await frame.locator("h1").innerText(), "unresolved-reference");
    await page.click({ button: "middle" });
    await page.waitFor({ state: "detached" });
    // *Show Problem* has put the cursor there.
    await stage.page.keyboard.press("Control+1");
  };
  await stage.hoverWord("movement patrol of", "rovr");
  await stage.page.locator(".monaco-hover a.code-link", { hasText: "unresolved-reference" }).first().click();
  await close();
  await stage.call("PyDSLRep: Explain This Problem");
  await close();
  const offered = stage.page.locator(".action-widget .monaco-list-row", { hasText: "Explain this problem: unresolved-reference" });
  await stage.openWidget("Control+.", offered.first());
  await offered.first().click();
  await close();
  await stage.page.keyboard.press("Control+Home");
});

test("a quick fix fixes the error", async () => {
  await stage.page.locator(".squiggly-error").first().waitFor();
  await stage.clickWord("movement patrol of", "rovr");
  await stage.openWidget("Control+.", stage.page.locator(".action-widget .monaco-list-row", { hasText: "rover" }).first());
  await stage.picture("quick-fix");
  await stage.page.keyboard.press("Enter");
  await stage.page.locator(".squiggly-error").first().waitFor({ state: "detached" });
  assert.match(await stage.text(), /movement patrol of rover \{/);
});

test("hints after each action show its duration and where it ends", async () => {
  await until("hints are shown", async () => /move 2.0 meters.* s → 2\.00, 0\.00, 0°/.test(await stage.text()));
});

test("completion offers what can come next", async () => {
  await stage.clickLine("move 50 centimeters");
  await stage.page.keyboard.press("End");
  await stage.page.keyboard.press("Enter");
  await stage.type("tu");
  const offered = stage.page.locator(".suggest-widget.visible .monaco-list-row");
  await stage.openWidget("Control+Space", offered.filter({ hasText: "turn" }).first());
  await stage.picture("completion");
  await stage.page.keyboard.press("Escape");
  await stage.type("rn right 45");
  await stage.page.keyboard.press("Escape");
  await stage.page.keyboard.press("Control+S");
  await until("it is saved", () => stage.read("yard.pyr").includes("\n  turn right 45\n}"));
  await stage.page.locator(".squiggly-error").first().waitFor({ state: "detached" });
});

const LATE = [
  { before: "move 4 ", letter: "m", offered: "meters", after: "eters" },
  { before: "", letter: "t", offered: "turn left", after: "urn left" },
];
for (const { before, letter, offered, after } of LATE) {
  test(`while the server is late, Enter ends the line behind ${before}${letter}${after}`, async () => {
    await stage.clickLine("turn");
    await stage.page.keyboard.press("End");
    await stage.page.keyboard.press("Enter");
    await stage.type(before);
    const item = stage.page.locator(".suggest-widget.visible .monaco-list-row", { hasText: offered }).first();
    // The editor asks for nothing while it waits for what follows the blank.
    await until(`${offered} is offered`, async () => {
      await stage.type(letter);
      const isOffered = await item.waitFor({ timeout: 2000 }).then(() => true, () => false);
      if (!isOffered) await stage.page.keyboard.press("Backspace");
      return isOffered;
    });
    const [server] = stage.servers();
    process.kill(server, "SIGSTOP");
    try {
      await stage.type(after);
      await stage.page.keyboard.press("Enter");
      await stage.type("turn left 9");
    } finally {
      process.kill(server, "SIGCONT");
    }
    await stage.page.keyboard.press("Escape");
    await stage.page.keyboard.press("Control+S");
    await until("it is saved", () => stage.read("yard.pyr").includes(`\n  ${before}${letter}${after}\n  turn left 9\n`));
  });
}

test("hovering over a robot shows its equations", async () => {
  await stage.hoverWord("robot rover", "rover");
  const hover = stage.page.locator(".monaco-hover .hover-contents, .monaco-resizable-hover .hover-contents");
  await hover.filter({ hasText: "wheelL" }).first().waitFor();
  await stage.page.mouse.move(5, 5);
});

test("the script is generated from the palette and opened", async () => {
  await stage.call("PyDSLRep: Generate Script");
  await until("the script is written", () => existsSync(path.join(stage.folder, "yard.py")));
  assert.match(stage.read("yard.py"), /def patrol|patrol/);
  await stage.tab("yard.py").waitFor();
  await stage.tab("yard.pyr").click();
});

test("the program runs in the simulator, and the preview sums up the run without covering the path", async () => {
  await stage.line("movement patrol").first().waitFor();
  // The run is going on, or has ended and is shown.
  const begun = stage.page.locator('.editor-actions [aria-label^="Stop Run"]:visible, iframe.webview:visible').first();
  await stage.clickLens("Run", begun);
  const message = await runMessage();
  assert.match(spaced(await message.innerText()), /yard: [\d.]+ s \(planned: [\d.]+ s\) simulated in [\d.]+ s/);
  assert.deepEqual(await message.getByRole("button").allInnerTexts(), ["Show Table"]);
  const frame = await stage.webview("main.preview");
  const covered = await frame.evaluate(() => {
    const box = (part) => document.querySelector(`[data-part="${part}"]`).getBoundingClientRect();
    const [result, legend, picture] = ["result", "legend", "picture"].map(box);
    return result.bottom > legend.top + 0.5 || result.bottom > picture.top + 0.5;
  });
  assert.equal(covered, false);
});

test("the preview shows the driven path", async () => {
  const frame = await stage.webview("main.preview");
  await frame.locator('main.preview[data-driven="yard"]').waitFor();
  assert.match(await frame.locator("main.preview").innerText(), /driven path ends \d/);
});

test("the message opens the table of the run", async () => {
  await (await runMessage()).getByRole("button", { name: "Show Table" }).click();
  const table = stage.page.locator(".panel .view-lines");
  await until("the table is shown", async () => /rover planned .* driven /.test(spaced(await table.innerText())));
  await stage.call("Notifications: Clear All Notifications");
  await stage.page.locator(".notification-toast").first().waitFor({ state: "detached" });
  await stage.picture("run");
});

test("after an edit, the result is marked as one of the program before", async () => {
  const frame = await stage.webview("main.preview");
  const since = frame.locator('[data-part="result"]', { hasText: "The program has changed since." });
  assert.equal(await since.count(), 0);
  await stage.clickLine("turn left");
  await stage.page.keyboard.press("End");
  await stage.type(" 45");
  await since.waitFor();
  await frame.getByText("Latest run, before the program changed").waitFor();
  // What the run drew is not exported as the path of this program.
  await stage.call("PyDSLRep: Export Path…");
  await stage.page.locator(".quick-input-widget .monaco-list-row", { hasText: "SVG" }).first().click();
  await stage.acceptFile("yard.svg");
  await stage.toast("Path exported: yard.svg");
  assert.doesNotMatch(stage.read("yard.svg"), /driven/);
  await stage.clickLine("turn left 45");
  await stage.page.keyboard.press("End");
  for (let key = 0; key < 3; key += 1) await stage.page.keyboard.press("Backspace");
  await since.waitFor({ state: "detached" });
});

test("the steps of the walkthrough are ticked off once done", async () => {
  assert.deepEqual(await stage.walkthrough(), ["Write a program", "Preview the path", "Run it", "Export the script"]);
});

/** What the preview says at the end of a run. */
async function runMessage() {
  const frame = await stage.webview("main.preview");
  const message = frame.locator('[data-part="result"]', { hasText: "simulated in" });
  await message.waitFor();
  return message;
}
