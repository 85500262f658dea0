// Programs look the same before the server answers and afterwards: the grammar's colours are those of semantic tokens.
import assert from "node:assert/strict";
import { readdirSync } from "node:fs";
import path from "node:path";
import { test } from "node:test";

import { Stage, program, repository, until } from "./stage.mjs";

const names = readdirSync(path.join(repository, "tests/paper")).filter((name) => name.endsWith(".pyr"));
const files = Object.fromEntries(names.map((name) => [name, program(`tests/paper/${name}`)]));

const THEMES = ["Default Dark Modern", "Default Light Modern", "Default High Contrast", "Monokai"];

/** Nothing in the lines but the program. */
const BARE = { "editor.codeLens": false, "editor.inlayHints.enabled": "off", "editor.occurrencesHighlight": "off" };

const MARK = "rgb(1, 254, 3)";
const MARKED = { enabled: true, rules: { "class": "#01fe03" } };

/** Every character of the editor that can be seen, with its colour. */
function colours(page) {
  return page.evaluate(() => {
    const lines = [...document.querySelectorAll(".editor-instance .view-line")];
    const top = (line) => Number.parseInt(line.style.top, 10);
    return lines.sort((a, b) => top(a) - top(b)).flatMap((line) => {
      const walker = document.createTreeWalker(line, NodeFilter.SHOW_TEXT);
      const found = [];
      while (walker.nextNode()) {
        const style = getComputedStyle(walker.currentNode.parentElement);
        for (const character of walker.currentNode.data.replace(/\s/g, "")) {
          found.push(`${character} ${style.color} ${style.fontWeight} ${style.fontStyle} ${style.textDecorationLine}`);
        }
      }
      return found;
    });
  });
}

/** The colours once they no longer change. */
async function settled(page) {
  let last = "";
  return until("colours stay as they are", async () => {
    const now = await colours(page);
    const same = now.length > 0 && JSON.stringify(now) === last;
    last = JSON.stringify(now);
    await page.waitForTimeout(300);
    return same && now;
  });
}

test("with and without semantic tokens every character of the article's programs has one colour", async () => {
  await Stage.with({ files, open: names[0], settings: BARE, size: { width: 1300, height: 1000 } }, async (stage) => {
    let compared = 0;
    for (const name of names) {
      await stage.openFile(name);
      for (const theme of THEMES) {
        stage.set({ "workbench.colorTheme": theme, "editor.semanticTokenColorCustomizations": MARKED });
        // Only the server knows which name is a robot's, so its tokens are here when one has the mark.
        await until(`semantic tokens in ${name}`, async () => (await colours(stage.page)).some((seen) => seen.includes(MARK)));
        stage.set({ "editor.semanticTokenColorCustomizations": { enabled: true } });
        await until("the mark is gone", async () => !(await colours(stage.page)).some((seen) => seen.includes(MARK)));
        const semantic = await settled(stage.page);
        stage.set({ "editor.semanticTokenColorCustomizations": { enabled: false } });
        await stage.page.waitForTimeout(500);
        const grammatical = await settled(stage.page);
        assert.equal(semantic.map((seen) => seen[0]).join(""), files[name].replace(/\s/g, ""), `${name} is seen whole`);
        assert.deepEqual(grammatical, semantic, `${name} in ${theme}`);
        assert.ok(new Set(semantic.map((seen) => seen.slice(2))).size > 3, `${name} has colours in ${theme}`);
        compared += semantic.length;
      }
    }
    console.log(`${compared} characters compared, in ${names.length} programs and ${THEMES.length} themes`);
  });
});
