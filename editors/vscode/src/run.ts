// Running a program: only where the workspace is trusted; the preview then shows what was driven over what was planned.
import * as vscode from "vscode";

import type { ChosenEnvironment } from "./environments";

/** What the server answers when a run has come to its end; there is a picture, too, which the preview draws better. */
interface Driven {
  /** What was printed: the table of poses and times. */
  output: string;
}

/** Tables of runs. */
let runs: vscode.OutputChannel | undefined;

/** Runs an environment, and shows the path that was driven. */
export async function runInSimulator(chosen: ChosenEnvironment, run: () => unknown): Promise<unknown> {
  if (!vscode.workspace.isTrusted) {
    const manage = "Manage Workspace Trust";
    const text = "Programs are run only in workspaces that you trust.";
    if ((await vscode.window.showWarningMessage(text, manage)) === manage) {
      await vscode.commands.executeCommand("workbench.trust.manage");
    }
    return undefined;
  }
  const answer = await run();
  if (isDriven(answer)) {
    void tell(answer.output);
    void vscode.commands.executeCommand("pydslrep.showPreview", vscode.Uri.parse(chosen.uri), chosen.environment);
  }
  return answer;
}

function isDriven(answer: unknown): answer is Driven {
  return typeof answer === "object" && answer !== null && "output" in answer && typeof answer.output === "string";
}

/** Says in a line how it went, and keeps the table for whoever wants it. */
async function tell(output: string): Promise<void> {
  runs ??= vscode.window.createOutputChannel("PyDSLRep Runs");
  runs.appendLine(`${output.trimEnd()}\n`);
  const show = "Show Table";
  if ((await vscode.window.showInformationMessage(summary(output), show)) === show) {
    runs.show(true);
  }
}

/** The line that says how long it took. */
export function summary(output: string): string {
  const lines = output.split("\n").map((line) => line.trim());
  return lines.find((line) => /^\S+: .* simulated in /.test(line)) ?? "The program was driven.";
}
