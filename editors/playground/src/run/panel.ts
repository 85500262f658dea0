// Runs: the button, the worker, progress, output, and what a run wrote.
import type { DrivenPath, EnvironmentId, PlannedPath } from "../../../preview/host/protocol";
import { PLANNED_PATH } from "../../../preview/host/protocol";
import { degrees, fixed } from "../../../preview/page/format";
import type { Connection } from "../connection";
import type { Editors } from "../editors";
import { button, byId, element } from "../elements";
import { save, type Preview } from "../preview";
import { slamArguments } from "./arguments";
import type { FromRun, Results, Task } from "./messages";

interface Parts {
  connection: Connection;
  editors: Editors;
  preview: Preview;
  /** Files that programs may import, by URI. */
  imported: Record<string, string>;
}

/** A run that has begun. */
interface Run {
  id: EnvironmentId;
  script: string;
  planned: PlannedPath;
  begin: number;
  driven: DrivenPath;
}

const ENDINGS: Record<number, string> = { 0: "Done", 1: "A movement failed", 130: "Interrupted" };

export class RunPanel {
  private readonly toggleButton = byId<HTMLButtonElement>("run");
  private readonly panel = byId("output");
  private readonly log = byId("log");
  private readonly status = byId("status");
  private readonly progress = byId<HTMLProgressElement>("progress");
  private readonly downloads = byId("downloads");
  /** The worker of the next run or of the current one. It outlives runs, because it takes seconds to load Python. */
  private worker: Worker | undefined;
  private isPythonReady = false;
  private run: Run | undefined;
  private environment: EnvironmentId | undefined;
  /** How the latest run ended, until another one starts. */
  private ended: { id: EnvironmentId; text: string } | undefined;
  /** Counts what the user asked for, so that late answers are ignored. */
  private asked = 0;

  constructor(private readonly parts: Parts) {
    this.toggleButton.addEventListener("click", () => this.toggle());
  }

  toggle(): void {
    if (this.toggleButton.dataset.running === "true") this.stop();
    else void this.start();
  }

  setEnvironment(environment: EnvironmentId | undefined): void {
    this.environment = environment;
    void this.showScript();
  }

  /** A text has changed. */
  textChanged(): void {
    void this.showScript();
  }

  /** There is another path, or none: says so where a run has ended, because its result stays. */
  pathChanged(): void {
    if (!this.ended) return;
    const { id, text } = this.ended;
    const status = this.parts.preview.hasChangedSinceRun(id) ? `${text}. The program has changed since` : text;
    if (status !== this.status.textContent) this.say(status);
  }

  /** Shows the script of the environment, if its tab is open. */
  async showScript(): Promise<void> {
    const { editors } = this.parts;
    if (editors.isScriptShown) editors.script.text = await this.script().catch((error: unknown) => `# ${messageOf(error)}\n`);
  }

  stop(): void {
    if (this.toggleButton.dataset.running !== "true") return;
    this.asked += 1;
    const isBusy = this.run !== undefined;
    this.end();
    // Nothing else stops a script. The next run need not wait for Python.
    if (isBusy) {
      this.discard();
      this.prepare();
    }
    this.say("Stopped");
  }

  private async script(): Promise<string> {
    const { environment } = this;
    if (!environment) throw new Error("The program has no environment yet");
    this.parts.editors.sync();
    const found = (await this.parts.connection.request("pydslrep/script", environment)) as { text: string };
    return found.text;
  }

  private async start(): Promise<void> {
    const asked = ++this.asked;
    const { editors, connection, preview } = this.parts;
    this.panel.hidden = false;
    this.ended = undefined;
    this.log.replaceChildren();
    this.downloads.replaceChildren();
    this.setRunning(true);
    this.progress.removeAttribute("value");
    const worker = this.prepare();
    this.say(this.isPythonReady ? "Starting …" : "Loading Python …");
    try {
      const script = await this.script();
      const id = this.environment;
      if (!id || asked !== this.asked) return;
      const planned = (await connection.request(PLANNED_PATH, id)) as PlannedPath;
      if (asked !== this.asked) return;
      await preview.setDriven(id, undefined);
      this.run = { id, script, planned, begin: performance.now(), driven: { environment: id.environment, robots: [], planned } };
      if (this.isPythonReady) this.say("Running …");
      const world = { environment: id.environment, program: id.uri, files: { ...this.parts.imported, ...editors.files } };
      worker.postMessage({ file: `${fileName(id.environment)}.py`, script, world, arguments: slamArguments(planned) } satisfies Task);
    } catch (error) {
      if (asked === this.asked) this.fail(messageOf(error));
    }
  }

  private receive(message: FromRun): void {
    const { run } = this;
    if (message.type === "ready") {
      this.isPythonReady = true;
      if (!run) return;
      this.say("Running …");
      run.begin = performance.now();
      return;
    }
    if (!run) {
      // Without Python, the next run has to load it again.
      if (message.type === "failed") this.discard();
      return;
    }
    switch (message.type) {
      case "output":
        this.print(message.text, message.isError);
        break;
      case "driven":
        run.driven = { ...run.driven, robots: message.robots };
        this.showProgress(run, message.time);
        void this.parts.preview.setDriven(run.id, run.driven);
        break;
      case "ended":
        this.finish(run, message.code, message.results);
        break;
      case "failed":
        // The simulator, or Python itself: neither can go on.
        this.discard();
        this.fail(message.message);
        break;
    }
  }

  private showProgress(run: Run, time: number): void {
    const duration = run.planned.duration;
    if (duration !== null && duration > 0) this.progress.value = Math.min(time / duration, 1);
    const of = duration === null ? "" : ` of ${seconds(duration)}`;
    this.say(`Running: ${seconds(time)}${of} simulated`, false);
  }

  private finish(run: Run, code: number, results: Results): void {
    const wall = (performance.now() - run.begin) / 1000;
    const time = Math.max(0, ...run.driven.robots.map(({ poses }) => poses.at(-1)?.t ?? 0));
    this.end();
    this.progress.value = 1;
    this.ended = { id: run.id, text: `${ENDINGS[code] ?? "The run failed"}: ${seconds(time)} simulated in ${seconds(wall)}` };
    this.say(this.ended.text);
    this.pathChanged();
    this.panel.dataset.code = `${code}`;
    this.log.append(this.table(run));
    this.log.scrollTop = this.log.scrollHeight;
    this.offer("Script", `${run.id.environment}.py`, run.script);
    if (results.trace !== "") this.offer("Trace", `${run.id.environment}_trace.jsonl`, results.trace);
    if (results.map !== null) this.offer("Map", `${run.id.environment}_map.json`, results.map);
    this.downloads.append(button("Picture", () => void this.parts.preview.download()));
  }

  /** Where each robot was to end, and where it ended. */
  private table({ driven, planned }: Run): HTMLElement {
    const rows = driven.robots.map(({ name, poses }) => {
      const end = poses.at(-1);
      const robot = planned.robots.find((found) => found.name === name);
      const goal = robot?.unknownAfter === null ? robot.poses.at(-1) : undefined;
      const off = end && goal ? `${(1000 * Math.hypot(end.x - goal.x, end.y - goal.y)).toFixed(1)} mm` : "—";
      const cells = [name, pose(goal), pose(end), off];
      return element("tr", {}, ...cells.map((cell, column) => element(column === 0 ? "th" : "td", column === 0 ? { scope: "row" } : {}, cell)));
    });
    const titles = ["Robot", "Planned end", "Driven end", "Off"].map((title) => element("th", { scope: "col" }, title));
    return element("table", {}, element("thead", {}, element("tr", {}, ...titles)), element("tbody", {}, ...rows));
  }

  private offer(label: string, name: string, text: string): void {
    this.downloads.append(button(label, () => save(name, new Blob([text], { type: "text/plain" })), { title: `Download ${name}` }));
  }

  private fail(message: string): void {
    this.end();
    this.print(message, true);
    this.say("The run failed");
    this.panel.dataset.code = "2";
  }

  /** A worker with Python, loaded or being loaded. */
  private prepare(): Worker {
    if (this.worker) return this.worker;
    const worker = (this.worker = new Worker("run.js", { type: "module", name: "run" }));
    worker.addEventListener("message", ({ data }: MessageEvent<FromRun>) => worker === this.worker && this.receive(data));
    return worker;
  }

  private discard(): void {
    this.worker?.terminate();
    this.worker = undefined;
    this.isPythonReady = false;
  }

  private end(): void {
    this.run = undefined;
    this.setRunning(false);
  }

  private setRunning(isRunning: boolean): void {
    this.toggleButton.dataset.running = `${isRunning}`;
    this.toggleButton.textContent = isRunning ? "Stop" : "Run";
    this.panel.dataset.running = `${isRunning}`;
    if (isRunning) delete this.panel.dataset.code;
    this.progress.hidden = !isRunning;
  }

  private print(text: string, isError: boolean): void {
    const isAtEnd = this.log.scrollTop + this.log.clientHeight >= this.log.scrollHeight - 4;
    this.log.append(element("span", isError ? { class: "error" } : {}, `${text}\n`));
    if (isAtEnd) this.log.scrollTop = this.log.scrollHeight;
  }

  /** Shows the state; what changes all the time is not read out. */
  private say(text: string, isSpoken = true): void {
    this.status.ariaLive = isSpoken ? "polite" : "off";
    this.status.textContent = text;
  }
}

function fileName(environment: string): string {
  return environment.replaceAll(/[^\p{L}\p{N}_-]/gu, "_");
}

function seconds(value: number): string {
  return `${value.toFixed(1)} s`;
}

function pose(found: { x: number; y: number; theta: number } | undefined): string {
  if (!found) return "—";
  return `${fixed(found.x, 3)} m, ${fixed(found.y, 3)} m, ${degrees(found.theta)}`;
}

function messageOf(error: unknown): string {
  return error instanceof Error ? error.message : String(error);
}
