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

/** What a theme shows: the first all programs, the others the longest. LONG=1 shows all programs in all themes. */
function shownIn(theme) {
  const isShort = theme !== Object.keys(THEMES)[0] && !process.env.LONG;
  return isShort ? names.toSorted((one, other) => files[other].length - files[one].length).slice(0, 1) : names;
}

/** Shows nothing in the lines except the program. */
const PLAIN = { "editor.codeLens": false, "editor.inlayHints.enabled": "off", "editor.occurrencesHighlight": "off" };

/** Colours that no theme has, for two types of semantic tokens: they prove that the new settings are applied. */
const MARKS = { "class": "rgb(1, 254, 3)", "function": "rgb(1, 253, 3)" };

function marked(type) {
  const [red, green, blue] = MARKS[type].match(/\d+/g).map((part) => Number(part).toString(16).padStart(2, "0"));
  return { "editor.semanticTokenColorCustomizations": { rules: { [type]: `#${red}${green}${blue}` } } };
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

/** Whether semantic tokens are shown: the extension turns them on for programs. */
function tokens(isShown) {
  return { "[pydslrep]": isShown ? {} : { "editor.semanticHighlighting.enabled": false } };
}

/** The colours of a program once all of it is visible and passes the check. */
function coloursOnce(stage, name, what, check) {
  return until(`${what} in all of ${name}`, async () => {
    const seen = await colours(stage.page);
    const whole = seen.map((one) => one[0]).join("") === files[name].replace(/\s/g, "");
    return whole && check(seen) && seen;
  });
}

/** The colours of a program with semantic tokens, put together from those in which other names are marked. */
async function withTokens(stage, name, theme) {
  const marking = (type) => {
    stage.set({ ...tokens(true), ...marked(type) });
    return coloursOnce(stage, name, `${type} is marked in ${theme}`, (seen) => isExact(seen, type, files[name]));
  };
  const robots = await marking("class");
  const movements = await marking("function");
  return movements.map((one, at) => (has([one], "function") ? robots[at] : one));
}

/** The colours of a program by the grammar alone, once they are the expected ones: the marks are gone. */
async function withoutTokens(stage, name, theme, expected) {
  stage.set(tokens(false));
  let seen;
  const isSame = (found) => ((seen = found), found.join() === expected.join());
  await coloursOnce(stage, name, `the same colours in ${theme}`, isSame).catch((error) => {
    const differing = seen.flatMap((one, at) => (one === expected[at] ? [] : [`${at}: ${one}, not ${expected[at]}`]));
    throw new Error([error.message, ...differing].join("\n"));
  });
  return seen;
}

test("semantic tokens change the colour of no character of the article's programs", async () => {
  const options = { files, open: names[0], settings: PLAIN, size: { width: 1300, height: 900 } };
  await Stage.with(options, async (stage) => {
    for (const [theme, cssClass] of Object.entries(THEMES)) {
      stage.set({ "workbench.colorTheme": theme });
      await stage.page.locator(`.monaco-workbench[class*="${cssClass}"]`).waitFor();
      let compared = 0;
      for (const name of shownIn(theme)) {
        await stage.openFile(name);
        const seen = await withoutTokens(stage, name, theme, await withTokens(stage, name, theme));
        assert.ok(new Set(seen.map((one) => one.slice(2))).size > 3, `${name} has colours in ${theme}`);
        compared += seen.length;
      }
      console.log(`${theme}: ${compared} characters of ${shownIn(theme).length} programs`);
    }
  });
});
