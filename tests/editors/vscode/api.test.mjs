// Runs the tests of api/tests.cjs in the extension host.
import assert from "node:assert/strict";
import { test } from "node:test";

import { Stage, program } from "./stage.mjs";

const ROVER = "wheel l with radius 4\nwheel r with radius 4\nrobot rover type tw with port 1 has { l r } wheels\n";
const FILES = {
  "square.pyr": program("examples/square.pyr"),
  "broken.pyr": "wheel w with radius -1\n",
  "unopened.pyr": "wheel w with radius -1\n",
  "unused.pyr": `sensor spare\n${program("examples/square.pyr")}`,
  "misspelt.pyr": `${ROVER}movement m of rovr {\n  move 1 meters\n}\n`,
};

test("the editor's API", async (t) => {
  await Stage.withApi({ files: FILES }, "tests.cjs", async (_, results) => {
    for (const { name, error } of results) {
      await t.test(name, () => assert.equal(error, undefined, error));
    }
    assert.ok(results.length > 10);
  });
});
