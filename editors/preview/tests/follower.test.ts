import assert from "node:assert/strict";
import { test } from "node:test";

import { Follower } from "../host/follower";
import { fromPage, pageState, type ToPage } from "../host/messages";
import { DRIVEN_PATH, PLANNED_AT, PLANNED_PATH, type PlannedAt } from "../host/protocol";
import { plan } from "./plans";

const TOP = { line: 0, character: 0 };

interface PendingRequest {
  method: string;
  params: object;
  signal: AbortSignal;
  resolve: (value: unknown) => void;
  reject: (message: string) => void;
  fail: (error: Error) => void;
}

/** A follower with its pending requests and the messages that it sent. */
function setUp() {
  const requests: PendingRequest[] = [];
  const shown: ToPage[] = [];
  const follower = new Follower(
    (method, params, signal) =>
      new Promise((resolve, reject) => {
        requests.push({ method, params, signal, resolve, reject: (message) => reject(new Error(message)), fail: reject });
      }),
    (message) => shown.push(message),
  );
  const next = async (method: string): Promise<PendingRequest> => {
    for (let turn = 0; turn < 20; turn += 1) {
      const index = requests.findIndex((request) => request.method === method);
      const [found] = index < 0 ? [] : requests.splice(index, 1);
      if (found) return found;
      await Promise.resolve();
    }
    throw new Error(`${method} was not requested`);
  };
  return { follower, shown, requests, next };
}

function at(using: string[], environments = ["yard", "hall"]): PlannedAt {
  return { environments, using, action: null };
}

async function opened(found: PlannedAt) {
  const made = setUp();
  const following = made.follower.follow("file:///a.pyr", TOP);
  (await made.next(PLANNED_AT)).resolve(found);
  (await made.next(PLANNED_PATH)).resolve(plan());
  (await made.next(DRIVEN_PATH)).resolve(null);
  await following;
  return made;
}

test("a program is shown with the environment at the cursor", async () => {
  const { shown } = await opened(at(["hall"]));
  assert.deepEqual(shown.map(({ type }) => type), ["environments", "path", "driven"]);
  assert.deepEqual(shown[0], { type: "environments", uri: "file:///a.pyr", names: ["yard", "hall"], shown: "hall" });
});

test("a newer request cancels an older one, whose answer is not shown", async () => {
  const { follower, shown, next } = await opened(at(["yard"]));
  shown.length = 0;
  const id = { uri: "file:///a.pyr", environment: "yard" };
  const first = follower.pathChanged(id);
  const older = await next(PLANNED_PATH);
  const second = follower.pathChanged(id);
  const newer = await next(PLANNED_PATH);
  assert.deepEqual([older.signal.aborted, newer.signal.aborted], [true, false]);
  newer.resolve({ ...plan(), duration: 7 });
  older.resolve({ ...plan(), duration: 6 });
  await Promise.all([first, second]);
  assert.deepEqual(shown.map((message) => message.type === "path" && message.path.duration), [7]);
});

test("the failure of an older request is not shown", async () => {
  const { follower, shown, next } = await opened(at(["yard"]));
  shown.length = 0;
  const id = { uri: "file:///a.pyr", environment: "yard" };
  const both = [follower.pathChanged(id), follower.pathChanged(id)];
  const older = await next(PLANNED_PATH);
  older.reject("cancelled");
  (await next(PLANNED_PATH)).resolve(plan());
  await Promise.all(both);
  assert.deepEqual(shown.map(({ type }) => type), ["path"]);
});

test("a problem has its place and its fix", async () => {
  const { follower, shown, requests, next } = await opened(at(["yard"]));
  shown.length = 0;
  const location = { uri: "file:///a.pyr", range: { start: { line: 6, character: 2 }, end: { line: 6, character: 4 } } };
  for (const [message, data] of [["first", { location, fix: "Change to `move`" }], ["second", { location: { ...location, uri: "file:///b%20c.pyr" } }]] as const) {
    const changed = follower.pathChanged({ uri: "file:///a.pyr", environment: "yard" });
    (await next(PLANNED_PATH)).fail(Object.assign(new Error(message), { data }));
    await changed;
    assert.equal(follower.problem, data);
  }
  assert.deepEqual(shown, [
    { type: "problem", uri: "file:///a.pyr", message: "first", place: "line 7", fix: "Change to `move`" },
    { type: "problem", uri: "file:///a.pyr", message: "second", place: "b c.pyr, line 7" },
  ]);
  assert.equal(requests.length, 0);
});

test("a scene leads to its environment, which stays where it is", async () => {
  const { follower, shown, next } = await opened(at(["yard"]));
  const scene = follower.followScene("file:///hall.scene.toml");
  (await next(PLANNED_AT)).resolve({ ...at(["hall"], ["hall"]), program: "file:///a.pyr" });
  (await next(PLANNED_AT)).resolve(at([]));
  (await next(PLANNED_PATH)).resolve(plan());
  (await next(DRIVEN_PATH)).resolve(null);
  await scene;
  assert.equal(follower.shown?.environment, "hall");
  shown.length = 0;
  const again = follower.followScene("file:///hall.scene.toml");
  (await next(PLANNED_AT)).resolve({ ...at(["hall"], ["hall"]), program: "file:///a.pyr" });
  await again;
  assert.deepEqual(shown, []);
});

test("the reason for a missing path is shown", async () => {
  const { follower, shown, next } = await opened(at(["yard"]));
  const requesting = follower.pathChanged({ uri: "file:///a.pyr", environment: "yard" });
  (await next(PLANNED_PATH)).reject("`yard` has errors: there is no movement `go`");
  await requesting;
  assert.deepEqual(shown.at(-1), { type: "problem", uri: "file:///a.pyr", message: "`yard` has errors: there is no movement `go`" });
});

test("a program without an environment is shown as such, with a suggestion", async () => {
  const { follower, shown, next } = await opened(at(["yard"]));
  const following = follower.follow("file:///b.pyr", TOP);
  (await next(PLANNED_AT)).resolve(at([], []));
  await following;
  const problem = {
    type: "problem",
    uri: "file:///b.pyr",
    message: "The program has no environment yet. Add one to see the path.",
    suggestion: "addEnvironment",
  };
  assert.deepEqual(shown.slice(-2), [{ type: "environments", uri: "file:///b.pyr", names: [], shown: null }, problem]);
  await follower.resend();
  assert.deepEqual(shown.at(-1), problem, "also after the page was reloaded");
});

test("a run is new only when it has just ended", async () => {
  const { follower, shown, next } = await opened(at(["yard"]));
  const id = { uri: "file:///a.pyr", environment: "yard" };
  const driven = { environment: "yard", robots: [] };
  const sending = follower.drivenChanged(id);
  (await next(DRIVEN_PATH)).resolve(driven);
  await sending;
  assert.deepEqual(shown.at(-1), { type: "driven", ...id, driven, isNew: true });
  const again = follower.resend();
  (await next(PLANNED_PATH)).resolve(plan());
  (await next(DRIVEN_PATH)).resolve(driven);
  await again;
  assert.deepEqual(shown.at(-1), { type: "driven", ...id, driven, isNew: false });
});

test("changes of other environments and programs are ignored", async () => {
  const { follower, requests } = await opened(at(["yard"]));
  await follower.pathChanged({ uri: "file:///a.pyr", environment: "hall" });
  await follower.drivenChanged({ uri: "file:///b.pyr", environment: "yard" });
  assert.equal(requests.length, 0);
});

test("the environment switches only if the cursor is in something that it does not use", async () => {
  const { follower, shown, next, requests } = await opened(at(["yard"]));
  const still = follower.update(TOP, true);
  (await next(PLANNED_AT)).resolve(at(["hall", "yard"]));
  await still;
  assert.equal(requests.length, 0);
  void follower.update(TOP, true);
  (await next(PLANNED_AT)).resolve(at(["hall"]));
  assert.deepEqual((await next(PLANNED_PATH)).params, { uri: "file:///a.pyr", environment: "hall" });
  assert.deepEqual(shown.at(-1), { type: "environments", uri: "file:///a.pyr", names: ["yard", "hall"], shown: "hall" });
});

test("a renamed environment is still shown", async () => {
  const { follower, next } = await opened(at(["yard"], ["yard"]));
  void follower.update(TOP);
  (await next(PLANNED_AT)).resolve(at(["yards"], ["yards"]));
  assert.deepEqual((await next(PLANNED_PATH)).params, { uri: "file:///a.pyr", environment: "yards" });
});

test("the action at the cursor is sent once", async () => {
  const { follower, shown, next } = await opened(at(["yard"]));
  const action = { movement: "go", index: 2, last: 4 };
  for (let turn = 0; turn < 2; turn += 1) {
    const updating = follower.update(TOP);
    (await next(PLANNED_AT)).resolve({ ...at(["yard"]), action });
    await updating;
  }
  assert.deepEqual(shown.filter(({ type }) => type === "cursor"), [{ type: "cursor", action }]);
});

test("a new page gets everything", async () => {
  const { follower, shown, next } = await opened(at(["yard"]));
  shown.length = 0;
  const sending = follower.resend();
  (await next(PLANNED_PATH)).resolve(plan());
  (await next(DRIVEN_PATH)).resolve({ environment: "yard", robots: [] });
  await sending;
  assert.deepEqual(shown.map(({ type }) => type), ["environments", "cursor", "path", "driven"]);
});

test("without a program the page says what to do", async () => {
  const { follower, shown } = setUp();
  await follower.resend();
  assert.equal(shown[0]?.type, "problem");
});

test("invalid messages from the page are ignored", () => {
  assert.deepEqual(fromPage({ type: "reveal", action: { movement: "go", index: 1 } }), { type: "reveal", action: { movement: "go", index: 1 } });
  for (const invalid of [null, 7, "ready", {}, { type: "select" }, { type: "reveal", action: { movement: 1, index: 0 } }, { type: "reveal", action: { movement: "a", index: 0.5 } }, { type: "accept", suggestion: "rm" }, { type: "captured", png: "file:///etc/passwd" }]) {
    assert.equal(fromPage(invalid), undefined);
  }
});

test("invalid parts of the page's state are dropped", () => {
  assert.deepEqual(pageState({ uri: "file:///a.pyr", environment: 3, hidden: ["a", 1], speed: -1, time: Number.NaN }), { uri: "file:///a.pyr", hidden: ["a"] });
  assert.deepEqual(pageState("nonsense"), {});
});
