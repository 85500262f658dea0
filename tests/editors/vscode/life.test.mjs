// The life cycle of the language server: restarts, the server path setting, and helpful messages if it is missing.
import assert from "node:assert/strict";
import { after, afterEach, before, test } from "node:test";

import { Stage, program, until } from "./stage.mjs";

const FILES = {
  "square.pyr": program("examples/square.pyr"),
  "broken.pyr": "wheel w with radius -1\n",
  // Exploring takes a while.
  "rooms.pyr": program("examples/rooms.pyr"),
  "rooms.scene.toml": program("examples/rooms.scene.toml"),
  unresponsive: "#!/bin/sh\nwhile :; do sleep 1; done\n",
  other: "#!/bin/sh\nexit 1\n",
};

/** The window of all tests but the last. Its server path changes from one to the next. */
let stage;
before(async () => {
  const settings = { "pydslrep.server.path": "${workspaceFolder}/unresponsive" };
  stage = await Stage.open({ files: FILES, open: "broken.pyr", settings });
});

afterEach((t) => t.passed || stage?.keepPicture());
after(() => stage?.close());

/** The hover of the language status in the status bar. */
async function status() {
  await stage.page.locator('.statusbar-item[aria-label*="Editor Language Status"]').first().hover();
  const text = await stage.page.locator(".hover-language-status").first().innerText();
  await stage.page.mouse.move(5, 5);
  return text;
}

test("a server that never responds can be replaced by another one", async () => {
  const [first] = await until("it is started", () => stage.servers().length === 1 && stage.servers());
  stage.set({ "pydslrep.server.path": "" });
  await stage.page.locator(".squiggly-error").first().waitFor();
  await until("only the other one runs", () => stage.servers().length === 1 && stage.servers()[0] !== first);
  assert.equal(await stage.toasts.count(), 0);
});

test("a program that is no server is reported once", async () => {
  stage.set({ "pydslrep.server.path": "${workspaceFolder}/other" });
  await stage.toast("other is not a PyDSLRep language server");
  stage.set({ "pydslrep.server.path": "" });
  await until("the bundled server runs", async () => /running/.test(await status()));
});

test("a killed server is restarted with the open documents", async () => {
  await stage.page.locator(".squiggly-error").first().waitFor();
  const [first] = stage.servers();
  process.kill(first, "SIGKILL");
  const [second] = await until("another server runs", () => {
    const now = stage.servers().filter((id) => id !== first);
    return now.length > 0 && now;
  });
  await stage.clickLine("wheel");
  await stage.page.keyboard.press("End");
  await stage.page.keyboard.press("Backspace");
  await stage.page.keyboard.press("Backspace");
  await stage.type("4");
  await stage.page.locator(".squiggly-error").first().waitFor({ state: "detached" });
  await until("its version is shown", async () => /PyDSLRep \d+\.\d+\.\d+[^]*running/.test(await status()));

  await stage.call("PyDSLRep: Restart Server");
  await until("the server was replaced", () => {
    const now = stage.servers();
    return now.length === 1 && now[0] !== second;
  });
  await until("it runs", async () => /running/.test(await status()));
  await stage.call("PyDSLRep: Show Output");
  await stage.page.locator(".output-view-content, .panel .view-lines", { hasText: "starting" }).first().waitFor();
});

test("stopping a run shows no message, a restart of the server during a run does", async () => {
  await stage.openFile("rooms.pyr");
  const running = stage.toasts.filter({ hasText: "Running rooms" });
  await stage.page.locator(".view-line").first().click();
  await until("the server runs", async () => /running/.test(await status()));
  await stage.keyOf("PyDSLRep: Run in Simulator", "F5");
  await stage.page.keyboard.press("F5");
  await running.waitFor();
  await stage.call("PyDSLRep: Stop Run");
  await running.waitFor({ state: "detached" });
  assert.equal(await stage.toasts.count(), 0);

  await stage.page.keyboard.press("F5");
  await running.waitFor();
  await stage.call("PyDSLRep: Restart Server");
  await stage.toasts.filter({ hasText: "The run of rooms ended because the language server was restarted." }).waitFor();
  await running.waitFor({ state: "detached" });
  await until("it runs again", async () => /running/.test(await status()));
  await stage.toast("The run of rooms ended", "Run Again");
  await running.waitFor();

  const [server] = stage.servers();
  process.kill(server, "SIGKILL");
  await stage.toasts.filter({ hasText: "The run of rooms ended because the language server was restarted." }).waitFor();
  await running.waitFor({ state: "detached" });
  assert.equal(await stage.toasts.count(), 1);
});

test("a wrong server path is reported, and a new one is used at once", async () => {
  stage.set({ "pydslrep.server.path": "/nowhere/pydslrep-lsp" });
  const message = stage.page.locator(".notification-toast", { hasText: "/nowhere/pydslrep-lsp" });
  await message.waitFor();
  assert.match(await message.innerText(), /that file does not exist/);
  await until("no server runs", () => stage.servers().length === 0);
  await until("the status bar says so", async () => /no server/.test(await status()));
  await message.getByRole("button", { name: "Change Setting" }).click();
  const search = stage.page.locator(".settings-editor .search-container");
  await until("the settings editor shows the setting", async () => /pydslrep\.server\.path/.test(await search.innerText()));
  stage.set({ "pydslrep.server.path": "" });
  await until("the bundled server runs", () => stage.servers().length === 1);
});

test("in an untrusted workspace programs are checked but not run", async () => {
  await Stage.with({
    files: { ...FILES, ".vscode/settings.json": JSON.stringify({ "pydslrep.server.path": "/bin/false" }) },
    open: "square.pyr",
    trusted: false,
    settings: { "security.workspace.trust.startupPrompt": "never" },
  }, async (untrusted) => {
    await untrusted.page.locator(".view-line").first().click();
    await untrusted.page.keyboard.press("Control+End");
    await untrusted.page.locator(".codelens-decoration", { hasText: "Run" }).first().waitFor();
    assert.equal(untrusted.servers().length, 1, "the workspace cannot set the server path");
    const message = untrusted.page.locator(".notification-toast", { hasText: "workspaces that you trust" });
    await untrusted.clickLens("Run", message);
    assert.equal(await message.locator("a", { hasText: "Manage Workspace Trust" }).count(), 1);
  });
});
