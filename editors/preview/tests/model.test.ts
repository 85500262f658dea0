import assert from "node:assert/strict";
import { test } from "node:test";

import { describeAction, describePlace } from "../page/descriptions";
import { boundsOf, deviation, drivenOf, isLegOf, isStatementOf, type Leg, modelOf, possibleEnds } from "../page/model";
import { poseAt } from "../page/time";
import { open, plan } from "./plans";

test("a robot waits until its next action begins", () => {
  const [rover] = modelOf(plan()).robots;
  assert.ok(rover);
  assert.deepEqual(poseAt(rover.track, 2.9), { x: 2, y: 0, theta: 0 });
  assert.equal(poseAt(rover.track, 3.25)?.theta, Math.PI / 8);
});

test("legs have a first and a last pose, and may be turns", () => {
  const [rover] = modelOf(plan()).robots;
  assert.deepEqual(rover?.legs.map(({ first, last, isTurn }) => [first, last, isTurn]), [
    [0, 2, false],
    [2, 4, true],
    [4, 6, false],
  ]);
  assert.deepEqual(rover.legs.map((leg) => isLegOf(leg, { movement: "go", index: 1 })), [false, true, false]);
  assert.ok(!rover.legs.some((leg) => isLegOf(leg, { movement: "stay", index: 1 }) || isLegOf(leg, null)));
});

test("a full circle is not a turn on the spot", () => {
  const path = plan();
  const [circle] = path.robots;
  assert.ok(circle);
  circle.poses = [0, 1, 2, 3, 4].map((t) => ({ t, x: Math.sin((t * Math.PI) / 2), y: 1 - Math.cos((t * Math.PI) / 2), theta: (t * Math.PI) / 2, action: null }));
  circle.legs = [{ action: { movement: "go", index: 0, text: "turn left 360 with radius 1 meters" }, start: 0, duration: 4, last: 4 }];
  assert.equal(modelOf(path).robots[0]?.legs[0]?.isTurn, false);
});

/** A leg of `side`, which the second statement of `go` does in a loop. */
function done(): Leg {
  const pose = { x: 0, y: 0, theta: 0 };
  const action = { movement: "go", index: 0, text: "move 1 meters", calls: [{ movement: "go", index: 1 }], done: "side" };
  return { action, start: 0, duration: 1, line: new Float64Array(4), first: 0, last: 1, from: pose, to: pose, isTurn: false, isPossible: false };
}

test("a leg belongs to its statement and to those that do its movement", () => {
  const at = (movement: string, index: number): boolean => isLegOf(done(), { movement, index });
  assert.deepEqual([at("side", 0), at("go", 1), at("go", 0), at("side", 1)], [true, true, false, false]);
});

test("a statement with blocks has the legs of those inside, and of what these do", () => {
  const has = (movement: string, index: number, last: number): boolean => isLegOf(done(), { movement, index, last });
  assert.deepEqual([has("go", 0, 1), has("go", 1, 4), has("go", 2, 4), has("side", 0, 0)], [true, true, false, true]);
  assert.deepEqual([isStatementOf(done(), { movement: "side", index: 0 }), isStatementOf(done(), { movement: "go", index: 1 })], [true, false]);
});

test("an action says its movement, its rounds and who does it", () => {
  const { action } = done();
  assert.equal(describePlace({ ...action, rounds: [2, 1], counts: [3, 4] }), "side, action 1 in rounds 2, 1, done by go");
  assert.equal(describePlace({ ...action, rounds: [3], counts: [4] }), "side, action 1 in round 3 of 4, done by go");
  assert.equal(describePlace({ movement: "go", index: 1, text: "turn left" }), "go, action 2");
});

test("after an action of unknown duration there is a line without times", () => {
  const path = plan();
  path.duration = null;
  const [rover] = path.robots;
  assert.ok(rover);
  for (const pose of rover.poses.slice(3)) pose.t = null;
  for (const leg of rover.legs.slice(1)) leg.start = null;
  const model = modelOf(path);
  assert.equal(model.duration, 2);
  assert.equal(model.isComplete, false);
  assert.equal(model.robots[0]?.line.length, 14);
  assert.deepEqual(poseAt(model.robots[0].track, 100), { x: 2, y: 0, theta: 0 });
});

test("what is possible is beside the path, not in it", () => {
  const model = modelOf(open());
  const [rover] = model.robots;
  assert.ok(rover);
  assert.deepEqual(rover.legs.map(({ isPossible }) => isPossible), [false]);
  assert.deepEqual(rover.allLegs.map(({ action, isPossible }) => [action.index, isPossible]), [[1, false], [3, true], [4, true], [5, true]]);
  assert.deepEqual([rover.end, model.duration, model.isComplete], [{ t: 2, x: 2, y: 0, theta: 0, action: null }, 8, false]);
  assert.deepEqual(possibleEnds(rover).map(({ x, y }) => [x, y]), [[5, 0], [2, 3]]);
  const { right, top } = boundsOf(model, undefined);
  assert.deepEqual([right, top], [9, 3.25], "the picture contains all of it");
  const facts = rover.ways[0]?.legs.map((leg) => describeAction({ robot: rover, leg }))[0];
  assert.deepEqual(facts, ["move 3 meters until { front } detect", "rover · go, action 4 in round 1 of 4", "possible, sensors decide: takes up to 3.0 s", "may end at (5.00, 0.00) m, 0°"]);
});

test("collisions of unknown robots are dropped", () => {
  const { collisions } = modelOf(plan());
  assert.deepEqual(collisions.map(({ robot, other, t }) => [robot.name, other, t]), [["rover", "pole", 1]]);
});

test("the bounds include robots, obstacles and driven paths", () => {
  const model = modelOf(plan());
  const { left, bottom, right, top } = boundsOf(model, undefined);
  assert.deepEqual([left, bottom, right, top], [-1, -2, 4.5, 1.5]);
  const poses = [{ t: 0, x: -7, y: 0, theta: 0 }];
  const driven = drivenOf({ environment: "yard", robots: [{ name: "rover", poses, map: { nodes: [], edges: [] } }], planned: null });
  assert.equal(boundsOf(model, driven).left, -7.25);
  const empty = modelOf({ ...plan(), robots: [], obstacles: [] });
  assert.deepEqual(boundsOf(empty, undefined), { left: -1, bottom: -1, right: 1, top: 1 });
});

test("the deviation of a driven end is a distance and the shorter angle", () => {
  const off = deviation({ x: 0, y: 0, theta: 3.1 }, { x: 3, y: 4, theta: -3.1 });
  assert.equal(off.distance, 5);
  assert.ok(Math.abs(off.angle - (2 * Math.PI - 6.2)) < 1e-9);
});
