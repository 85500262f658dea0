// Programs look the same before and after the server responds: the grammar and semantic tokens give the same colours.
import assert from "node:assert/strict";
import { readdirSync } from "node:fs";
import path from "node:path";
import { test } from "node:test";

import { Stage, program, repository, until } from "./stage.mjs";

const names = readdirSync(path.join(repository, "tests/paper")).filter((name) => name.endsWith(".pyr"));
const files = Object.fromEntries(names.map((name) => [name, program(`tests/paper/${name}`)]));

/** Themes with their CSS class names. */
const THEMES = { "Default Dark Modern": "dark_modern", "Default Light Modern": "light_modern", Monokai: "monokai" };

/** Shows nothing in the lines except the program. */
const PLAIN = { "editor.codeLens": false, "editor.inlayHints.enabled": "off", "editor.occurrencesHighlight": "off" };

/** Colours that no theme has, for two types of semantic tokens: they prove that the new settings are applied. */
const MARKS = { "class": "rgb(1, 254, 3)", "function": "rgb(1, 253, 3)" };

function marked(type, enabled = true) {
  const [red, green, blue] = MARKS[type].match(/\d+/g).map((part) => Number(part).toString(16).padStart(2, "0"));
  return { "editor.semanticTokenColorCustomizations": { enabled, rules: { [type]: `#${red}${green}${blue}` } } };
}

const has = (seen, type) => seen.some((one) => one.includes(MARKS[type]));

/** The declarations of the names that are marked. */
const DECLARATIONS = { "class": /\brobot (\w+) type/g, "function": /\bmovement (\w+) of/g };

/** Whether exactly the names of a type are marked; while a theme changes, marks are at old positions. */
function isExact(seen, type, text) {
  const names = [...text.matchAll(DECLARATIONS[type])].map(([, name]) => name);
  const uses = text.match(new RegExp(`\\b(?:${names.join("|")})\\b`, "g"));
  const marks = seen.filter((one) => has([one], type)).map((one) => one[0]);
  return marks.join("") === uses.join("");
}

/** Every visible character of the editor with its style. */
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

test("semantic tokens change the colour of no character of the article's programs", async () => {
  await Stage.with({ files, open: names[0], settings: PLAIN, size: { width: 1300, height: 900 } }, async (stage) => {
    let compared = 0;
    for (const [theme, cssClass] of Object.entries(THEMES)) {
      stage.set({ "workbench.colorTheme": theme });
      await stage.page.locator(`.monaco-workbench[class*="${cssClass}"]`).waitFor();
      for (const name of names) {
        await stage.openFile(name);
        const colouringOnce = (what, check, patience) => {
          const isSo = async () => {
            const seen = await colours(stage.page);
            const whole = seen.map((one) => one[0]).join("") === files[name].replace(/\s/g, "");
            return whole && check(seen) && seen;
          };
          return until(`${what} in all of ${name} in ${theme}`, isSo, patience);
        };
        const withRobots = async () => {
          stage.set(marked("class"));
          return colouringOnce("robots are marked", (seen) => isExact(seen, "class", files[name]));
        };
        const withoutTokens = async (patience) => {
          stage.set(marked("function", false));
          return colouringOnce("no marks", (seen) => !has(seen, "class") && !has(seen, "function"), patience);
        };
        const robots = await withRobots();
        stage.set(marked("function"));
        const movements = await colouringOnce("movements are marked", (seen) => isExact(seen, "function", files[name]));
        // On a busy machine the editor now and then does not notice that tokens are turned off; it notices the next time.
        const textMate = await withoutTokens(10_000).catch(async () => {
          await withRobots();
          return withoutTokens();
        });

        const semantic = movements.map((one, at) => (has([one], "function") ? robots[at] : one));
        assert.deepEqual(textMate, semantic, `${name} in ${theme}`);
        assert.ok(new Set(semantic.map((one) => one.slice(2))).size > 3, `${name} has colours in ${theme}`);
        compared += semantic.length;
      }
    }
    console.log(`${compared} characters compared in ${names.length} programs and ${Object.keys(THEMES).length} themes`);
  });
});
