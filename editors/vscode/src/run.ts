// Runs programs in trusted workspaces and shows the driven path in the preview.
import * as vscode from "vscode";

import { type Connection, executeWithProgress } from "./execute";
import { type Figures, summary } from "./figures";
import { reached } from "./milestones";
import { type Button, showError, showInformation, showWarning } from "./notifications";
import { type EnvironmentId, keyOf, type Location } from "../../preview/host/protocol";

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

/** How a run ended, in words, and what to do next. */
export interface Outcome {
  message: string;
  isError: boolean;
  buttons: Button[];
}

/** The runs of this window. */
export class Runs implements vscode.Disposable {
  private readonly running = new Set<vscode.CancellationTokenSource>();
  private readonly pictures = new Map<string, Pictures>();
  private readonly tables = vscode.window.createOutputChannel("PyDSLRep Runs");
  /** The actions that failed in the latest run. */
  private readonly failures = vscode.languages.createDiagnosticCollection("pydslrep-run");
  /** Shows what a run said in a place that covers nothing; false where there is none, and a notification has to. */
  show: ((outcome: Outcome | undefined, environment: EnvironmentId) => boolean) | undefined;

  constructor(private readonly connection: Connection) {
    connection.markFailure = (location, message) => this.markFailure(location, message);
  }

  /** Runs an environment and shows the driven path. */
  async run(environment: EnvironmentId): Promise<unknown> {
    if (!vscode.workspace.isTrusted) {
      askForTrust();
      return undefined;
    }
    const cancellation = new vscode.CancellationTokenSource();
    this.running.add(cancellation);
    this.updateContext();
    this.failures.clear();
    this.show?.(undefined, environment);
    const report = (message: string, ...buttons: Button[]) => this.tell({ message, isError: true, buttons }, environment);
    try {
      const result = await executeWithProgress(this.connection, "pydslrep.run", environment, cancellation, undefined, report);
      if (isRunResult(result)) {
        await this.showResult(environment, result);
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
    this.failures.dispose();
  }

  private updateContext(): void {
    void vscode.commands.executeCommand("setContext", "pydslrep.isRunning", this.running.size > 0);
  }

  private async showResult(environment: EnvironmentId, result: RunResult): Promise<void> {
    reached("run");
    this.pictures.set(keyOf(environment), result);
    this.tables.appendLine(`${result.output.trimEnd()}\n`);
    const buttons = [{ label: "Show Table", press: () => this.tables.show(true) }];
    await this.showInPreview({ message: summary(result.figures), isError: false, buttons }, environment);
  }

  /** Says how a run ended: in the preview if that is visible, where it covers neither legend nor slider. */
  private tell(outcome: Outcome, environment: EnvironmentId): void {
    if (this.show?.(outcome, environment)) return;
    const notify = outcome.isError ? showError : showInformation;
    notify(outcome.message, ...outcome.buttons, { label: "Show Path", press: () => this.showInPreview(outcome, environment) });
  }

  /** Brings the preview to the front and says there how a run ended. */
  private async showInPreview(outcome: Outcome, environment: EnvironmentId): Promise<void> {
    await showPath(environment);
    this.tell(outcome, environment);
  }

  private markFailure({ uri, range: { start, end } }: Location, message: string): void {
    const range = new vscode.Range(start.line, start.character, end.line, end.character);
    const diagnostic = new vscode.Diagnostic(range, message, vscode.DiagnosticSeverity.Error);
    diagnostic.source = "pydslrep run";
    this.failures.set(vscode.Uri.parse(uri), [diagnostic]);
  }
}

function showPath(environment: EnvironmentId): Thenable<unknown> {
  return vscode.commands.executeCommand("pydslrep.showPreview", vscode.Uri.parse(environment.uri), environment.environment);
}

export function askForTrust(): void {
  const manage = { label: "Manage Workspace Trust", press: () => vscode.commands.executeCommand("workbench.trust.manage") };
  showWarning("Programs run only in workspaces that you trust.", manage);
}

function isRunResult(answer: unknown): answer is RunResult {
  return typeof answer === "object" && answer !== null && "figures" in answer && answer.figures !== null;
}
