import assert from "node:assert/strict";
import { test } from "node:test";

import { commandOf, KEYS, type Key } from "../page/keys";
import { Playback } from "../page/playback";
import * as format from "../page/format";

function playing(duration: number): Playback {
  const playback = new Playback();
  playback.setDuration(duration);
  playback.toggle();
  return playback;
}

test("time advances at the chosen speed and stops at the end", () => {
  const playback = playing(10);
  playback.chosenSpeed = 4;
  assert.ok(playback.advance(0.1, false));
  assert.ok(Math.abs(playback.time - 0.4) < 1e-9);
  for (let turn = 0; turn < 100; turn += 1) playback.advance(0.1, false);
  assert.deepEqual([playback.time, playback.isPlaying], [10, false]);
  assert.ok(!playback.advance(1, false));
  playback.toggle();
  assert.deepEqual([playback.time, playback.isPlaying], [0, true]);
});

test("a reset stops the playback and goes back to the start", () => {
  const playback = playing(10);
  playback.advance(0.2, false);
  playback.reset();
  assert.deepEqual([playback.time, playback.isPlaying], [0, false]);
});

test("the help lists exactly the keys that have a command", () => {
  const press = (key: string, shiftKey = false) =>
    commandOf({ key, shiftKey, ctrlKey: false, altKey: false, metaKey: false }, "");
  const listed = KEYS.flatMap(({ keys, shift }) => keys.map((key) => [key, shift === true] as const));
  assert.deepEqual(listed.filter(([key, shift]) => press(key, shift) === undefined), []);
  const named = ["Enter", "Home", "End", "PageUp", "PageDown", "Escape", "ArrowLeft", "ArrowRight", "ArrowUp", "ArrowDown", "−"];
  const printable = Array.from({ length: 95 }, (_, index) => String.fromCharCode(32 + index));
  const working = [...named, ...printable].filter((key) => press(key) !== undefined);
  assert.deepEqual(working.filter((key) => !listed.some(([other]) => other === key)), []);
});

test("the playback does not jump after its window was hidden", () => {
  const playback = playing(100);
  playback.chosenSpeed = 1;
  playback.advance(60, false);
  assert.equal(playback.time, 0.25);
});

test("with reduced motion time advances in steps", () => {
  const playback = playing(100);
  playback.chosenSpeed = 1;
  const changes = Array.from({ length: 10 }, () => playback.advance(0.1, true));
  assert.equal(changes.filter(Boolean).length, 2);
  assert.ok(Math.abs(playback.time - 1) < 1e-9);
});

test("another path keeps the time if possible", () => {
  const playback = playing(10);
  playback.seek(7);
  playback.setDuration(20);
  assert.equal(playback.time, 7);
  playback.setDuration(5);
  assert.equal(playback.time, 5);
  playback.setDuration(0);
  playback.toggle();
  assert.deepEqual([playback.time, playback.isPlaying], [0, false]);
});

test("the default speed limits the time of a playback", () => {
  const speeds = [3, 36, 2300, 1e6].map((duration) => playing(duration).speed);
  assert.deepEqual(speeds, [1, 2, 128, 128]);
});

test("keys have commands unless the focused element handles them", () => {
  const key = (name: string, more: Partial<Key> = {}): Key => ({ key: name, shiftKey: false, ctrlKey: false, altKey: false, metaKey: false, ...more });
  assert.deepEqual(commandOf(key(" "), "DIV"), { do: "toggle" });
  assert.equal(commandOf(key(" "), "BUTTON"), undefined);
  assert.equal(commandOf(key(" "), "CHECKBOX"), undefined);
  assert.deepEqual(commandOf(key("Home"), "INPUT"), { do: "start" });
  assert.deepEqual(commandOf(key("ArrowRight"), "INPUT"), { do: "step", steps: 1 });
  assert.deepEqual(commandOf(key("ArrowRight", { shiftKey: true }), "DIV"), { do: "pan", x: -40, y: 0 });
  assert.equal(commandOf(key("ArrowRight", { ctrlKey: true }), "DIV"), undefined);
  assert.equal(commandOf(key("ArrowRight"), "SELECT"), undefined);
  assert.equal(commandOf(key("x"), "DIV"), undefined);
});

test("numbers are formatted for people", () => {
  assert.deepEqual([0.04, 59.94, 59.96, 754.2].map(format.duration), ["0.0 s", "59.9 s", "1 min 0.0 s", "12 min 34.2 s"]);
  assert.deepEqual([Math.PI, -Math.PI, Math.PI / 3, -7].map(format.degrees), ["180°", "180°", "60°", "-41.1°"]);
  assert.deepEqual([format.tickLabel(-0.5, 0.5), format.tickLabel(2, 1), format.tickLabel(0.1 + 0.2, 0.1)], ["-0.5", "2", "0.3"]);
  assert.deepEqual([0.002, 0.5, 1, 2.5].map(format.length), ["0.2 cm", "50 cm", "1 m", "2.5 m"]);
  assert.equal(format.pose({ x: -0.001, y: 1.5, theta: Math.PI / 2 }), "(0.00, 1.50) m, 90°");
});
