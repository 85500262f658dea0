import assert from "node:assert/strict";
import { test } from "node:test";

import { Highlights } from "../page/highlights";
import { modelOf } from "../page/model";
import { open } from "./plans";

test("a clicked round stays selected while the cursor is at its statement", () => {
  const { robots } = modelOf(open());
  const highlights = new Highlights();
  const indices = (): number[] => highlights.all.map(({ leg }) => leg.action.index);
  const block = { movement: "go", index: 0, last: 5 };
  highlights.setCursor(block, robots);
  assert.deepEqual(indices(), [1, 3, 4, 5], "all legs of the block");
  highlights.setCursor({ movement: "go", index: 2, last: 5 }, robots);
  assert.deepEqual(indices(), [3, 4, 5], "both branches");
  const [robot] = robots;
  const leg = robot?.ways[1]?.legs[1];
  assert.ok(robot && leg);
  highlights.selected = { robot, leg };
  highlights.setCursor({ movement: "go", index: 5 }, robots);
  assert.deepEqual([highlights.selected.leg, indices()], [leg, [5]]);
  highlights.setCursor(block, robots);
  assert.equal(highlights.selected, undefined);
  assert.deepEqual(indices(), [1, 3, 4, 5]);
});
