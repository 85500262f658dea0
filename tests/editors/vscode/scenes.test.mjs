// A scene belongs to its program: what is renamed in one is renamed in the other, the scene runs its environment, and a
// simulator with an empty floor gets it.
import assert from "node:assert/strict";
import { spawn } from "node:child_process";
import { existsSync } from "node:fs";
import path from "node:path";
import { after, afterEach, before, test } from "node:test";

import { Stage, spaced, until } from "./stage.mjs";

const PROGRAM = `wheel wheelL with radius 4.5
wheel wheelR with radius 4.5

robot rover type tw with port 23000 has { wheelL wheelR } wheels

movement patrol of rover {
  move 50 centimeters
}

environment yard has { rover } robots with { patrol } moves
`;
const SCENE = `# The yard.
[robots.rover]
start = [0, 1, 0]
`;

let stage;
let simulator;
let address;
before(async () => {
  const command = process.env.PYDSLREP ?? path.resolve(import.meta.dirname, "../../../target/release/pydslrep");
  simulator = spawn(command, ["sim", "--empty", "--port", "0"], { stdio: ["ignore", "pipe", "inherit"] });
  let said = "";
  simulator.stdout.on("data", (data) => (said += data));
  const port = Number(await until("the simulator listens", () => /:(\d+)/.exec(said)?.[1]));
  address = `127.0.0.1:${port}`;
  const files = { "yard.pyr": PROGRAM, "yard.scene.toml": SCENE };
  stage = await Stage.open({ files, settings: { "pydslrep.coppeliasim.port": port }, open: "yard.scene.toml" });
});
afterEach((t) => t.passed || stage?.keepPicture());
after(async () => {
  await stage?.close();
  simulator?.kill("SIGINT");
});

test("a scene has colours and actions", async () => {
  await stage.page.locator(".codelens-decoration a", { hasText: /^Run$/ }).first().waitFor();
  const colours = (parts) => new Set(parts.map((part) => getComputedStyle(part).color)).size;
  await until("a line has more than one colour", async () => (await stage.line("start =").first().locator("span span").evaluateAll(colours)) > 1);
  await stage.picture("scene");
});

test("F5 in a scene runs its environment", async () => {
  await stage.keyOf("PyDSLRep: Run in Simulator", "F5");
  await stage.clickLine("start =");
  await stage.page.keyboard.press("F5");
  const frame = await stage.webview("main.preview");
  await frame.locator('[data-part="result"]', { hasText: /yard: .* simulated in/ }).waitFor();
  await frame.locator('main.preview[data-driven="yard"]').waitFor();
});

test("a robot that is renamed in its program is renamed in the scene", async () => {
  await stage.openFile("yard.pyr");
  await rename("robot rover", "rover", "guard");
  await stage.openFile("yard.scene.toml");
  await stage.line("[robots.guard]").first().waitFor();
});

test("a scene follows when its environment is renamed", async () => {
  await stage.openFile("yard.pyr");
  await rename("environment yard", "yard", "hall");
  await stage.call("File: Save All Files");
  await until("the scene has the new name", () => existsSync(path.join(stage.folder, "hall.scene.toml")) && !existsSync(path.join(stage.folder, "yard.scene.toml")));
  // The files are saved one after the other.
  await until("the program is saved", () => /environment hall has \{ guard \}/.test(stage.read("yard.pyr")));
  assert.match(stage.read("hall.scene.toml"), /\[robots\.guard\]/);
});

/** Gives the environment another scene, and returns to the program. */
async function writeScene(scene) {
  // Quick Open may not know the new name yet.
  await stage.tab("hall.scene.toml").click();
  await stage.clickLine("[robots.guard]");
  await stage.page.keyboard.press("Control+A");
  await stage.page.keyboard.insertText(scene);
  await stage.tab("yard.pyr").click();
  await stage.clickLine("move 50");
}

const FREE = SCENE.replace("rover", "guard");
const BLOCKED = `${FREE}\n[[cylinder]]\nat = [0.4, 1]\nradius = 0.1\n`;
const FAILURE = /^Robot guard, movement patrol, action 1: .*yard\.pyr, line 7/;

test("a failed run says where, and marks its action until the next one", async () => {
  await writeScene(BLOCKED);
  const marked = stage.page.locator(".squiggly-error");
  assert.equal(await marked.count(), 0);
  await stage.page.keyboard.press("F5");
  const frame = await stage.webview("main.preview");
  const result = frame.locator('[data-part="result"]');
  await result.filter({ hasText: FAILURE }).waitFor();
  await marked.first().waitFor();
  await writeScene(FREE);
  await result.filter({ hasText: "The program has changed since." }).waitFor();
  await stage.page.keyboard.press("F5");
  await result.filter({ hasText: /hall: .* simulated in/ }).waitFor();
  await marked.first().waitFor({ state: "detached" });
});

test("the message of a failed run opens the preview, which then has it", async () => {
  await writeScene(BLOCKED);
  await closePreview();
  await stage.clickLine("move 50");
  await stage.page.keyboard.press("F5");
  await stage.toast(/Robot guard, movement patrol, action 1: .*line 7/, "Show Path");
  const frame = await stage.webview("main.preview");
  await frame.locator('[data-part="result"]', { hasText: FAILURE }).waitFor();
  await frame.locator('main.preview[data-driven="hall"]').waitFor();
});

test("the preview's button runs what it shows", async () => {
  await writeScene(FREE);
  const frame = await stage.webview("main.preview");
  await frame.getByRole("button", { name: "Run in the simulator" }).click();
  await frame.locator('[data-part="result"]', { hasText: /hall: .* simulated in/ }).waitFor();
});

test("a scene without the robot is reported", async () => {
  await stage.clickLine("move 50");
  await stage.call("PyDSLRep: Check Scene in CoppeliaSim");
  await stage.toast(/robot guard: .*pydslrep scene push/s);
});

test("a scene is built, and then fits the program", async () => {
  await stage.call("PyDSLRep: Push Scene to CoppeliaSim");
  await stage.toast(`Built 1 robot and 0 obstacles in CoppeliaSim at ${address}`);
  await stage.call("PyDSLRep: Check Scene in CoppeliaSim");
  await stage.toast("fits the program");
});

test("what was built is replaced only if the user wants it", async () => {
  await stage.call("PyDSLRep: Push Scene to CoppeliaSim");
  await stage.toast(/built for environment `hall`/, "Keep Them");
  await stage.call("PyDSLRep: Push Scene to CoppeliaSim");
  await stage.toast(/built for environment `hall`/, "Replace Them");
  await stage.toast("Built 1 robot");
  assert.equal(await stage.toasts.count(), 0);
});

test("what was built is removed", async () => {
  await stage.call("PyDSLRep: Remove Scene from CoppeliaSim");
  await stage.toast(/Removed \d+ objects from CoppeliaSim/);
});

async function closePreview() {
  const tab = stage.page.locator(".tab", { hasText: "Path: " });
  await tab.click({ button: "middle" });
  await tab.waitFor({ state: "detached" });
}

async function rename(line, word, name) {
  await stage.line(line).first().waitFor();
  await stage.clickWord(line, word);
  await stage.page.keyboard.press("F2");
  const input = stage.page.locator(".rename-box input");
  await until("the editor offers the name", async () => (await input.inputValue()) === word);
  await input.fill(name);
  await stage.page.keyboard.press("Enter");
  await until("the name is changed", async () => spaced(await stage.text()).includes(`${line.split(" ")[0]} ${name}`));
}
