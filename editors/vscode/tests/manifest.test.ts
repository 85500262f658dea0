import assert from "node:assert/strict";
import { spawnSync } from "node:child_process";
import { existsSync, mkdtempSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import path from "node:path";
import { test } from "node:test";

import manifest from "../package.json";
import snippets from "../snippets/pydslrep.json";
import { command } from "./command";

const at = (...parts: string[]) => path.join(EXTENSION_FOLDER, ...parts);

test("the manifest's settings and colours are up to date", () => {
  const { status, stderr } = spawnSync(process.execPath, [at("scripts/contributions.mjs"), "--check"], { encoding: "utf8" });
  assert.equal(status, 0, stderr);
});

test("no setting's description mentions the settings file", () => {
  assert.doesNotMatch(JSON.stringify(manifest.contributes.configuration), /this file/);
});

test("every file that the manifest names exists after a build", () => {
  const named = JSON.stringify(manifest).matchAll(/"(?:\.\/)?((?:dist|images|snippets|walkthrough)\/[^"]+)"/g);
  const missing = [...named].map(([, file = ""]) => file).filter((file) => !existsSync(at(file)));
  assert.deepEqual(missing, []);
});

test("no command of the extension has the name of a server command", () => {
  const protocol = readFileSync(path.resolve(EXTENSION_FOLDER, "../../docs/protocol.md"), "utf8");
  const servers = [...protocol.matchAll(/^\| `(pydslrep\.\w+)`/gm)].map(([, name]) => name);
  assert.equal(servers.length, 9);
  const ours = manifest.contributes.commands.map(({ command: name }) => name);
  assert.deepEqual(ours.filter((name) => servers.includes(name)), []);
});

test("menus, keys and the walkthrough refer to existing commands", () => {
  const { commands, menus, keybindings, walkthroughs } = manifest.contributes;
  const known = new Set(commands.map(({ command: name }) => name));
  const called = [
    ...Object.values(menus).flat().map(({ command: name }) => name),
    // A key runs two commands of the editor.
    ...keybindings.map(({ command: name }) => name).filter((name) => name !== "runCommands"),
    ...[...JSON.stringify(walkthroughs).matchAll(/(?:command|onCommand):(pydslrep\.\w+)/g)].map(([, name]) => name),
  ];
  assert.deepEqual(called.filter((name) => name !== undefined && !known.has(name)), []);
});

test("only the server suggests, Enter accepts what the user has selected, and Tab the first suggestion", () => {
  const defaults = manifest.contributes.configurationDefaults["[pydslrep]"];
  assert.equal(defaults["editor.acceptSuggestionOnEnter"], "smart");
  assert.equal(defaults["editor.suggest.selectionMode"], "never");
  const tab = manifest.contributes.keybindings.find(({ key }) => key === "tab");
  assert.deepEqual(tab?.args?.commands, ["selectNextSuggestion", "acceptSelectedSuggestion"]);
  assert.equal(defaults["editor.wordBasedSuggestions"], "off");
  // A snippet with a prefix is suggested after any word.
  assert.deepEqual(Object.entries(snippets).filter(([, snippet]) => "prefix" in snippet), []);
});

test("ports of the simulator are not forwarded", () => {
  const [[pattern, attributes] = ["", undefined]] = Object.entries(manifest.contributes.configurationDefaults["remote.portsAttributes"]);
  assert.equal(attributes?.onAutoForward, "ignore");
  for (const command of ["/usr/bin/pydslrep run a.pyr", "python3 /tmp/pydslrep-job-1/yard.py"]) assert.match(command, new RegExp(pattern));
});

test("the manifest has the project's URLs if there are any, and says that nothing is collected", () => {
  const cargo = 'license = "MIT"\nrepository = "https://example.org/pydslrep"\n';
  const script = `import(process.argv[1]).then(({ addresses }) => console.log(JSON.stringify(addresses(process.argv[2]))))`;
  const run = (text: string): unknown =>
    JSON.parse(spawnSync(process.execPath, ["-e", script, at("scripts/addresses.mjs"), text], { encoding: "utf8" }).stdout);
  assert.deepEqual(run(cargo), {
    repository: { type: "git", url: "https://example.org/pydslrep", directory: "editors/vscode" },
    bugs: { url: "https://example.org/pydslrep/issues" },
  });
  assert.deepEqual(run('license = "MIT"\n'), {});
  assert.match(manifest.description, /Collects nothing\.$/);
});

test("the readme's pictures have addresses in galleries, or are left out", () => {
  const readme = "Words.\n\n![A path](../../docs/images/path.png)\n\nMore.\n";
  const script = `import(process.argv[1]).then(({ forGallery }) => process.stdout.write(forGallery(...process.argv.slice(2))))`;
  const run = (cargo: string): string =>
    spawnSync(process.execPath, ["-e", script, at("scripts/addresses.mjs"), readme, cargo], { encoding: "utf8" }).stdout;
  const address = "https://example.org/pydslrep";
  assert.equal(run(`repository = "${address}"\n`), readme.replace("../..", `${address}/raw/HEAD`));
  assert.equal(run('license = "MIT"\n'), "Words.\n\nMore.\n");
  assert.match(readFileSync(at("README.md"), "utf8"), /^!\[.*\]\(\.\.\/\.\.\/docs\/images\/editors\/vscode-preview\.png\)$/m);
  assert.doesNotMatch(readFileSync(at("dist/README.md"), "utf8"), /\]\(\.\.\//);
});

test("the manifest has what galleries show", () => {
  const { galleryBanner, qna, categories, icon, license } = manifest;
  assert.match(galleryBanner.color, /^#[0-9a-f]{6}$/);
  assert.ok(readFileSync(at("images/icon.svg"), "utf8").includes(galleryBanner.color), "the icon's own background");
  assert.deepEqual([galleryBanner.theme, qna, icon, license], ["dark", "marketplace", "images/icon.png", "MIT"]);
  assert.ok(categories.includes("Programming Languages"));
  for (const file of ["README.md", "CHANGELOG.md"]) {
    assert.ok(existsSync(at(file)), file);
  }
});

test("F5 and Ctrl+F5 run without a launch.json", () => {
  const { keybindings } = manifest.contributes;
  const running = keybindings.filter(({ command: name }) => name === "pydslrep.runInSimulator");
  assert.deepEqual(running.map(({ key }) => key), ["f5", "ctrl+f5"]);
});

test("no step of the walkthrough is completed by a command that the user may cancel", () => {
  const events = manifest.contributes.walkthroughs.flatMap(({ steps }) => steps.flatMap(({ completionEvents }) => completionEvents));
  assert.deepEqual(events.filter((event) => event.startsWith("onCommand:")), []);
});

/** A snippet's text with its default values. */
function expand(body: string[]): string {
  return body
    .join("\n")
    .replace(/\$\{\d+\|([^,|]*)[^|]*\|\}/g, "$1")
    .replace(/\$\{\d+:([^}]*)\}/g, "$1")
    .replace(/\$(?:\w+)/g, "");
}

/** The declarations that a snippet uses. */
const PREAMBLES: Record<string, string> = {
  "Movement that drives a square":
    "wheel a with radius 4\nwheel b with radius 4\nrobot rover type tw with port 1 has { a b } wheels\n",
};

test("snippets expand to programs without errors", () => {
  const folder = mkdtempSync(path.join(tmpdir(), "pydslrep-snippets-"));
  try {
    for (const [name, { body }] of Object.entries(snippets)) {
      const file = path.join(folder, "program.pyr");
      const text = `${PREAMBLES[name] ?? ""}${expand(body)}`;
      assert.doesNotMatch(text, /\$/, name);
      writeFileSync(file, text);
      const { status, stdout } = spawnSync(command(), ["check", file], { encoding: "utf8" });
      assert.equal(status, 0, `${name}: ${stdout}`);
      assert.doesNotMatch(stdout, /^(error|warning)/m, name);
    }
  } finally {
    rmSync(folder, { recursive: true });
  }
});
