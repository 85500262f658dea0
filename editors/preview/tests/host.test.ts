import assert from "node:assert/strict";
import { test } from "node:test";

import { PreviewHost } from "../host/host";
import { PNG_PREFIX, type ToPage } from "../host/messages";
import { ACTION_LOCATION, PLANNED_AT, PLANNED_PATH, PLANNED_PATH_CHANGED } from "../host/protocol";
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
