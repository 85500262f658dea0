// Runs the tests of api/tests.cjs in the extension host.
import assert from "node:assert/strict";
import { existsSync, readFileSync } from "node:fs";
import os from "node:os";
import path from "node:path";
import { test } from "node:test";

import { Stage, program, until } from "./stage.mjs";

const ROVER = "wheel l with radius 4\nwheel r with radius 4\nrobot rover type tw with port 1 has { l r } wheels\n";
const FILES = {
  "square.pyr": program("examples/square.pyr"),
  "broken.pyr": "wheel w with radius -1\n",
  "unopened.pyr": "wheel w with radius -1\n",
  "unused.pyr": `sensor spare\n${program("examples/square.pyr")}`,
  "misspelt.pyr": `${ROVER}movement m of rovr {\n  move 1 meters\n}\n`,
};

test("the editor's API", async (t) => {
  const out = path.join(os.tmpdir(), `pyr-api-${process.pid}.json`);
  const testsPath = path.join(import.meta.dirname, "api/tests.cjs");
  const prepare = async (page) => {
    await page.exposeFunction("codeAutomationExit", () => undefined);
    await page.exposeFunction("codeAutomationLog", () => undefined);
  };
  await Stage.with({ files: FILES, env: { API_RESULTS: out }, prepare, testsPath }, async () => {
    const results = JSON.parse(await until("the tests have ended", () => existsSync(out) && readFileSync(out, "utf8"), 240_000));
    for (const { name, error } of results) {
      await t.test(name, () => assert.equal(error, undefined, error));
    }
    assert.ok(results.length > 10);
  });
});
