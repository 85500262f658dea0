import assert from "node:assert/strict";
import { test } from "node:test";

import { summary } from "../src/figures";
import { figures } from "./figures.sample";

test("a run is summed up in a sentence", () => {
  assert.equal(summary(figures), "yard: 10.1 s (planned: 10.0 s) simulated in 0.6 s, 18 times real time");
  assert.equal(summary({ ...figures, planned: null, wall: 5 }), "yard: 10.1 s simulated in 5.0 s, 2.0 times real time");
});
