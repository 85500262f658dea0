// Writing in the playground: what the language server offers, the preview, links, and who can use it.
import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { createRequire } from "node:module";
import path from "node:path";
import { after, before, test } from "node:test";

import { launch, OUT, Playground, ROOT, serve } from "./stage.mjs";

const AXE = readFileSync(createRequire(import.meta.url).resolve("axe-core/axe.min.js"), "utf8");
const PROGRAM = `wheel l with radius 4.5
wheel r with radius 4.5
robot rover type tw with port 23000 has { l r } wheels
movement there of rover {
  move 2 meters
  turn left
  move 1 meters
}
environment area has { rover } robots with { there } moves
`;

/** The problems of examples as the article prints them. */
const AS_PRINTED = { table4_holonomic: [1, "warning"], table5_angles_as_printed: [4, "error"] };

let browser;
let site;

before(async () => {
  [browser, site] = await Promise.all([launch(), serve()]);
});

after(async () => {
  await browser?.close();
  site?.close();
});

/** A test with a page, which must load nothing from elsewhere and respect its policy. */
function inPage(name, body, options = {}) {
  test(name, async () => {
    const playground = await Playground.open(browser, site.address, options);
    await body(playground, playground.page);
    assert.deepEqual(playground.errors, []);
    const others = playground.requests.filter((address) => !address.startsWith(site.address) && !/^(data|blob):/.test(address));
    assert.deepEqual(others, []);
    await playground.close();
  });
}

inPage("diagnostics appear as one types, with a count on the tab", async (playground, page) => {
  await playground.write(PROGRAM.replace("turn left", "trun left"));
  await playground.editor.locator(".cm-lintRange-error").first().waitFor();
  await playground.tab("Program").getByLabel("1 error").waitFor();
  await playground.write(PROGRAM);
  await playground.editor.locator(".cm-lintRange-error").waitFor({ state: "detached" });
  await page.locator('#tab-program .badge:not([hidden])').waitFor({ state: "detached" });
});

inPage("a diagnostic's message has its fixes", async (playground) => {
  await playground.write(PROGRAM.replace("turn left", "trun left"));
  await playground.editor.locator(".cm-lintRange-error").first().hover();
  await playground.editor.locator(".fix").first().click();
  await playground.becomes(PROGRAM);
});

inPage("fixes are offered in a menu at the cursor, by the keyboard alone", async (playground, page) => {
  await playground.write(PROGRAM.replace("turn left", "trun left"));
  await playground.editor.locator(".cm-lintRange-error").first().waitFor();
  await playground.place("trun");
  await page.keyboard.press("Control+.");
  await playground.editor.getByRole("menuitem").first().waitFor();
  await page.waitForFunction(() => document.querySelector("#editor").shadowRoot.activeElement?.role === "menuitem");
  await page.keyboard.press("Enter");
  await playground.becomes(PROGRAM);
  await page.keyboard.press("Control+.");
  await playground.editor.getByRole("menu").waitFor();
  await page.waitForFunction(() => document.querySelector("#editor").shadowRoot.activeElement?.role === "menuitem");
  await page.keyboard.press("Escape");
  await playground.editor.getByRole("menu").waitFor({ state: "detached" });
});

inPage("names and keywords are completed", async (playground, page) => {
  await playground.write(PROGRAM);
  await playground.place("turn left");
  await page.keyboard.press("Enter");
  await page.keyboard.type("tu");
  // By the mouse: for a moment after the list has come, Enter is meant for the text.
  await playground.editor.getByRole("option").first().click();
  assert.match(await playground.text(), /turn left\n  turn/);
});

test("blocks are indented at once, and stay so when the server answers late", async () => {
  const context = await browser.newContext();
  await context.addInitScript(() => {
    const receive = (listener) => (event) => {
      if (globalThis.held) globalThis.held.push(() => listener(event));
      else listener(event);
    };
    globalThis.Worker = class extends Worker {
      addEventListener(type, listener, options) {
        super.addEventListener(type, receive(listener), options);
      }
    };
  });
  const playground = await Playground.openIn(context, site.address);
  const { keyboard } = playground.page;
  await playground.pathShown("yard");
  await playground.write(PROGRAM.replace(/ \{\n  move[^}]*\}/, ""));
  await playground.place("there of rover");
  await playground.page.evaluate(() => {
    globalThis.held = [];
  });
  for (const line of [" {", "repeat 2 times {", "repeat 3 times {", "move 1 meters"]) {
    await keyboard.type(line);
    if (line.endsWith("{")) await keyboard.press("Enter");
  }
  const typed = PROGRAM.replace(/\{\n  move[^}]*\}/, "{\n  repeat 2 times {\n    repeat 3 times {\n      move 1 meters\n    }\n  }\n}");
  assert.equal(await playground.text(), typed);
  await playground.page.evaluate(() => {
    const { held } = globalThis;
    globalThis.held = undefined;
    for (const answer of held) answer();
  });
  // It is asked for after everything else.
  await playground.editor.locator(".hint", { hasText: "6.00, 0.00" }).first().waitFor();
  assert.equal(await playground.text(), typed);
  await context.close();
});

inPage("hovering over an action says where it ends", async (playground) => {
  await playground.write(PROGRAM);
  await playground.pathShown("area");
  await playground.content.getByText("move", { exact: true }).first().hover();
  const tooltip = playground.editor.locator(".cm-tooltip-hover");
  await tooltip.waitFor();
  // What the statement, which the tooltip quotes, does not say.
  assert.match(await tooltip.innerText(), /From \(0 m, 0 m, 0°\) to \(2 m, 0 m, 0°\)/);
});

inPage("signature help says what comes next", async (playground, page) => {
  await playground.write(PROGRAM);
  await playground.place("move 2 ");
  await page.keyboard.press("Control+Shift+Space");
  const signature = playground.editor.locator(".cm-lsp-signature");
  await signature.waitFor();
  assert.match(await signature.innerText(), /move DISTANCE meters \| centimeters \[at SPEED\]/);
});

inPage("hints show where each action ends, follow the text, and can be written into it", async (playground) => {
  await playground.write(PROGRAM);
  const hints = playground.editor.locator(".hint");
  const pose = (x, y, turned) => hints.filter({ hasText: `${x}, ${y}, ${turned}` }).first().waitFor();
  await pose("2.00", "1.00", "90°");
  await playground.write(PROGRAM.replace("move 2 meters", "move 3 meters"));
  await pose("3.00", "1.00", "90°");
  // The settings decide, too, and are another text.
  await playground.tab("Settings").click();
  await playground.write("[inlay-hints]\npose = false\nduration = false\ndefaults = true\n");
  await playground.tab("Program").click();
  await hints.filter({ hasText: "3.00" }).first().waitFor({ state: "detached" });
  const angle = hints.filter({ hasText: /^90/ });
  await angle.waitFor();
  await angle.dblclick();
  assert.match(await playground.text(), /turn left 90\b/);
});

inPage("the preview says what is wrong now, leads there and fixes it", async (playground) => {
  await playground.write(PROGRAM);
  await playground.pathShown("area");
  const banner = playground.preview.locator('[data-part="banner"]');
  for (const [before, after, word] of [["move 1 meters", "move 1 parsecs", "parsecs"], ["turn left", "trun left", "trun"]]) {
    await playground.write(PROGRAM.replace(before, after));
    // What is wrong in the line of the cursor may be settled by the next word.
    await playground.place("wheel l");
    await banner.getByText(word, { exact: true }).first().waitFor();
  }
  await banner.getByRole("button", { name: "line 6" }).click();
  await playground.page.waitForFunction(() => {
    const content = document.querySelector("#editor").shadowRoot.querySelector(".cm-editor:not([hidden]) .cm-content");
    const { state } = content.cmTile.root.view;
    return state.doc.lineAt(state.selection.main.from).number === 6;
  });
  await banner.locator('[data-part="fix"]').click();
  await playground.becomes(PROGRAM);
  await banner.waitFor({ state: "hidden" });
});

inPage("F8 goes to errors first, then to warnings, and Shift+F8 back", async (playground, page) => {
  const wrong = `wheel tall with radius 4500\n${PROGRAM.replace("turn left", "trun left").replace("move 1 meters", "move 1 parsecs")}`;
  await playground.write(wrong);
  await playground.editor.locator(".cm-lintRange-warning").first().waitFor();
  await playground.editor.locator(".cm-lintRange-error").nth(1).waitFor();
  await playground.place("wheel tall", { before: true });
  const selected = () =>
    playground.content.evaluate((content) => {
      const { state } = content.cmTile.root.view;
      return state.sliceDoc(state.selection.main.from, state.selection.main.to);
    });
  const visited = [];
  const press = async (key) => {
    await page.keyboard.press(key);
    await playground.editor.locator(".problem").waitFor();
    visited.push(await selected());
  };
  await press("F8");
  assert.match(await playground.editor.locator(".problem").innerText(), /trun/);
  for (const key of ["F8", "F8", "F8", "Shift+F8", "Shift+F8"]) await press(key);
  // The last one is a hint: the wheel is not used.
  assert.deepEqual(visited, ["trun", "parsecs", "4500", "tall", "4500", "parsecs"]);
  await page.keyboard.press("ArrowRight");
  await playground.editor.locator(".problem").waitFor({ state: "detached" });
});

inPage("F2 renames everywhere", async (playground, page) => {
  await playground.write(PROGRAM);
  await playground.place("robot rov");
  await page.keyboard.press("F2");
  const input = playground.editor.locator(".cm-lsp-rename-panel input");
  await input.waitFor();
  await input.fill("scout");
  await input.press("Enter");
  await playground.becomes(PROGRAM.replaceAll("rover", "scout"));
});

inPage("programs are formatted", async (playground, page) => {
  await playground.write("wheel   l with radius   4.5\n");
  await page.getByRole("button", { name: "Format" }).click();
  await playground.becomes("wheel l with radius 4.5\n");
});

inPage("colours are those of the server", async (playground) => {
  await playground.write(PROGRAM);
  const keyword = playground.content.locator(".tok-keyword").first();
  await keyword.waitFor();
  assert.equal(await keyword.innerText(), "wheel");
  assert.equal(await keyword.evaluate((found) => getComputedStyle(found).color), "rgb(0, 104, 163)");
});

inPage("the outline leads to declarations", async (playground, page) => {
  await playground.write(PROGRAM);
  await page.getByRole("navigation", { name: "Outline" }).getByRole("button", { name: /^there/ }).click();
  assert.equal(await playground.line(), 4);
});

inPage("the preview follows the text and the cursor, and leads to the program", async (playground, page) => {
  await playground.write(PROGRAM);
  await playground.pathShown("area");
  await playground.place("turn le");
  await playground.preview.locator('main[data-highlighted="there 1"]').waitFor({ state: "attached" });
  // The keys of the preview: the next action, and to its line.
  await playground.preview.locator('[data-part="picture"]').focus();
  await page.keyboard.press("n");
  await page.keyboard.press("Enter");
  await page.waitForFunction(() => {
    const { state } = document.querySelector("#editor").shadowRoot.querySelector(".cm-content").cmTile.root.view;
    return state.sliceDoc(state.selection.main.from, state.selection.main.to).startsWith("move 1 meters");
  });
});

inPage("a scene has its tab, is checked, and changes the path", async (playground, page) => {
  await playground.write(PROGRAM);
  await playground.pathShown("area");
  await playground.tab("Scene").click();
  await playground.write("[[cylinder]]\nat = [1.0, 0.0]\nradius = 0.15\n");
  // The robot would hit it.
  await playground.preview.getByText(/hits|collision/i).first().waitFor();
  await playground.write("[[cylindre]]\nat = [1.0, 0.0]\n");
  await playground.tab("Scene").getByLabel(/1 (error|warning)/).waitFor();
  await playground.write("");
  await page.locator("#tab-scene .badge[hidden]").waitFor({ state: "attached" });
});

inPage("each environment has its scene, which goes along when it is renamed", async (playground) => {
  const two = PROGRAM.replace("environment area", "environment first has { rover } robots with { there } moves\n$&");
  await playground.write(two);
  await playground.pathShown("first");
  await playground.tab("Scene").click();
  await playground.write("[[cylinder]]\nat = [3.0, 2.0]\nradius = 0.15\n");
  await playground.preview.getByLabel("Environment").selectOption("area");
  await playground.pathShown("area");
  assert.equal(await playground.text(), "");
  await playground.preview.getByLabel("Environment").selectOption("first");
  await playground.pathShown("first");
  assert.match(await playground.text(), /3\.0, 2\.0/);
  await playground.tab("Program").click();
  await playground.write(two.replace("environment first", "environment renamed"));
  await playground.pathShown("renamed");
  await playground.tab("Scene").click();
  assert.match(await playground.text(), /3\.0, 2\.0/);
});

inPage("settings have their tab, are checked, and hold for the program", async (playground, page) => {
  await playground.write(`wheel tall with radius 4500\n${PROGRAM}`);
  await playground.tab("Program").getByLabel(/1 warning/).waitFor();
  await playground.tab("Settings").click();
  await playground.write('[severity]\nimplausible-radius = "off"\n');
  await page.locator("#tab-program .badge[hidden]").waitFor({ state: "attached" });
  await playground.write("nonsense = 1\n");
  await playground.tab("Settings").getByLabel(/1 (error|warning)/).waitFor();
});

inPage("every example opens without errors", async (playground, page) => {
  const names = await page.locator("#examples option").evaluateAll((options) => options.map(({ value }) => value).filter(Boolean));
  assert.ok(names.length >= 13, `${names}`);
  for (const name of names) {
    await playground.choose(name);
    const [number, severity] = AS_PRINTED[name] ?? [0];
    await playground.counts(number, severity);
    if (severity !== "error") {
      const environment = /^environment (\w+)/m.exec(await playground.text())[1];
      await playground.pathShown(environment);
    }
    // One more error, so that the page shows another number until the server has read the next example.
    await playground.write(`${await playground.text()}wheel wrong with radius -1\n`);
    await playground.counts(severity === "error" ? number + 1 : 1);
  }
});

inPage("the generated script is shown", async (playground) => {
  await playground.write(PROGRAM);
  await playground.pathShown("area");
  await playground.tab("Script").click();
  await playground.content.getByText("# Generated by PyDSLRep").waitFor();
  assert.match(await playground.text(), /await rover\.move\(2\.0\)/);
});

inPage("a link carries the program, its scene and its settings", async (playground, page) => {
  const scene = "[[cylinder]]\nat = [3.0, 2.0]\nradius = 0.15\n";
  const settings = "default-speed = 20\n";
  await playground.write(PROGRAM);
  await playground.pathShown("area");
  await playground.tab("Scene").click();
  await playground.write(scene);
  await playground.tab("Settings").click();
  await playground.write(settings);
  await page.getByRole("button", { name: "Share" }).click();
  await page.waitForFunction(() => location.hash.startsWith("#project="));
  const copy = await Playground.open(browser, page.url());
  await copy.pathShown("area");
  assert.equal(await copy.text(), PROGRAM);
  await copy.tab("Scene").click();
  assert.equal(await copy.text(), scene);
  await copy.tab("Settings").click();
  assert.equal(await copy.text(), settings);
  await copy.close();
});

inPage(
  "hostile text in a program does nothing",
  async (playground, page) => {
    await playground.pathShown();
    await playground.write('// <img src=x onerror="document.title=1">\nwheel <b>l</b> with radius 4.5\n');
    await playground.editor.locator(".cm-lintRange-error").first().hover();
    await playground.editor.locator(".diagnostic").first().waitFor();
    assert.equal(await page.title(), "PyDSLRep playground");
    assert.equal(await playground.editor.locator("img").count(), 0);
  },
);

test("Markdown keeps only plain formatting", async () => {
  const esbuild = createRequire(path.join(ROOT, "editors/playground/package.json"))("esbuild");
  const entry = path.join(ROOT, "editors/playground/src/editor/markup.ts");
  const { outputFiles } = await esbuild.build({ entryPoints: [entry], bundle: true, write: false, format: "iife", globalName: "markup" });
  const page = await browser.newPage();
  await page.addScriptTag({ content: outputFiles[0].text });
  const clean = (html) => page.evaluate((given) => globalThis.markup.sanitize(given), html);
  assert.equal(await clean('<p class="a" style="x" onclick="y">a <b>b</b></p>'), '<p class="a">a <b>b</b></p>');
  assert.equal(await clean('<img src=x onerror="alert(1)"><svg onload="alert(1)"><script>z</script></svg>z'), "z");
  assert.equal(await clean('<p data-x="1" aria-label="y" id="z">a</p><form><input name="b">c</form>'), "<p>a</p>c");
  assert.equal(await clean('<a href="javascript:alert(1)">a</a>'), "<a>a</a>");
  assert.equal(await clean('<a href="https://example.com/">a</a>'), '<a href="https://example.com/" target="_blank" rel="noopener noreferrer">a</a>');
  assert.equal(await clean("<pre><code>a &lt;b&gt;</code></pre>"), "<pre><code>a &lt;b&gt;</code></pre>");
  await page.close();
});

for (const colorScheme of ["light", "dark"]) {
  inPage(
    `the ${colorScheme} page is accessible`,
    async (playground, page) => {
      await playground.write(PROGRAM.replace("turn left", "trun left"));
      await playground.editor.locator(".cm-lintRange-error").first().waitFor();
      await playground.preview.locator("main").waitFor();
      assert.equal(await page.evaluate(() => document.documentElement.dataset.theme), colorScheme);
      await audit(page);
      await playground.choose("crossing");
      await playground.pathShown("crossing");
      await audit(page);
      await page.screenshot({ path: path.join(OUT, `${colorScheme}.png`) });
      await page.getByRole("button", { name: "Drafts" }).click();
      await page.getByRole("dialog").waitFor();
      await audit(page);
    },
    { colorScheme },
  );
}

/** No violations of WCAG's rules in the page and the preview. */
async function audit(page) {
  for (const frame of page.frames()) {
    // What an error dims or shows, it does a moment later.
    await frame.evaluate(() => Promise.allSettled(document.getAnimations().map(({ finished }) => finished)));
    await frame.evaluate(AXE);
  }
  const { violations } = await page.evaluate(() => window.axe.run(document, { runOnly: ["wcag2a", "wcag2aa", "wcag21a", "wcag21aa", "wcag22aa", "best-practice"] }));
  const found = violations.map(({ id, nodes }) => `${id}: ${nodes.map(({ html, target }) => `${target} ${html}`).join("\n  ")}`);
  assert.deepEqual(found, []);
}

inPage("everything can be reached by the keyboard", async (playground, page) => {
  await playground.pathShown();
  const reached = new Set();
  for (let press = 0; press < 40; press += 1) {
    await page.keyboard.press("Tab");
    reached.add(await page.evaluate(() => document.activeElement?.id || document.activeElement?.tagName));
    // Tab indents in the editor; after Escape it leaves.
    if (await page.evaluate(() => document.activeElement?.id === "editor")) await page.keyboard.press("Escape");
  }
  for (const id of ["examples", "drafts", "run", "format", "share", "theme", "tab-program", "editor", "preview"]) assert.ok(reached.has(id), `${id} of ${[...reached]}`);
  await page.locator("#tab-program").focus();
  await page.keyboard.press("ArrowRight");
  assert.equal(await page.locator('[role="tab"][aria-selected="true"]').innerText(), "Scene");
  await page.keyboard.press("Alt+1");
  assert.equal(await page.evaluate(() => document.querySelector("#editor").shadowRoot.activeElement?.getAttribute("aria-label")), "Program");
});

inPage("the colours can be chosen, and the choice is kept", async (playground, page) => {
  await page.getByRole("button", { name: "Dark colours" }).click();
  assert.equal(await page.evaluate(() => document.documentElement.dataset.theme), "dark");
  await playground.pathShown();
  assert.equal(await playground.preview.locator("body").getAttribute("class"), "vscode-dark");
  await page.reload();
  assert.equal(await page.evaluate(() => document.documentElement.dataset.theme), "dark");
});

inPage(
  "it fits a phone",
  async (playground, page) => {
    await playground.pathShown();
    const [width, wanted] = await page.evaluate(() => [innerWidth, document.documentElement.scrollWidth]);
    assert.ok(wanted <= width, `${wanted} > ${width}`);
    for (const name of ["Run", "Share"]) assert.ok(await page.getByRole("button", { name }).isVisible());
    await audit(page);
    await page.screenshot({ path: path.join(OUT, "phone.png"), fullPage: true });
  },
  { width: 360, height: 740, hasTouch: true, isMobile: true },
);
