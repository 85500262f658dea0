// The editor's API, by the tests in api/, and how a program with blocks, conditions and a movement that is done looks.
import assert from "node:assert/strict";
import { test } from "node:test";

import { Stage, program, spaced, until } from "./stage.mjs";

const NESTED = `wheel wheelL with radius 4.5
wheel wheelR with radius 4.5

sensor front

robot rover type tw with port 23000 has { wheelL wheelR } wheels with sensors { front }

movement side of rover {
  repeat 2 times {
    move 50 centimeters
  }
  turn left
}

movement patrol of rover {
  repeat 4 times {
    do side
    if { front } detect within 40 centimeters {
      turn left 90 with radius 50 centimeters
    } else {
      wait 2 seconds
      wait 2 seconds
    }
    turn right
  }
}

environment yard has { rover } robots with { patrol } moves
`;

/** A movement, and what does it in another file. */
const EDGE = `wheel wheelL with radius 4.5
wheel wheelR with radius 4.5

robot rover type tw with port 23000 has { wheelL wheelR } wheels

movement edge of rover {
  move 1 meters
}
`;
const AWAY = `import "parts/edge.pyr"

movement twice of rover {
  repeat 2 times {
    do edge
  }
}

environment away has { rover } robots with { twice } moves
`;

const ROVER = "wheel l with radius 4\nwheel r with radius 4\nrobot rover type tw with port 1 has { l r } wheels\n";
const FILES = {
  "square.pyr": program("examples/square.pyr"),
  "broken.pyr": "wheel w with radius -1\n",
  "unopened.pyr": "wheel w with radius -1\n",
  "unused.pyr": `sensor spare\n${program("examples/square.pyr")}`,
  "misspelt.pyr": `${ROVER}movement m of rovr {\n  move 1 meters\n}\n`,
  "nested.pyr": NESTED,
  "away.pyr": AWAY,
  "parts/edge.pyr": EDGE,
};

test("the editor's API, and blocks", async (t) => {
  const size = { width: 1100, height: 720 };
  const settings = { "editor.linkedEditing": true };
  await Stage.withApi({ files: FILES, settings, size }, async (stage, results) => {
    for (const { name, error } of results) {
      await t.test(name, () => assert.equal(error, undefined, error));
    }
    assert.ok(results.length > 20);
    await t.test("hints are shown in blocks", () => hintsAreShown(stage));
    await t.test("roll up is offered for equal actions", () => rollUpIsOffered(stage));
    await t.test("a movement and what does it are written at once", () => namesAreLinked(stage));
    await t.test("the heads of blocks stay in sight", () => headsStay(stage));
  });
});

async function hintsAreShown(stage) {
  await stage.page.keyboard.press("Escape");
  await until("hints are shown", async () => /do side.* s → 1\.00, 0\.00, 90°/.test(await stage.text()));
  await stage.page.keyboard.press("Control+B");
  await stage.page.locator(".part.sidebar").waitFor({ state: "hidden" });
  await stage.picture("blocks");
}

async function rollUpIsOffered(stage) {
  await stage.clickWord("wait 2 seconds", "wait");
  const offered = stage.page.locator(".action-widget .monaco-list-row", { hasText: "roll up into" });
  await stage.openWidget("Control+Shift+R", offered.first());
  await stage.picture("refactoring");
  await offered.first().click();
  await stage.line("repeat 2 times").nth(1).waitFor();
}

async function namesAreLinked(stage) {
  await stage.clickWord("do side", "side");
  await stage.page.locator(".linked-editing-decoration").first().waitFor();
  await stage.page.keyboard.type("x");
  await until("both have changed", async () => {
    const [, declared, done] = /movement (\w+) of rover.*do (\w+)/.exec(await stage.text()) ?? [];
    return declared !== "side" && declared === done;
  });
  await stage.page.keyboard.press("Control+Z");
  await stage.line("do side").first().waitFor();
}

async function headsStay(stage) {
  await stage.page.setViewportSize({ width: 1100, height: 300 });
  await stage.page.keyboard.press("Control+End");
  // Up into the block, whose head is above the first line in sight.
  for (let line = 0; line < 5; line += 1) {
    await stage.page.keyboard.press("ArrowUp");
  }
  await until("the heads are above", async () => {
    const lines = await stage.page.locator(".sticky-widget .sticky-line-content").allInnerTexts();
    const shown = spaced(lines.join("\n"));
    return /movement patrol/.test(shown) && /repeat 4 times/.test(shown);
  });
}
