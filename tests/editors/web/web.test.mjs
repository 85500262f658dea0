// The language server in a worker and the simulator, as WebAssembly in a page.
import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import path from "node:path";
import { after, before, test } from "node:test";

import { openPage } from "./browser.mjs";

const root = path.resolve(import.meta.dirname, "../../..");
const square = readFileSync(path.join(root, "examples/square.pyr"), "utf8");
const URI = "file:///w/square.pyr";

let browser, page;
before(async () => {
  browser = await openPage();
  ({ page } = browser);
});
after(() => browser.close());

for (const fromBlob of [false, true]) {
  test(`a session${fromBlob ? " in a worker from a blob" : ""}: diagnostics, completion, hover`, async () => {
    const found = await page.evaluate(
      async ({ fromBlob, uri, text }) => {
        const client = await Client.start({ fromBlob });
        const name = client.initialized.serverInfo.name;
        client.open(uri, text);
        const at = { textDocument: { uri }, position: { line: text.slice(0, text.indexOf("move ")).split("\n").length - 1, character: 3 } };
        const clean = await client.problems(uri, () => true);
        const items = (await client.request("textDocument/completion", at)).items.map((item) => item.label);
        const hover = JSON.stringify((await client.request("textDocument/hover", at)).contents);
        client.change(uri, at.position.line, 2, "x");
        await client.leaveLine(uri);
        const broken = await client.problems(uri, (problems) => problems.length > 0);
        await client.request("shutdown");
        client.worker.terminate();
        return { name, clean, items, hover, broken };
      },
      { fromBlob, uri: URI, text: square },
    );
    assert.equal(found.name, "pydslrep-lsp");
    assert.deepEqual(found.clean, []);
    assert.ok(found.items.includes("move"), found.items.join());
    assert.match(found.hover, /m/);
    assert.equal(found.broken.length, 1);
  });
}

test("files that are not open are provided: imports, scenes, settings, in a virtual file system too", async () => {
  const found = await page.evaluate(async () => {
    const client = await Client.start();
    const [program, parts, scene, settings] = ["a.pyr", "parts%20b.pyr", "area.scene.toml", "pydslrep.toml"].map(
      (name) => `memfs://host/w/${name}`,
    );
    const wheels = "wheel l with radius 4.5\nwheel r with radius 4.5\nrobot a type tw with port 23000 has { l r } wheels\n";
    client.open(program, 'import "parts b.pyr"\nmovement m of a { move 1 meters }\nenvironment area has { a } robots with { m } moves\n');
    await client.problems(program, (problems) => problems.length > 0);
    client.provide([{ uri: parts, text: wheels }]);
    await client.problems(program, (problems) => problems.length === 0);
    client.provide([{ uri: scene, text: "nonsense = 1\n" }]);
    const wrong = await client.problems(scene, (problems) => problems.length > 0);
    client.provide([{ uri: scene, text: null }, { uri: settings, text: "nonsense = 1\n" }]);
    await client.problems(scene, (problems) => problems.length === 0);
    await client.problems(settings, (problems) => problems.length > 0);
    const definition = await client.request("textDocument/definition", { textDocument: { uri: program }, position: { line: 1, character: 14 } });
    const script = await client.request("pydslrep/script", { uri: program, environment: "area" });
    client.worker.terminate();
    return { wrong, definition: JSON.stringify(definition), script, parts };
  });
  assert.match(found.wrong[0], /nonsense/);
  assert.ok(found.definition.includes(found.parts), found.definition);
  assert.equal(found.script.uri, "memfs://host/w/area.py");
  assert.match(found.script.text, /await a\.move\(1\.0\)/);
});

test("a long request gives way to its cancellation", async () => {
  const error = await page.evaluate(async () => {
    const client = await Client.start();
    const uri = "file:///w/long.pyr";
    client.open(uri, Array.from({ length: 8000 }, (_, i) => `wheel wheel_${i} with radius 4.5`).join("\n"));
    await client.problems(uri, () => true);
    const tokens = client.send("textDocument/semanticTokens/full", { textDocument: { uri } });
    client.notify("$/cancelRequest", { id: client.last });
    const { error } = await tokens;
    client.worker.terminate();
    return error;
  });
  assert.equal(error?.code, -32800);
});

test("a server that cannot be loaded says so, and refuses requests", async () => {
  const messages = await page.evaluate(
    () =>
      new Promise((resolve) => {
        const worker = new Worker("/worker.js");
        const received = [];
        worker.onmessage = ({ data }) => received.push(data) === 2 && resolve(received);
        worker.postMessage({ wasm: new Uint8Array([1, 2, 3]) });
        worker.postMessage({ jsonrpc: "2.0", id: 1, method: "initialize", params: {} });
      }),
  );
  assert.deepEqual(messages.map((message) => message.method ?? message.error.code), ["pydslrep/crashed", -32603]);
  assert.match(messages[1].error.message, /does not start/);
});

test("the simulator answers a script's requests, and keeps the trace", async () => {
  const found = await page.evaluate(
    async ({ program }) => {
      const { default: init, Simulator, runtimeFiles } = await import("/pydslrep.js");
      await init({ module_or_path: "/pydslrep_bg.wasm" });
      const files = { "/w/square.pyr": program };
      const simulator = new Simulator(JSON.stringify({ files, program: "/w/square.pyr", seed: 1 }));

      // CBOR of what a request has: short texts, and lists and maps of a few.
      const text = (value) => [0x78, value.length, ...new TextEncoder().encode(value)];
      const list = (values) => [0x80 + values.length, ...values.flat()];
      const call = (func, ...args) => {
        const map = [0xa3, text("func"), text(func), text("args"), list(args), text("uuid"), text("test")].flat();
        return simulator.request(1, 7, 0, Uint8Array.from(map));
      };
      const replies = [call("sim.setStepping", [0xf5]), call("sim.startSimulation"), call("sim.step"), call("sim.getSimulationTime")];
      const last = replies.at(-1);
      let refused = "";
      try {
        new Simulator(JSON.stringify({ files, program: "/w/square.pyr", environment: "none" }));
      } catch (error) {
        refused = error.message;
      }
      return {
        counts: replies.map((reply) => reply.length),
        ticket: last[0][0],
        time: new DataView(last[0][1].buffer).getFloat64(last[0][1].length - 8),
        clock: simulator.time,
        robots: simulator.robots,
        poses: Array.from(simulator.poses),
        trace: new TextDecoder().decode(simulator.takeTrace()),
        refused,
        runtime: runtimeFiles().map(([path]) => path),
      };
    },
    { program: square },
  );
  assert.deepEqual(found.counts, [1, 1, 1, 1]);
  assert.deepEqual([found.ticket, found.time, found.clock], [7, 0.05, 0.05]);
  assert.equal(found.poses.length, 3 * found.robots.length);
  const lines = found.trace.trimEnd().split("\n").map((line) => JSON.parse(line));
  assert.deepEqual(lines.map((line) => line.t), [0, 0.05]);
  assert.match(found.refused, /no environment `none`/);
  assert.ok(found.runtime.includes("__init__.py"));
});

test("figures, which no test depends on", async (context) => {
  const figures = await page.evaluate(async () => {
    const uri = "file:///w/long.pyr";
    const lines = Array.from({ length: 990 }, (_, i) => `  move ${(i % 9) + 1}.0 meters`);
    const text = [
      ..."l r".split(" ").map((name) => `wheel ${name} with radius 4.5`),
      "robot a type tw with port 23000 has { l r } wheels",
      "movement m of a {",
      ...lines,
      "}",
      "environment area has { a } robots with { m } moves",
    ].join("\n");
    const client = await Client.start();
    client.open(uri, text);
    await client.problems(uri, () => true);
    const start = performance.now() - client.begin;
    const times = [];
    for (let round = 0; round < 20; round += 1) {
      const begin = performance.now();
      client.change(uri, 500, 2, "x");
      await client.leaveLine(uri);
      await client.problems(uri, (problems) => problems.length > 0);
      times.push(performance.now() - begin);
      client.change(uri, 500, 2, "", 1);
      await client.problems(uri, (problems) => problems.length === 0);
    }
    client.worker.terminate();
    times.sort((a, b) => a - b);
    return { start, median: times[10], slowest: times.at(-1) };
  });
  const shown = Object.entries(figures).map(([name, time]) => `${name} ${time.toFixed(1)} ms`);
  context.diagnostic(`worker start to first diagnostics, keystroke to diagnostics at 1 000 lines: ${shown.join(", ")}`);
});

test("nothing is reported in the console", () => assert.deepEqual(browser.errors, []));
