// Runs programs in trusted workspaces and shows the driven path in the preview.
import * as vscode from "vscode";

import { type Connection, executeWithProgress } from "./execute";
import { type Figures, summary } from "./figures";
import { reached } from "./milestones";
import { showInformation, showWarning } from "./notifications";
import { type EnvironmentId, keyOf } from "../../preview/host/protocol";

/** The server's answer to `pydslrep.run`. */
interface RunResult {
  /** The printed table of poses and times. */
  output: string;
  figures: Figures;
  /** URIs of the drawn files; they exist as long as the server runs. */
  picture?: string | null;
  replay?: string | null;
}

/** The pictures of the latest run of an environment. */
export type Pictures = Pick<RunResult, "picture" | "replay">;

/** The runs of this window. */
export class Runs implements vscode.Disposable {
  private readonly running = new Set<vscode.CancellationTokenSource>();
  private readonly pictures = new Map<string, Pictures>();
  private readonly tables = vscode.window.createOutputChannel("PyDSLRep Runs");

  constructor(private readonly connection: Connection) {}

  /** Runs an environment and shows the driven path. */
  async run(environment: EnvironmentId): Promise<unknown> {
    if (!vscode.workspace.isTrusted) {
      askForTrust();
      return undefined;
    }
    const cancellation = new vscode.CancellationTokenSource();
    this.running.add(cancellation);
    this.updateContext();
    try {
      const result = await executeWithProgress(this.connection, "pydslrep.run", environment, cancellation);
      if (isRunResult(result)) {
        this.showResult(environment, result);
      }
      return result;
    } finally {
      this.running.delete(cancellation);
      this.updateContext();
      cancellation.dispose();
    }
  }

  /** Cancels all runs. */
  stop(): void {
    for (const cancellation of this.running) {
      cancellation.cancel();
    }
  }

  /** The pictures of the latest run of an environment since the server started. */
  picturesOf(environment: EnvironmentId): Pictures | undefined {
    return this.pictures.get(keyOf(environment));
  }

  /** The pictures are deleted when the server exits. */
  forgetPictures(): void {
    this.pictures.clear();
  }

  dispose(): void {
    this.stop();
    this.tables.dispose();
  }

  private updateContext(): void {
    void vscode.commands.executeCommand("setContext", "pydslrep.isRunning", this.running.size > 0);
  }

  private showResult(environment: EnvironmentId, result: RunResult): void {
    reached("run");
    this.pictures.set(keyOf(environment), result);
    this.tables.appendLine(`${result.output.trimEnd()}\n`);
    const showPath = () => vscode.commands.executeCommand("pydslrep.showPreview", vscode.Uri.parse(environment.uri), environment.environment);
    showInformation(summary(result.figures), { label: "Show Path", press: showPath }, { label: "Show Table", press: () => this.tables.show(true) });
    void showPath();
  }
}

export function askForTrust(): void {
  const manage = { label: "Manage Workspace Trust", press: () => vscode.commands.executeCommand("workbench.trust.manage") };
  showWarning("Programs run only in workspaces that you trust.", manage);
}

function isRunResult(answer: unknown): answer is RunResult {
  return typeof answer === "object" && answer !== null && "figures" in answer && answer.figures !== null;
}
