// Programs look the same before the server answers and afterwards: the grammar's colours are those of semantic tokens.
import assert from "node:assert/strict";
import { readdirSync } from "node:fs";
import path from "node:path";
import { test } from "node:test";

import { Stage, program, repository, until } from "./stage.mjs";

const names = readdirSync(path.join(repository, "tests/paper")).filter((name) => name.endsWith(".pyr"));
const files = Object.fromEntries(names.map((name) => [name, program(`tests/paper/${name}`)]));

/** Themes, each with what the page calls it. */
const THEMES = { "Default Dark Modern": "dark_modern", "Default Light Modern": "light_modern", Monokai: "monokai" };

/** Nothing in the lines but the program. */
const BARE = { "editor.codeLens": false, "editor.inlayHints.enabled": "off", "editor.occurrencesHighlight": "off" };

/** The semantic tokens of two types get colours that no theme has: what one sees is then proved to be new. */
const MARKS = { "class": "rgb(1, 254, 3)", "function": "rgb(1, 253, 3)" };

function marked(type, enabled = true) {
  const [red, green, blue] = MARKS[type].match(/\d+/g).map((part) => Number(part).toString(16).padStart(2, "0"));
  return { "editor.semanticTokenColorCustomizations": { enabled, rules: { [type]: `#${red}${green}${blue}` } } };
}

const has = (seen, type) => seen.some((one) => one.includes(MARKS[type]));

/** What declares the names that are marked. */
const DECLARING = { "class": /\brobot (\w+) type/g, "function": /\bmovement (\w+) of/g };

/** Whether all names of a type have its mark, and nothing else has: while a theme changes, marks are where the last ones were. */
function exact(seen, type, text) {
  const names = [...text.matchAll(DECLARING[type])].map(([, name]) => name);
  const uses = text.match(new RegExp(`\\b(?:${names.join("|")})\\b`, "g"));
  const marks = seen.filter((one) => has([one], type)).map((one) => one[0]);
  return marks.join("") === uses.join("");
}

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

test("with and without semantic tokens every character of the article's programs has one colour", async () => {
  await Stage.with({ files, open: names[0], settings: BARE, size: { width: 1300, height: 900 } }, async (stage) => {
    let compared = 0;
    for (const [theme, called] of Object.entries(THEMES)) {
      stage.set({ "workbench.colorTheme": theme });
      await stage.page.locator(`.monaco-workbench[class*="${called}"]`).waitFor();
      for (const name of names) {
        await stage.openFile(name);
        const once = (what, check) =>
          until(`${what} in all of ${name} in ${theme}`, async () => {
            const seen = await colours(stage.page);
            const whole = seen.map((one) => one[0]).join("") === files[name].replace(/\s/g, "");
            return whole && check(seen) && seen;
          });
        stage.set(marked("class"));
        const robots = await once("robots are marked", (seen) => exact(seen, "class", files[name]));
        stage.set(marked("function"));
        const movements = await once("movements are marked", (seen) => exact(seen, "function", files[name]));
        stage.set(marked("function", false));
        const grammatical = await once("no marks", (seen) => !has(seen, "class") && !has(seen, "function"));

        const semantic = movements.map((one, at) => (has([one], "function") ? robots[at] : one));
        assert.deepEqual(grammatical, semantic, `${name} in ${theme}`);
        assert.ok(new Set(semantic.map((one) => one.slice(2))).size > 3, `${name} has colours in ${theme}`);
        compared += semantic.length;
      }
    }
    console.log(`${compared} characters compared, in ${names.length} programs and ${Object.keys(THEMES).length} themes`);
  });
});
