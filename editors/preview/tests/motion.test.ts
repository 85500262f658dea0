import assert from "node:assert/strict";
import { test } from "node:test";

import { modelOf } from "../page/model";
import { offsetAt } from "../page/motion";
import { open } from "./plans";

test("an obstacle that moves is where it is at the time", () => {
  const [cart, person] = modelOf(open()).obstacles;
  assert.ok(cart?.motion && person?.motion);
  const { motion } = cart;
  assert.deepEqual([0, 2, 5, 8, 100].map((t) => offsetAt(motion, t).x), [0, 0, 0.5, 1, 1], "it stays at the end");
  const { motion: there } = person;
  assert.deepEqual([1, 3, 4, 5, 9].map((t) => offsetAt(there, t).y), [0, 1, 1.5, 1, 1], "there and back");
});
