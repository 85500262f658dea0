import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import { mkdtempSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import path from "node:path";
import { test } from "node:test";

import manifest from "../package.json";
import { argumentsOf, nameOf } from "../src/task_definition";
import { command } from "./command";

const repository = path.resolve(EXTENSION_FOLDER, "../..");

/** The output of `pydslrep` for these files, whatever its exit code. */
function output(files: Record<string, string>, args: string[]): string {
  const folder = mkdtempSync(path.join(tmpdir(), "pydslrep-tasks-"));
  try {
    for (const [name, text] of Object.entries(files)) {
      writeFileSync(path.join(folder, name), text);
    }
    return execFileSync(command(), args, { cwd: folder, encoding: "utf8", stdio: ["ignore", "pipe", "pipe"] });
  } catch (error) {
    const { stdout } = error as { stdout?: string };
    assert.ok(stdout !== undefined, String(error));
    return stdout;
  } finally {
    rmSync(folder, { recursive: true });
  }
}

/** What the manifest's problem matcher finds in a text, by the rules of VS Code. */
function matched(text: string): Record<string, string | undefined>[] {
  const matcher = manifest.contributes.problemMatchers[0];
  assert.ok(matcher);
  const lines = text.split(/\r?\n/);
  const found: Record<string, string | undefined>[] = [];
  for (let at = 0; at + matcher.pattern.length <= lines.length; at++) {
    const problem: Record<string, string | undefined> = {};
    const all = matcher.pattern.every(({ regexp, ...groups }, index) => {
      const match = new RegExp(regexp).exec(lines[at + index] ?? "");
      for (const [name, group] of Object.entries(groups)) {
        problem[name] = match?.[group];
      }
      return match !== null;
    });
    if (all) {
      found.push(problem);
    }
  }
  return found;
}

test("the problem matcher finds every problem of `pydslrep check`, at every severity", () => {
  const programs = {
    "first.pyr": "wheel small with radius -1\nwheel large with radius 400\n",
    "second.pyr": `sensor spare
${readFileSync(path.join(repository, "examples/square.pyr"), "utf8")}`,
    "thi rd.pyr": "robot r type tw with port 1 has { a b } wheels\nmovement m of r { }\n",
  };
  const printed = output(programs, ["check", "--severity", "no-environment=information"]);
  const found = matched(printed).map(({ severity, code, file, line, column }) => [severity, code, file, line, column].join(" "));
  const json = JSON.parse(output(programs, ["check", "--severity", "no-environment=information", "--format", "json"])) as {
    file: string;
    code: string;
    severity: string;
    range: { start: { line: number; column: number } };
  }[];
  const wanted = json.map(({ file, code, severity, range: { start } }) =>
    [severity, code, file, start.line, start.column].join(" "),
  );
  assert.deepEqual(found, wanted);
  const severities = new Set(json.map(({ severity }) => severity));
  assert.deepEqual([...severities].sort(), ["error", "hint", "information", "warning"]);
});

test("the matched message excludes its severity and code", () => {
  const [problem] = matched(output({ "p.pyr": "wheel w with radius -1\n" }, ["check"]));
  assert.equal(problem?.message, "a wheel's radius must be above zero, not -1 cm");
});

test("nothing matches for a program without problems", () => {
  const program = path.join(repository, "examples", "square.pyr");
  assert.deepEqual(matched(output({}, ["check", program])), []);
});

test("tasks become command lines", () => {
  assert.deepEqual(argumentsOf({ type: "pydslrep", action: "check" }), ["check"]);
  assert.deepEqual(
    argumentsOf({ type: "pydslrep", action: "run", path: "a b.pyr", arguments: ["--seed", "7"] }),
    ["run", "a b.pyr", "--seed", "7"],
  );
  assert.deepEqual(argumentsOf({ type: "pydslrep", action: "run", path: "-x.pyr" }), ["run", "./-x.pyr"]);
  assert.equal(nameOf({ type: "pydslrep", action: "build", path: "rooms" }), "build rooms");
});

test("every action of a task is a subcommand", () => {
  const [definition] = manifest.contributes.taskDefinitions;
  for (const action of definition?.properties.action.enum ?? []) {
    assert.match(execFileSync(command(), [action, "--help"], { encoding: "utf8" }), /Usage:/);
  }
});
