// Running a program: only where the workspace is trusted; the preview then shows what was driven over what was planned.
import * as vscode from "vscode";

import type { ChosenEnvironment } from "./environments";
import { executeLong, type Surroundings } from "./execute";
import { inform } from "./notifications";
import { reached } from "./milestones";

/** What the server answers when a run has come to its end. */
interface Driven {
  /** What was printed: the table of poses and times. */
  output: string;
  /** Addresses of what was drawn, for as long as the server runs; the preview draws it, too. */
  picture?: string | null;
  replay?: string | null;
}

/** Pictures of the latest run of an environment. */
export type Pictures = Pick<Driven, "picture" | "replay">;

/** The runs of this window. */
export class Runs implements vscode.Disposable {
  private readonly running = new Set<vscode.CancellationTokenSource>();
  private readonly drawn = new Map<string, Pictures>();
  private readonly tables = vscode.window.createOutputChannel("PyDSLRep Runs");

  constructor(private readonly around: Surroundings) {}

  /** Runs an environment, and shows the path that was driven. */
  async run(chosen: ChosenEnvironment): Promise<unknown> {
    if (!vscode.workspace.isTrusted) {
      await askForTrust();
      return undefined;
    }
    const stop = new vscode.CancellationTokenSource();
    this.running.add(stop);
    this.tell();
    try {
      const answer = await executeLong(this.around, "pydslrep.run", chosen, stop);
      if (isDriven(answer)) {
        this.end(chosen, answer);
      }
      return answer;
    } finally {
      this.running.delete(stop);
      this.tell();
      stop.dispose();
    }
  }

  /** Ends what runs. */
  stop(): void {
    for (const stop of this.running) {
      stop.cancel();
    }
  }

  /** What the latest run of an environment has drawn, if there was one since the server was started. */
  picturesOf(chosen: ChosenEnvironment): Pictures | undefined {
    return this.drawn.get(nameOf(chosen));
  }

  /** A server that is started again has other pictures. */
  forget(): void {
    this.drawn.clear();
  }

  dispose(): void {
    this.stop();
    this.tables.dispose();
  }

  private tell(): void {
    void vscode.commands.executeCommand("setContext", "pydslrep.isRunning", this.running.size > 0);
  }

  private end(chosen: ChosenEnvironment, driven: Driven): void {
    reached("run");
    this.drawn.set(nameOf(chosen), driven);
    this.tables.appendLine(`${driven.output.trimEnd()}\n`);
    const showPath = () => vscode.commands.executeCommand("pydslrep.showPreview", vscode.Uri.parse(chosen.uri), chosen.environment);
    inform(summary(driven.output), { label: "Show Path", press: showPath }, { label: "Show Table", press: () => this.tables.show(true) });
    void showPath();
  }
}

async function askForTrust(): Promise<void> {
  const manage = "Manage Workspace Trust";
  if ((await vscode.window.showWarningMessage("Programs are run only in workspaces that you trust.", manage)) === manage) {
    await vscode.commands.executeCommand("workbench.trust.manage");
  }
}

function nameOf({ uri, environment }: ChosenEnvironment): string {
  return `${environment} ${uri}`;
}

function isDriven(answer: unknown): answer is Driven {
  return typeof answer === "object" && answer !== null && "output" in answer && typeof answer.output === "string";
}

/** The line that says how long it took. */
export function summary(output: string): string {
  const lines = output.split("\n").map((line) => line.trim());
  return lines.find((line) => /^\S+: .* simulated in /.test(line)) ?? "The run has ended.";
}
