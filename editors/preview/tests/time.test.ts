import assert from "node:assert/strict";
import { test } from "node:test";

import { degrees } from "../page/format";
import { countUpTo, poseAt, trackOf, turnBetween } from "../page/time";

const track = trackOf([
  { t: 0, x: 0, y: 0, theta: 0 },
  { t: 2, x: 4, y: 1, theta: 3 },
  { t: 2, x: 4, y: 1, theta: -3 },
  { t: 4, x: 4, y: 3, theta: -3 },
]);

test("poses are interpolated in time", () => {
  assert.deepEqual(poseAt(track, 1), { x: 2, y: 0.5, theta: 1.5 });
  assert.deepEqual(poseAt(track, 3), { x: 4, y: 2, theta: -3 });
});

test("the first and the last pose hold before and after the track", () => {
  assert.deepEqual(poseAt(track, -1), { x: 0, y: 0, theta: 0 });
  assert.deepEqual(poseAt(track, 9), { x: 4, y: 3, theta: -3 });
  assert.equal(poseAt(trackOf([]), 1), undefined);
});

test("of two poses at the same time the later one holds", () => {
  assert.equal(poseAt(track, 2)?.theta, -3);
});

test("a heading has one sign for 180", () => {
  assert.deepEqual([-Math.PI, -3.14159, Math.PI, -0.0001, -0.5].map(degrees), ["180°", "180°", "180°", "0°", "-28.6°"]);
});

test("a turn is the shorter one", () => {
  assert.ok(Math.abs(turnBetween(3, -3) - (2 * Math.PI - 6)) < 1e-12);
  assert.ok(Math.abs(turnBetween(-3, 3) + (2 * Math.PI - 6)) < 1e-12);
  assert.ok(Math.abs(turnBetween(0, 7) - (7 - 2 * Math.PI)) < 1e-12);
});

test("a time is found by binary search", () => {
  let lookups = 0;
  const times = new Proxy(Float64Array.from({ length: 1 << 14 }, (_, index) => index), {
    get: (target, name) => {
      if (typeof name === "string" && /^\d+$/.test(name)) lookups += 1;
      return Reflect.get(target, name) as unknown;
    },
  });
  assert.equal(countUpTo(times, 5000.5), 5001);
  assert.ok(lookups <= 15, `${lookups} lookups`);
  assert.equal(countUpTo(times, -1), 0);
  assert.equal(countUpTo(times, 1 << 20), 1 << 14);
});
