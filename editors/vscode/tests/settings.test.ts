import assert from "node:assert/strict";
import { test } from "node:test";

import { setTable, setValue } from "../src/settings";

test("what nobody has set is not told, so that a pydslrep.toml counts", () => {
  const inspect = (key: string) => (key === "target" ? { workspaceValue: "vrep" } : {});
  assert.deepEqual(setTable(["target", "generateOnSave", "inlayHints.pose"], inspect), { target: "vrep" });
});

test("keys with dots become tables", () => {
  const inspect = (key: string) => ({ globalValue: key.endsWith("pose") });
  const keys = ["inlayHints.pose", "inlayHints.duration"];
  assert.deepEqual(setTable(keys, inspect), { inlayHints: { pose: true, duration: false } });
});

test("the narrower place wins, and tables are put together", () => {
  assert.equal(setValue({ globalValue: 9, workspaceValue: 12, workspaceFolderValue: 5 }), 5);
  assert.deepEqual(setValue({ globalValue: { a: "off", b: "hint" }, workspaceValue: { b: "error" } }), { a: "off", b: "error" });
});

test("a text that was deleted in the settings editor is not told", () => {
  assert.equal(setValue({ globalValue: "" }), undefined);
  assert.equal(setValue({ globalValue: "scripts", workspaceValue: "" }), "scripts");
  assert.equal(setValue({ globalValue: false }), false);
});
