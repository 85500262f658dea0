import assert from "node:assert/strict";
import { test } from "node:test";

import { filterTexts } from "../src/filter_texts";

test("a word disappears from the list with its last letter", () => {
  assert.deepEqual(filterTexts(["wheelL", "wheelR", "x"]), ["wheel", "wheel", " "]);
});

test("a word that others continue stays in the list, and only its own filter is the whole word", () => {
  assert.deepEqual(filterTexts(["a", "ab", "abc", "a2"]), ["a", "ab", "abc", "a2"]);
  assert.deepEqual(filterTexts(["wheelL", "wheelL21"]), ["wheelL", "wheelL2"]);
  assert.deepEqual(filterTexts(["fR", "frontRight"]), ["fR", "frontRigh"]);
});

test("the same word twice does not continue itself", () => {
  assert.deepEqual(filterTexts(["move", "move", "slam"]), ["mov", "mov", "sla"]);
});
