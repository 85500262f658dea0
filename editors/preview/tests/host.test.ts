import assert from "node:assert/strict";
import { test } from "node:test";

import { PreviewHost } from "../host/host";
import { PNG_PREFIX, type ToPage } from "../host/messages";
import { ACTION_LOCATION, DRIVEN_PATH, DRIVEN_PATH_CHANGED, PLANNED_AT, PLANNED_PATH, PLANNED_PATH_CHANGED, type PlannedPath } from "../host/protocol";
import { plan } from "./plans";

const URI = "file:///a.pyr";
const LOCATION = { uri: URI, range: { start: { line: 3, character: 2 }, end: { line: 3, character: 8 } } };
const ANSWERS: Record<string, unknown> = {
  [PLANNED_AT]: { environments: ["yard", "hall"], using: ["yard"], action: null },
  [PLANNED_PATH]: plan(),
  [ACTION_LOCATION]: LOCATION,
};

/** A host of a shown program, with its requests, its messages to the page, and what it did. */
async function hostOfProgram() {
  const requests: string[] = [];
  const asked: unknown[] = [];
  const posted: ToPage[] = [];
  const done: unknown[] = [];
  const request = (method: string, params: unknown) => {
    requests.push(method);
    asked.push(params);
    return Promise.resolve(ANSWERS[method] ?? null);
  };
  const host = new PreviewHost(request, (message) => posted.push(message), {
    reveal: (location) => done.push(location),
    accept: (suggestion, program) => done.push([suggestion, program]),
    export: () => done.push("export"),
  });
  await host.follower.follow(URI, { line: 0, character: 0 });
  return { host, requests, asked, posted, done };
}

test("a click in the page becomes the action's location", async () => {
  const { host, done } = await hostOfProgram();
  await host.received({ type: "reveal", action: { movement: "m", index: 0 } });
  await host.received({ type: "accept", suggestion: "addEnvironment" });
  await host.received({ type: "export" });
  await host.received({ type: "reveal", action: "m 0" });
  assert.deepEqual(done, [LOCATION, ["addEnvironment", URI], "export"]);
});

test("a click on an action of a movement that others do says which statement does it", async () => {
  const { host, asked } = await hostOfProgram();
  const action = { movement: "m", index: 0, calls: [{ movement: "m", index: 2 }] };
  await host.received({ type: "reveal", action });
  assert.deepEqual(asked.at(-1), { uri: URI, environment: "yard", ...action });
  asked.length = 0;
  await host.received({ type: "reveal", action: { ...action, calls: [{ movement: "m" }] } });
  assert.deepEqual(asked, []);
});

test("only the shown environment's path is requested again when paths change", async () => {
  const { host, requests } = await hostOfProgram();
  requests.length = 0;
  await host.notified(PLANNED_PATH_CHANGED, { uri: URI, environment: "hall" });
  await host.notified("window/logMessage", { uri: URI, environment: "yard" });
  assert.deepEqual(requests, []);
  await host.notified(PLANNED_PATH_CHANGED, { uri: URI, environment: "yard" });
  assert.deepEqual(requests, [PLANNED_PATH]);
});

test("the page's picture arrives where it was asked for", async () => {
  const { host, posted } = await hostOfProgram();
  const captured = host.capture();
  assert.deepEqual(posted.at(-1), { type: "capture" });
  await host.received({ type: "captured", png: `${PNG_PREFIX}AA==` });
  assert.equal(await captured, `${PNG_PREFIX}AA==`);
});

const [YARD, HALL] = ["yard", "hall"].map((environment) => ({ uri: URI, environment }));

/** A plan whose only robot is somewhere else at its end. */
function otherPlan(): PlannedPath {
  const { robots, ...rest } = plan();
  return { ...rest, robots: robots.map((robot) => ({ ...robot, poses: [...robot.poses.slice(0, -1), { t: 5, x: 2, y: 3, theta: 0, action: null }] })) };
}

/** A host whose program has been run, and what can be seen of that run. */
async function hostAfterRun() {
  let planned: PlannedPath | Error = plan();
  let driven: unknown = null;
  const posted: ToPage[] = [];
  const request = (method: string) => {
    if (method === DRIVEN_PATH) return Promise.resolve(driven);
    if (method !== PLANNED_PATH) return Promise.resolve(ANSWERS[method] ?? null);
    return planned instanceof Error ? Promise.reject(planned) : Promise.resolve(structuredClone(planned));
  };
  const host = new PreviewHost(request, (message) => posted.push(message), {
    reveal: () => undefined,
    accept: () => undefined,
    export: () => undefined,
  });
  assert.ok(YARD && HALL);
  await host.follower.follow(URI, { line: 0, character: 0 });
  host.clearResult(YARD);
  driven = { environment: "yard", robots: [], planned: plan() };
  await host.notified(DRIVEN_PATH_CHANGED, YARD);
  host.setResult(YARD, "yard: 5.0 s simulated", false, []);
  const edit = async (change: PlannedPath | Error) => {
    planned = change;
    await host.notified(PLANNED_PATH_CHANGED, YARD);
  };
  const result = () => posted.flatMap((message) => (message.type === "result" ? [message.result] : [])).at(-1);
  const isMarked = () => posted.flatMap((message) => (message.type === "path" || message.type === "driven" ? [message.isRunEarlier] : [])).at(-1);
  return { host, edit, result, isMarked };
}

test("a run of the program before it changed is marked as such until the change is undone", async () => {
  const { host, edit, result, isMarked } = await hostAfterRun();
  assert.equal(result()?.isEarlier, false);
  assert.deepEqual([isMarked(), host.isRunEarlier], [false, false]);
  await edit(otherPlan());
  assert.equal(result()?.isEarlier, true);
  assert.deepEqual([isMarked(), host.isRunEarlier], [true, true]);
  await edit(plan());
  assert.equal(result()?.isEarlier, false);
  assert.deepEqual([isMarked(), host.isRunEarlier], [false, false]);
  // The picture stays, and the run belongs to it; the program is another one.
  await edit(new Error("`x` is not a unit"));
  assert.equal(result()?.isEarlier, true);
  assert.deepEqual([isMarked(), host.isRunEarlier], [false, false]);
});

test("a run of a program that is changed meanwhile is marked from the start", async () => {
  const { host, edit, result, isMarked } = await hostAfterRun();
  assert.ok(YARD);
  host.clearResult(YARD);
  assert.equal(result(), null);
  await edit(otherPlan());
  await host.notified(DRIVEN_PATH_CHANGED, YARD);
  host.setResult(YARD, "yard: 5.0 s simulated", false, []);
  assert.equal(result()?.isEarlier, true);
  assert.equal(isMarked(), true);
});

test("that errors prevented a run is said as long as they are there", async () => {
  const { host, edit, result } = await hostAfterRun();
  assert.ok(YARD);
  await edit(new Error("`x` is not a unit"));
  host.clearResult(YARD);
  host.setResult(YARD, "yard cannot run", true, []);
  assert.equal(result()?.isEarlier, false);
  await edit(new Error("`y` is not a unit"));
  assert.equal(result(), null);
  host.clearResult(YARD);
  host.setResult(YARD, "yard cannot run", true, []);
  assert.equal(result()?.isEarlier, false);
  await edit(plan());
  assert.equal(result(), null);
});

test("the result of a run is shown with its environment only", async () => {
  const { host, result } = await hostAfterRun();
  await host.follower.select("hall");
  assert.equal(result(), null);
  await host.follower.select("yard");
  assert.equal(result()?.message, "yard: 5.0 s simulated");
});
