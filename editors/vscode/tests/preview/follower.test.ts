import assert from "node:assert/strict";
import { test } from "node:test";

import { Follower } from "../../src/preview/follower";
import { fromPage, pageState, type ToPage } from "../../src/preview/messages";
import { page } from "../../src/preview/page";
import { DRIVEN_PATH, PLANNED_AT, PLANNED_PATH, type PlannedAt } from "../../src/preview/protocol";
import { plan } from "./plans";

const TOP = { line: 0, character: 0 };

interface Question {
  method: string;
  params: object;
  signal: AbortSignal;
  answer: (value: unknown) => void;
  refuse: (words: string) => void;
}

/** A follower, the questions that wait for an answer, and what it showed. */
function desk() {
  const questions: Question[] = [];
  const shown: ToPage[] = [];
  const follower = new Follower(
    (method, params, signal) =>
      new Promise((answer, reject) => {
        questions.push({ method, params, signal, answer, refuse: (words) => reject(new Error(words)) });
      }),
    (message) => shown.push(message),
  );
  const next = async (method: string): Promise<Question> => {
    for (let turn = 0; turn < 20; turn += 1) {
      const index = questions.findIndex((question) => question.method === method);
      const [found] = index < 0 ? [] : questions.splice(index, 1);
      if (found) return found;
      await Promise.resolve();
    }
    throw new Error(`${method} is not asked`);
  };
  return { follower, shown, questions, next };
}

function at(using: string[], environments = ["yard", "hall"]): PlannedAt {
  return { environments, using, action: null };
}

async function opened(found: PlannedAt) {
  const made = desk();
  const following = made.follower.follow("file:///a.pyr", TOP);
  (await made.next(PLANNED_AT)).answer(found);
  (await made.next(PLANNED_PATH)).answer(plan());
  (await made.next(DRIVEN_PATH)).answer(null);
  await following;
  return made;
}

test("a program is shown with the environment at the cursor", async () => {
  const { shown } = await opened(at(["hall"]));
  assert.deepEqual(shown.map(({ type }) => type), ["environments", "path", "driven"]);
  assert.deepEqual(shown[0], { type: "environments", uri: "file:///a.pyr", names: ["yard", "hall"], shown: "hall" });
});

test("a newer question takes an older one back, and its answer is not shown", async () => {
  const { follower, shown, next } = await opened(at(["yard"]));
  shown.length = 0;
  const which = { uri: "file:///a.pyr", environment: "yard" };
  const first = follower.pathChanged(which);
  const older = await next(PLANNED_PATH);
  const second = follower.pathChanged(which);
  const newer = await next(PLANNED_PATH);
  assert.deepEqual([older.signal.aborted, newer.signal.aborted], [true, false]);
  newer.answer({ ...plan(), duration: 7 });
  older.answer({ ...plan(), duration: 6 });
  await Promise.all([first, second]);
  assert.deepEqual(shown.map((message) => message.type === "path" && message.path.duration), [7]);
});

test("an older question that is refused is not told", async () => {
  const { follower, shown, next } = await opened(at(["yard"]));
  shown.length = 0;
  const which = { uri: "file:///a.pyr", environment: "yard" };
  const both = [follower.pathChanged(which), follower.pathChanged(which)];
  const older = await next(PLANNED_PATH);
  older.refuse("cancelled");
  (await next(PLANNED_PATH)).answer(plan());
  await Promise.all(both);
  assert.deepEqual(shown.map(({ type }) => type), ["path"]);
});

test("why there is no path is told", async () => {
  const { follower, shown, next } = await opened(at(["yard"]));
  const asking = follower.pathChanged({ uri: "file:///a.pyr", environment: "yard" });
  (await next(PLANNED_PATH)).refuse("`yard` has errors: there is no movement `go`");
  await asking;
  assert.deepEqual(shown.at(-1), { type: "trouble", uri: "file:///a.pyr", sentence: "`yard` has errors: there is no movement `go`" });
});

test("a program without environment is told as that program's, with what helps", async () => {
  const { follower, shown, next } = await opened(at(["yard"]));
  const following = follower.follow("file:///b.pyr", TOP);
  (await next(PLANNED_AT)).answer(at([], []));
  await following;
  const trouble = {
    type: "trouble",
    uri: "file:///b.pyr",
    sentence: "The program has no environment yet. Add one to see the path.",
    remedy: "addEnvironment",
  };
  assert.deepEqual(shown.slice(-2), [{ type: "environments", uri: "file:///b.pyr", names: [], shown: null }, trouble]);
  await follower.again();
  assert.deepEqual(shown.at(-1), trouble, "also to a page that was loaded again");
});

test("a run that has just ended is told as new, one that is told again is not", async () => {
  const { follower, shown, next } = await opened(at(["yard"]));
  const which = { uri: "file:///a.pyr", environment: "yard" };
  const driven = { environment: "yard", robots: [] };
  const telling = follower.drivenChanged(which);
  (await next(DRIVEN_PATH)).answer(driven);
  await telling;
  assert.deepEqual(shown.at(-1), { type: "driven", ...which, driven, isNew: true });
  const again = follower.again();
  (await next(PLANNED_PATH)).answer(plan());
  (await next(DRIVEN_PATH)).answer(driven);
  await again;
  assert.deepEqual(shown.at(-1), { type: "driven", ...which, driven, isNew: false });
});

test("paths of other environments and programs do not matter", async () => {
  const { follower, questions } = await opened(at(["yard"]));
  await follower.pathChanged({ uri: "file:///a.pyr", environment: "hall" });
  await follower.drivenChanged({ uri: "file:///b.pyr", environment: "yard" });
  assert.equal(questions.length, 0);
});

test("what both environments use moves nothing; what only the other uses does", async () => {
  const { follower, shown, next, questions } = await opened(at(["yard"]));
  const still = follower.look(TOP, true);
  (await next(PLANNED_AT)).answer(at(["hall", "yard"]));
  await still;
  assert.equal(questions.length, 0);
  void follower.look(TOP, true);
  (await next(PLANNED_AT)).answer(at(["hall"]));
  assert.deepEqual((await next(PLANNED_PATH)).params, { uri: "file:///a.pyr", environment: "hall" });
  assert.deepEqual(shown.at(-1), { type: "environments", uri: "file:///a.pyr", names: ["yard", "hall"], shown: "hall" });
});

test("an environment that gets another name is still shown", async () => {
  const { follower, next } = await opened(at(["yard"], ["yard"]));
  void follower.look(TOP);
  (await next(PLANNED_AT)).answer(at(["yards"], ["yards"]));
  assert.deepEqual((await next(PLANNED_PATH)).params, { uri: "file:///a.pyr", environment: "yards" });
});

test("the action at the cursor is told once", async () => {
  const { follower, shown, next } = await opened(at(["yard"]));
  const action = { movement: "go", index: 2 };
  for (let turn = 0; turn < 2; turn += 1) {
    const looking = follower.look(TOP);
    (await next(PLANNED_AT)).answer({ ...at(["yard"]), action });
    await looking;
  }
  assert.deepEqual(shown.filter(({ type }) => type === "cursor"), [{ type: "cursor", action }]);
});

test("a page that knows nothing is told everything", async () => {
  const { follower, shown, next } = await opened(at(["yard"]));
  shown.length = 0;
  const telling = follower.again();
  (await next(PLANNED_PATH)).answer(plan());
  (await next(DRIVEN_PATH)).answer({ environment: "yard", robots: [] });
  await telling;
  assert.deepEqual(shown.map(({ type }) => type), ["environments", "cursor", "path", "driven"]);
});

test("before there is a program a page says what to do", async () => {
  const { follower, shown } = desk();
  await follower.again();
  assert.equal(shown[0]?.type, "trouble");
});

test("messages from the page are read, whatever they are", () => {
  assert.deepEqual(fromPage({ type: "reveal", action: { movement: "go", index: 1 } }), { type: "reveal", action: { movement: "go", index: 1 } });
  for (const nonsense of [null, 7, "ready", {}, { type: "choose" }, { type: "reveal", action: { movement: 1, index: 0 } }, { type: "reveal", action: { movement: "a", index: 0.5 } }, { type: "remedy", remedy: "rm" }, { type: "picture", data: "file:///etc/passwd" }]) {
    assert.equal(fromPage(nonsense), undefined);
  }
});

test("what a page remembers is read, whatever it is", () => {
  assert.deepEqual(pageState({ uri: "file:///a.pyr", environment: 3, hidden: ["a", 1], speed: -1, time: Number.NaN }), { uri: "file:///a.pyr", hidden: ["a"] });
  assert.deepEqual(pageState("nonsense"), {});
});

test("only our script runs in the page", () => {
  const html = page({ source: "https://x.test", script: "https://x.test/a.js", style: "https://x.test/a.css", nonce: "n0" });
  assert.match(html, /default-src 'none'; style-src https:\/\/x\.test; script-src 'nonce-n0';/);
  assert.deepEqual(html.match(/<script[^>]*>/g), ['<script nonce="n0" src="https://x.test/a.js">']);
  assert.doesNotMatch(html, /unsafe|style=/);
});
