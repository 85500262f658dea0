// The worker that runs scripts, one after another: Python as WebAssembly, and a simulator for each that answers it at once.
import { files as python, wheels } from "virtual:python";
import { loadPyodide, type PyodideAPI } from "pyodide";

import type { FromRun, Results, Task } from "./messages";
import { Simulated, type Reply } from "./simulator";
import { Tracks } from "./tracks";

/** The home of scripts, and the folder of the modules that they import. */
const HOME = "/home/pydslrep";
const MODULES = "/lib/pydslrep";
const TRACE = `${HOME}/trace.jsonl`;
const MAP = `${HOME}/map.json`;

/** How often the page is told where the robots are, milliseconds. */
const PERIOD = 100;

function post(message: FromRun): void {
  self.postMessage(message);
}

async function prepare(): Promise<PyodideAPI> {
  const folder = new URL("pyodide/", self.location.href);
  const pyodide = await loadPyodide({ indexURL: folder.href });
  await install(pyodide, wheels.map((name) => new URL(name, folder).href));
  for (const [path, text] of Object.entries(python)) {
    const file = `${MODULES}/${path}`;
    pyodide.FS.mkdirTree(file.slice(0, file.lastIndexOf("/")));
    pyodide.FS.writeFile(file, text);
  }
  pyodide.FS.mkdirTree(HOME);
  pyodide.FS.chdir(HOME);
  pyodide.runPython(`import sys; sys.path.insert(0, "${MODULES}")`);
  return pyodide;
}

/** Installs packages; Pyodide itself only says what it cannot load. */
async function install(pyodide: PyodideAPI, addresses: string[]): Promise<void> {
  const problems: string[] = [];
  const options = { messageCallback: () => undefined, errorCallback: (text: string) => problems.push(text) };
  const installed = await pyodide.loadPackage(addresses, options);
  if (installed.length < addresses.length) throw new Error(problems.join("\n"));
}

const prepared = prepare();
prepared.then(
  () => post({ type: "ready" }),
  (error: unknown) => post({ type: "failed", message: `Python cannot be loaded: ${String(error)}` }),
);

self.addEventListener("message", (event: MessageEvent<Task>) => {
  run(event.data).catch((error: unknown) => post({ type: "failed", message: error instanceof Error ? error.message : String(error) }));
});

async function run(task: Task): Promise<void> {
  const [pyodide, simulated] = await Promise.all([prepared, Simulated.start(task.world)]);
  const watch = new Watch(pyodide);
  empty(pyodide);
  pyodide.registerJsModule("_pydslrep_simulator", bridge(pyodide, simulated, watch));
  pyodide.FS.writeFile(`${HOME}/${task.file}`, task.script);
  const { start } = pyodide.pyimport("_pydslrep_start") as { start: (...values: unknown[]) => number };
  const options = ["--host", "127.0.0.1", "--trace", TRACE, "--map", MAP, ...task.arguments];
  const code = start(
    task.file,
    pyodide.toPy(options),
    (text: string) => post({ type: "output", text, isError: false }),
    (text: string) => post({ type: "output", text, isError: true }),
  );
  watch.look(true);
  simulated.end();
  post({ type: "ended", code, results: results(pyodide) });
}

/** Removes what an earlier script has written. */
function empty({ FS }: PyodideAPI): void {
  for (const name of FS.readdir(HOME)) {
    const path = `${HOME}/${name}`;
    if (FS.isFile(FS.stat(path).mode)) FS.unlink(path);
  }
}

/** What the stand-in for the client's sockets calls: it gets replies, each with the connection that it is for. */
function bridge(pyodide: PyodideAPI, simulated: Simulated, watch: Watch) {
  const replies = (found: Reply[]): unknown => pyodide.toPy(found);
  return {
    exchange: (connection: number, request: { toJs(): Uint8Array; destroy(): void }): unknown => {
      const message = request.toJs();
      request.destroy();
      watch.look(false);
      return replies(simulated.request(connection, message));
    },
    disconnect: (connection: number): unknown => replies(simulated.disconnect(connection)),
  };
}

function results(pyodide: PyodideAPI): Results {
  return { trace: readText(pyodide, TRACE) ?? "", map: readText(pyodide, MAP) };
}

function readText(pyodide: PyodideAPI, path: string): string | null {
  return pyodide.FS.analyzePath(path, false).exists ? pyodide.FS.readFile(path, { encoding: "utf8" }) : null;
}

/** Reads the trace while the script writes it. */
class Watch {
  private readonly tracks = new Tracks();
  private readonly decoder = new TextDecoder();
  private offset = 0;
  private due = 0;

  constructor(private readonly pyodide: PyodideAPI) {}

  /** Tells the page about progress if it is time, or at the end. */
  look(isEnd: boolean): void {
    const now = performance.now();
    if (now < this.due && !isEnd) return;
    this.due = now + PERIOD;
    this.read(isEnd ? TRACE : `${TRACE}.partial`);
    post({ type: "driven", time: this.tracks.time, robots: this.tracks.robots(isEnd ? readText(this.pyodide, MAP) : null) });
  }

  private read(path: string): void {
    const { FS } = this.pyodide;
    if (!FS.analyzePath(path, false).exists) return;
    const stream = FS.open(path, "r");
    const bytes = new Uint8Array(Math.max(FS.stat(path).size - this.offset, 0));
    FS.read(stream, bytes, 0, bytes.length, this.offset);
    FS.close(stream);
    this.offset += bytes.length;
    this.tracks.read(this.decoder.decode(bytes, { stream: true }));
  }
}
