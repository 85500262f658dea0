// Building, checking and removing a scene in a simulator with an empty floor.
import assert from "node:assert/strict";
import { spawn } from "node:child_process";
import path from "node:path";
import { after, afterEach, before, test } from "node:test";

import { Stage, until } from "./stage.mjs";

const PROGRAM = `wheel wheelL with radius 4.5
wheel wheelR with radius 4.5
robot rover type tw with port 23000 has { wheelL wheelR } wheels
movement patrol of rover { move 1 meters }
environment yard has { rover } robots with { patrol } moves
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
  stage = await Stage.open({ files: { "yard.pyr": PROGRAM }, settings: { "pydslrep.coppeliasim.port": port }, open: "yard.pyr" });
});
afterEach((t) => t.passed || stage?.keepPicture());
after(async () => {
  await stage?.close();
  simulator?.kill("SIGINT");
});

test("a scene without the robot is reported", async () => {
  await stage.call("PyDSLRep: Check Scene in CoppeliaSim");
  await stage.toast(/robot rover: .*pydslrep scene push/s);
});

test("a scene is built, and then fits the program", async () => {
  await stage.call("PyDSLRep: Push Scene to CoppeliaSim");
  await stage.toast(`Built 1 robot and 0 obstacles in CoppeliaSim at ${address}`);
  await stage.call("PyDSLRep: Check Scene in CoppeliaSim");
  await stage.toast("fits the program");
});

test("what was built is replaced only if the user wants it", async () => {
  await stage.call("PyDSLRep: Push Scene to CoppeliaSim");
  await stage.toast(/built for environment `yard`/, "Keep Them");
  await stage.call("PyDSLRep: Push Scene to CoppeliaSim");
  await stage.toast(/built for environment `yard`/, "Replace Them");
  await stage.toast("Built 1 robot");
  assert.equal(await stage.toasts.count(), 0);
});

test("what was built is removed", async () => {
  await stage.call("PyDSLRep: Remove Scene from CoppeliaSim");
  await stage.toast(/Removed \d+ objects from CoppeliaSim/);
});
