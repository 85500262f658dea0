// The first minutes of somebody who opens an empty file: default settings, nothing known.
import assert from "node:assert/strict";
import { after, afterEach, before, test } from "node:test";

import { Stage, spaced, until } from "./stage.mjs";

let stage;
before(async () => {
  stage = await Stage.open({
    files: { "empty.pyr": "", "wide.pyr": "movement m of r {\n    move 1 meters\n}\n" },
    open: "empty.pyr",
  });
});
afterEach((t) => t.passed || stage?.keepPicture());
after(() => stage?.close());

/** What the status bar says. */
const bar = async () => spaced(await stage.page.locator(".statusbar").innerText());

test("an empty file that was open before the extension was known is indented by two", async () => {
  await until("the status bar says it", async () => /Spaces: 2/.test(await bar()));
});

test("whatever a file has, two is what is typed", async () => {
  await stage.openFile("wide.pyr");
  await until("the status bar says it", async () => /Spaces: 2/.test(await bar()));
  await stage.openFile("empty.pyr");
});

test("enter after a brace indents, and the brace that came with it is typed over", async () => {
  await stage.line("").first().click();
  await stage.type("robot r has { a } wheels");
  await stage.page.keyboard.press("Enter");
  await stage.type("movement m of r {");
  await stage.page.keyboard.press("Enter");
  await stage.type("turn left");
  await stage.page.keyboard.press("Control+S");
  await until("it is saved", () => stage.read("empty.pyr") !== "");
  assert.equal(stage.read("empty.pyr"), "robot r has { a } wheels\nmovement m of r {\n  turn left\n}");
});
