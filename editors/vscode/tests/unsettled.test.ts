import assert from "node:assert/strict";
import { test } from "node:test";

import { isUnsettled, settled, TypedLines } from "../src/unsettled";

const missing = { message: "missing `meters`", data: { typedLine: 3 } };
const other = { message: "there is no robot called `rovr`" };

test("what the next word will settle is shown once its line is left", () => {
  assert.deepEqual([missing, other].map(isUnsettled), [true, false]);
  assert.deepEqual(settled([missing, other], new Set([3])), [other]);
  assert.deepEqual(settled([missing, other], new Set([4])), [missing, other]);
  assert.deepEqual(settled([missing, other], new Set()), [missing, other]);
});

test("a diagnostic with other data is shown", () => {
  const others = [{ data: null }, { data: "3" }, { data: { typedLine: "3" } }, {}];
  assert.deepEqual(settled(others, new Set([3])), others);
});

test("a line is being typed from a change until the cursor goes to another line", () => {
  const typed = new TypedLines();
  typed.moved([3]);
  assert.deepEqual([...typed.lines], []);
  typed.changed();
  typed.moved([3]);
  assert.deepEqual([...typed.lines], [3]);
  // Enter changes the text, then moves the cursor.
  typed.changed();
  typed.moved([4]);
  assert.deepEqual([...typed.lines], [4]);
  typed.moved([4]);
  assert.deepEqual([...typed.lines], [4]);
  typed.moved([3]);
  assert.deepEqual([...typed.lines], []);
  typed.moved([4]);
  assert.deepEqual([...typed.lines], []);
});

test("a saved line counts as finished", () => {
  const typed = new TypedLines();
  typed.changed();
  typed.moved([3]);
  typed.left();
  assert.deepEqual([...typed.lines], []);
});
