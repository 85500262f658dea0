import assert from "node:assert/strict";
import { test } from "node:test";

import { CrashCounter } from "../src/crash_counter";
import { launch } from "../src/launch";

test("a server that crashes too often is not restarted", () => {
  const rare = new CrashCounter();
  assert.deepEqual([0, 1, 2, 3, 4].map((minute) => rare.add(minute * 60_000)), [true, true, true, true, true]);
  const often = new CrashCounter();
  assert.deepEqual([0, 1, 2, 3, 4, 5].map((second) => often.add(second * 1000)), [true, true, true, true, false, false]);
  assert.ok(often.add(10 * 60_000), "old crashes are forgotten");
});

test("a program that cannot be started is an error", async () => {
  await assert.rejects(launch({ command: "/nowhere/server", args: [], origin: "path" }, undefined), /ENOENT/);
  const child = await launch({ command: process.execPath, args: ["-e", "process.stdin.resume()"], origin: "path" }, undefined);
  const ended = new Promise((resolve) => child.once("exit", resolve));
  child.stdin.end();
  assert.equal(await ended, 0);
});
