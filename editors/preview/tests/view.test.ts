import assert from "node:assert/strict";
import { test } from "node:test";

import { hitTest, distanceToSegment } from "../page/hit";
import { modelOf } from "../page/model";
import { niceStep, ticks, View } from "../page/view";
import { large, open, plan } from "./plans";

function view(): View {
  const made = new View();
  made.width = 800;
  made.height = 600;
  return made;
}

test("a fitted rectangle is visible; a larger scale would cut it off", () => {
  const made = view();
  const bounds = { left: -3, bottom: 2, right: 5, top: 4 };
  made.fit(bounds);
  assert.ok(made.isGoodFit(bounds));
  assert.ok(made.toX(-3) >= 20 && made.toX(5) <= 780);
  made.zoom(1.2);
  assert.ok(!made.isGoodFit(bounds), "it is cut off");
  made.fit(bounds);
  made.zoom(0.4);
  assert.ok(!made.isGoodFit(bounds), "it is too small");
});

test("y points up, and pixels convert back to metres", () => {
  const made = view();
  made.fit({ left: 0, bottom: 0, right: 1, top: 1 });
  assert.ok(made.toY(1) < made.toY(0));
  assert.ok(Math.abs(made.fromX(made.toX(0.3)) - 0.3) < 1e-12);
  assert.ok(Math.abs(made.fromY(made.toY(0.7)) - 0.7) < 1e-12);
});

test("zooming keeps the point under the pointer, and is limited", () => {
  const made = view();
  const [x, y] = [made.fromX(100), made.fromY(500)];
  made.zoom(3, 100, 500);
  assert.ok(Math.abs(made.fromX(100) - x) < 1e-9 && Math.abs(made.fromY(500) - y) < 1e-9);
  for (let turn = 0; turn < 100; turn += 1) made.zoom(10);
  assert.equal(made.scale, 20_000);
  for (let turn = 0; turn < 100; turn += 1) made.zoom(0.1);
  assert.equal(made.scale, 0.5);
});

test("grid lines are at round numbers, far enough apart for labels", () => {
  assert.deepEqual([0.011, 0.02, 0.3, 0.7, 1, 30].map(niceStep), [0.02, 0.02, 0.5, 1, 1, 50]);
  assert.deepEqual(ticks(-0.6, 1, 0.5).map((tick) => tick + 0), [-0.5, 0, 0.5, 1]);
  assert.equal(ticks(0, 1e9, 1).length, 400);
  assert.deepEqual(ticks(2.1, 2.4, 1), []);
});

test("the nearest leg is hit; at a joint, the turn", () => {
  const made = view();
  made.fit({ left: 0, bottom: 0, right: 2, top: 1 });
  const { robots } = modelOf(plan());
  const at = (x: number, y: number, dx = 0, dy = 0): number | undefined =>
    hitTest(robots, made, made.toX(x) + dx, made.toY(y) + dy)?.leg.action.index;
  assert.equal(at(1, 0), 0);
  assert.equal(at(1, 0, 0, 6), 0);
  assert.equal(at(1, 0, 0, 8), undefined);
  assert.equal(at(2, 0), 1);
  assert.equal(at(2, 0.5), 2);
  assert.equal(hitTest([], made, 1, 1), undefined);
  assert.equal(distanceToSegment(3, 4, 0, 0, 0, 0), 5);
});

test("a click finds what is possible", () => {
  const { robots } = modelOf(open());
  const view = new View();
  const at = (x: number, y: number): number | undefined => hitTest(robots, view, view.toX(x), view.toY(y))?.leg.action.index;
  assert.deepEqual([at(1, 0), at(4, 0), at(2, 2), at(3, 2)], [1, 3, 5, undefined]);
});

test("one of many legs is hit", () => {
  const made = view();
  const { robots } = modelOf(large(4, 200));
  made.fit({ left: 0, bottom: 0, right: 20, top: 4 });
  const hit = hitTest(robots, made, made.toX(12.35), made.toY(2));
  assert.deepEqual([hit?.robot.name, hit?.leg.action.index], ["robot 2", 123]);
});
