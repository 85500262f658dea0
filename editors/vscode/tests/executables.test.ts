import assert from "node:assert/strict";
import { test } from "node:test";

import { findCommand, findServer, type Places } from "../src/executables";

function places(files: string[], more: Partial<Places> = {}): Places {
  return {
    setting: "",
    workspaceFolder: "/work",
    homeFolder: "/home/ada",
    bundledFolder: "/ext/server",
    searchPath: "/usr/bin:/opt/bin",
    platform: "linux",
    isFile: (file) => files.includes(file),
    ...more,
  };
}

test("the setting wins over the extension's own server, and that over the path", () => {
  const files = ["/mine/pydslrep-lsp", "/ext/server/pydslrep", "/opt/bin/pydslrep-lsp"];
  assert.deepEqual(findServer(places(files, { setting: "/mine/pydslrep-lsp" })), {
    command: "/mine/pydslrep-lsp",
    args: ["--stdio"],
    origin: "setting",
  });
  assert.deepEqual(findServer(places(files)), {
    command: "/ext/server/pydslrep",
    args: ["lsp", "--stdio"],
    origin: "bundled",
  });
  assert.deepEqual(findServer(places(files.slice(2))), {
    command: "/opt/bin/pydslrep-lsp",
    args: ["--stdio"],
    origin: "path",
  });
});

test("the command serves where there is no server of its own", () => {
  assert.deepEqual(findServer(places(["/usr/bin/pydslrep"])), {
    command: "/usr/bin/pydslrep",
    args: ["lsp", "--stdio"],
    origin: "path",
  });
});

test("a setting may begin with the home or the workspace folder, be relative, or name a program on the path", () => {
  const files = ["/home/ada/bin/pydslrep-lsp", "/work/target/debug/pydslrep", "/opt/bin/pydslrep-lsp"];
  const found = (setting: string) => findServer(places(files, { setting }));
  for (const [setting, command] of [
    ["~/bin/pydslrep-lsp", "/home/ada/bin/pydslrep-lsp"],
    ["${workspaceFolder}/target/debug/pydslrep", "/work/target/debug/pydslrep"],
    ["target/debug/pydslrep", "/work/target/debug/pydslrep"],
    ["pydslrep-lsp", "/opt/bin/pydslrep-lsp"],
    ["  /opt/bin/pydslrep-lsp ", "/opt/bin/pydslrep-lsp"],
  ] as const) {
    const server = found(setting);
    assert.equal("command" in server && server.command, command, setting);
  }
});

test("a setting that leads nowhere is said, and nothing else is started in its place", () => {
  const server = findServer(places(["/ext/server/pydslrep"], { setting: "/gone/pydslrep-lsp" }));
  assert.ok("reason" in server);
  assert.match(server.reason, /`pydslrep.server.path` is `\/gone\/pydslrep-lsp`/);
  assert.equal(server.setting, true);
});

test("without any server it is said what to install", () => {
  const server = findServer(places([]));
  assert.ok("reason" in server);
  assert.match(server.reason, /not installed.*PATH/s);
  assert.equal(server.setting, false);
});

test("on Windows programs end in .exe and folders are divided by semicolons", () => {
  const windows = { platform: "win32", searchPath: "C:\\bin;D:\\tools", bundledFolder: "C:\\ext\\server" } as const;
  assert.deepEqual(findServer(places(["D:\\tools\\pydslrep-lsp.exe"], windows)), {
    command: "D:\\tools\\pydslrep-lsp.exe",
    args: ["--stdio"],
    origin: "path",
  });
  assert.deepEqual(findServer(places(["C:\\ext\\server\\pydslrep.exe"], windows)), {
    command: "C:\\ext\\server\\pydslrep.exe",
    args: ["lsp", "--stdio"],
    origin: "bundled",
  });
});

test("the command for tasks is the one beside the server, else the extension's, else that on the path", () => {
  const all = ["/mine/pydslrep-lsp", "/mine/pydslrep", "/ext/server/pydslrep", "/opt/bin/pydslrep"];
  const setting = "/mine/pydslrep-lsp";
  assert.equal(findCommand(places(all, { setting })), "/mine/pydslrep");
  assert.equal(findCommand(places(all.filter((file) => file !== "/mine/pydslrep"), { setting })), "/ext/server/pydslrep");
  assert.equal(findCommand(places(["/opt/bin/pydslrep"])), "/opt/bin/pydslrep");
  assert.equal(findCommand(places([])), undefined);
});
