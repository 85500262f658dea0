import assert from "node:assert/strict";
import { test } from "node:test";

import { findCommand, findServer, type SearchPaths } from "../src/executables";

function paths(files: string[], more: Partial<SearchPaths> = {}): SearchPaths {
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

test("the setting wins over the bundled server, which wins over the PATH", () => {
  const files = ["/mine/pydslrep-lsp", "/ext/server/pydslrep", "/opt/bin/pydslrep-lsp"];
  assert.deepEqual(findServer(paths(files, { setting: "/mine/pydslrep-lsp" })), {
    command: "/mine/pydslrep-lsp",
    args: ["--stdio"],
    origin: "setting",
  });
  assert.deepEqual(findServer(paths(files)), {
    command: "/ext/server/pydslrep",
    args: ["lsp", "--stdio"],
    origin: "bundled",
  });
  assert.deepEqual(findServer(paths(files.slice(2))), {
    command: "/opt/bin/pydslrep-lsp",
    args: ["--stdio"],
    origin: "path",
  });
});

test("the command is the server if `pydslrep-lsp` is missing", () => {
  assert.deepEqual(findServer(paths(["/usr/bin/pydslrep"])), {
    command: "/usr/bin/pydslrep",
    args: ["lsp", "--stdio"],
    origin: "path",
  });
});

test("a setting may start with ~ or ${workspaceFolder}, be relative, or name a program on the PATH", () => {
  const files = ["/home/ada/bin/pydslrep-lsp", "/work/target/debug/pydslrep", "/opt/bin/pydslrep-lsp"];
  const found = (setting: string) => findServer(paths(files, { setting }));
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

test("a setting that names a missing file is an error; no other server is used", () => {
  const server = findServer(paths(["/ext/server/pydslrep"], { setting: "/gone/pydslrep-lsp" }));
  assert.ok("reason" in server);
  assert.match(server.reason, /`pydslrep.server.path` is `\/gone\/pydslrep-lsp`/);
  assert.equal(server.isSettingWrong, true);
});

test("without a server, the message says what is missing", () => {
  const server = findServer(paths([]));
  assert.ok("reason" in server);
  assert.match(server.reason, /not installed.*PATH/s);
  assert.equal(server.isSettingWrong, false);
});

test("on Windows programs end in .exe and folders are separated by semicolons", () => {
  const windows = { platform: "win32", searchPath: "C:\\bin;D:\\tools", bundledFolder: "C:\\ext\\server" } as const;
  assert.deepEqual(findServer(paths(["D:\\tools\\pydslrep-lsp.exe"], windows)), {
    command: "D:\\tools\\pydslrep-lsp.exe",
    args: ["--stdio"],
    origin: "path",
  });
  assert.deepEqual(findServer(paths(["C:\\ext\\server\\pydslrep.exe"], windows)), {
    command: "C:\\ext\\server\\pydslrep.exe",
    args: ["lsp", "--stdio"],
    origin: "bundled",
  });
});

test("the command is next to the server, or else bundled, or else on the PATH", () => {
  const all = ["/mine/pydslrep-lsp", "/mine/pydslrep", "/ext/server/pydslrep", "/opt/bin/pydslrep"];
  const setting = "/mine/pydslrep-lsp";
  assert.equal(findCommand(paths(all, { setting })), "/mine/pydslrep");
  assert.equal(findCommand(paths(all.filter((file) => file !== "/mine/pydslrep"), { setting })), "/ext/server/pydslrep");
  assert.equal(findCommand(paths(["/opt/bin/pydslrep"])), "/opt/bin/pydslrep");
  assert.equal(findCommand(paths([])), undefined);
});
