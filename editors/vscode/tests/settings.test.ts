import assert from "node:assert/strict";
import { test } from "node:test";

import { explicitSettings, explicitValue } from "../src/settings";

test("settings without a value are left out, so that a pydslrep.toml applies", () => {
  const inspect = (key: string) => (key === "target" ? { workspaceValue: "vrep" } : {});
  assert.deepEqual(explicitSettings(["target", "generateOnSave", "inlayHints.pose"], inspect), { target: "vrep" });
});

test("keys with dots become tables", () => {
  const inspect = (key: string) => ({ globalValue: key.endsWith("pose") });
  const keys = ["inlayHints.pose", "inlayHints.duration"];
  assert.deepEqual(explicitSettings(keys, inspect), { inlayHints: { pose: true, duration: false } });
});

test("the narrower scope wins, and tables are merged", () => {
  assert.equal(explicitValue({ globalValue: 9, workspaceValue: 12, workspaceFolderValue: 5 }), 5);
  assert.deepEqual(explicitValue({ globalValue: { a: "off", b: "hint" }, workspaceValue: { b: "error" } }), { a: "off", b: "error" });
});

test("a text that was deleted in the settings editor is left out", () => {
  assert.equal(explicitValue({ globalValue: "" }), undefined);
  assert.equal(explicitValue({ globalValue: "scripts", workspaceValue: "" }), "scripts");
  assert.equal(explicitValue({ globalValue: false }), false);
});
