import assert from "node:assert/strict";
import { test } from "node:test";

import { failureOf } from "../src/failure";
import { sentence } from "../../preview/host/sentence";

const answered = (code: number, message: string, data?: unknown) => Object.assign(new Error(message), { code, data });
const location = { uri: "file:///a.pyr", range: { start: { line: 3, character: 2 }, end: { line: 3, character: 8 } } };

test("the data of the error says what the user can do", () => {
  assert.deepEqual(failureOf(answered(-32803, "`yard` has errors: no", { reason: "errors", location })), {
    kind: "errors",
    message: "`yard` has errors: no.",
    location,
  });
  assert.deepEqual(failureOf(answered(-32803, "save it", { reason: "unsaved" })), { kind: "unsaved", message: "Save it." });
  assert.equal(failureOf(answered(-32803, "no", { reason: "errors", location: null })).kind, "errors");
});

test("a run that failed says where", () => {
  const message = "robot rover, movement trip, action 2: no progress for 5 s (a.pyr, line 4)";
  assert.deepEqual(failureOf(answered(-32803, message, { reason: "failed-run", location })), {
    kind: "run",
    message: `R${message.slice(1)}.`,
    location,
  });
});

test("cancelled requests and lost connections are told apart from failures", () => {
  assert.equal(failureOf(answered(-32800, "the run was cancelled")).kind, "cancelled");
  assert.equal(failureOf(answered(-32097, "Pending response rejected since connection got disposed")).kind, "disconnected");
  assert.equal(failureOf(answered(-32099, "Connection is closed")).kind, "disconnected");
});

test("any value may be thrown", () => {
  assert.deepEqual(failureOf("no"), { kind: "other", message: "No.", details: "no" });
  assert.equal(failureOf(undefined).kind, "other");
});

test("a sentence has the headline and the help, without the terminal's lines", () => {
  const printed = "error: there is no Python on this machine's PATH\n  |\n  = help: install Python 3.11 or later\n";
  assert.equal(sentence(printed), "There is no Python on this machine's PATH. Install Python 3.11 or later.");
  assert.equal(sentence("error[invalid-radius]: no"), "No.");
  assert.equal(sentence("rover does not move"), "Rover does not move.");
  assert.equal(sentence(""), "");
});
