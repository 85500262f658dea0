import assert from "node:assert/strict";
import { test } from "node:test";

import configuration from "../language-configuration.json";

const { increaseIndentPattern, decreaseIndentPattern } = configuration.indentationRules;
const increases = new RegExp(increaseIndentPattern);
const decreases = new RegExp(decreaseIndentPattern);

/** What a line's text adds to the indentation of the next one when Enter is pressed at its end. */
function step(line: string): number {
  for (const rule of configuration.onEnterRules) {
    // The other rules are about comments.
    if ("afterText" in rule || "appendText" in rule.action || !new RegExp(rule.beforeText).test(line)) continue;
    return rule.action.indent === "outdent" ? -1 : 0;
  }
  return increases.test(line) ? 1 : 0;
}

/** The lines that VS Code would indent otherwise, if they were typed one after the other. */
function wrong(program: string): string[] {
  const found: string[] = [];
  let before = "";
  for (const line of program.split("\n")) {
    const text = line.trimStart();
    const depth = (before.length - before.trimStart().length) / 2 + step(before) - (decreases.test(text) ? 1 : 0);
    if (text !== "" && line !== "  ".repeat(Math.max(0, depth)) + text) found.push(line);
    before = line;
  }
  return found;
}

test("nested blocks are indented like formatted programs", () => {
  const program = `movement m of r { // actions
  repeat 4 times {
    repeat until { front back } detect within 40 centimeters { // {
      if { corner } detect {
        do side
      } else if { corner } clear { /* nothing near */
        move 10 centimeters
      } else {
        turn right 6
      }
    }
    turn left
  }
  repeat 2 times { turn left until { front } }
  if { front } clear { move 1 meters } else { slam }
  slam
}
environment e has { r } robots with { m } moves
`;
  assert.deepEqual(wrong(program), []);
});

test("only braces that are left open indent, however deep the closed ones are nested", () => {
  const indented = ["movement m of r {", "repeat 2 times { if { a } clear { slam }", "} else {", "x { // y }", 'import "/*" {'];
  const others = ["slam", "repeat 2 times { if { a } clear { slam } }", "// {", "/* { */", "} // {"];
  assert.deepEqual(indented.filter((line) => !increases.test(line)), []);
  assert.deepEqual(others.filter((line) => increases.test(line)), []);
});

test("a line that closes a brace takes the next one back, a line that also opens one keeps it", () => {
  assert.equal(step("    front }"), -1);
  assert.equal(step("    slam } else {"), 0);
  assert.equal(step("    turn left until { front } }"), -1);
  assert.equal(step("    } else {"), 1);
});
