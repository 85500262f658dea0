import assert from "node:assert/strict";
import { test } from "node:test";

import { begun, poseAt, trackOf, turnBetween } from "../../webview/preview/time";

const track = trackOf([
  { t: 0, x: 0, y: 0, theta: 0 },
  { t: 2, x: 4, y: 1, theta: 3 },
  { t: 2, x: 4, y: 1, theta: -3 },
  { t: 4, x: 4, y: 3, theta: -3 },
]);

test("a pose between two is between them in time", () => {
  assert.deepEqual(poseAt(track, 1), { x: 2, y: 0.5, theta: 1.5 });
  assert.deepEqual(poseAt(track, 3), { x: 4, y: 2, theta: -3 });
});

test("before the first and behind the last nothing moves", () => {
  assert.deepEqual(poseAt(track, -1), { x: 0, y: 0, theta: 0 });
  assert.deepEqual(poseAt(track, 9), { x: 4, y: 3, theta: -3 });
  assert.equal(poseAt(trackOf([]), 1), undefined);
});

test("of two poses at one time the later counts", () => {
  assert.equal(poseAt(track, 2)?.theta, -3);
});

test("headings go the shorter way around", () => {
  assert.ok(Math.abs(turnBetween(3, -3) - (2 * Math.PI - 6)) < 1e-12);
  assert.ok(Math.abs(turnBetween(-3, 3) + (2 * Math.PI - 6)) < 1e-12);
  assert.ok(Math.abs(turnBetween(0, 7) - (7 - 2 * Math.PI)) < 1e-12);
});

test("a time is found in as many looks as its index has digits", () => {
  let looks = 0;
  const times = new Proxy(Float64Array.from({ length: 1 << 14 }, (_, index) => index), {
    get: (target, name) => {
      if (typeof name === "string" && /^\d+$/.test(name)) looks += 1;
      return Reflect.get(target, name) as unknown;
    },
  });
  assert.equal(begun(times, 5000.5), 5001);
  assert.ok(looks <= 15, `${looks} looks`);
  assert.equal(begun(times, -1), 0);
  assert.equal(begun(times, 1 << 20), 1 << 14);
});
