// Running a program: only where the workspace is trusted, and what it drew is shown beside the program.
import { readFile } from "node:fs/promises";

import * as vscode from "vscode";

import type { ChosenEnvironment } from "./middleware";

/** What the server answers when a run has come to its end. */
interface Driven {
  /** The address of the picture. */
  picture: string;
  /** What was printed: the table of poses and times. */
  output: string;
}

/** Runs an environment, and shows its picture. */
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
    const drawing = await readFile(vscode.Uri.parse(answer.picture).fsPath, "utf8");
    show(chosen, drawing, answer.output);
  }
  return answer;
}

function isDriven(answer: unknown): answer is Driven {
  return typeof answer === "object" && answer !== null && "picture" in answer && "output" in answer;
}

/** The panel of each environment, by the program's address and its name. */
const panels = new Map<string, vscode.WebviewPanel>();

function show({ uri, environment }: ChosenEnvironment, drawing: string, output: string): void {
  const key = `${uri}#${environment}`;
  let panel = panels.get(key);
  if (panel === undefined) {
    const place = { viewColumn: vscode.ViewColumn.Beside, preserveFocus: true };
    panel = vscode.window.createWebviewPanel("pydslrep.driven", `Driven: ${environment}`, place, { enableFindWidget: true });
    panels.set(key, panel);
    panel.onDidDispose(() => panels.delete(key));
  } else {
    panel.reveal(undefined, true);
  }
  panel.webview.html = page(drawing, output);
}

/** The picture above the table; no script and nothing from elsewhere. */
function page(drawing: string, output: string): string {
  const picture = `data:image/svg+xml;base64,${Buffer.from(drawing).toString("base64")}`;
  return `<!DOCTYPE html>
<html lang="en">
<head>
<meta charset="utf-8">
<meta http-equiv="Content-Security-Policy" content="default-src 'none'; img-src data:; style-src 'unsafe-inline'">
<style>
body { margin: 0; padding: 12px; }
img { display: block; width: 100%; max-height: 75vh; object-fit: contain; border-radius: 4px; }
pre { font-family: var(--vscode-editor-font-family); font-size: 12px; overflow-x: auto; }
</style>
</head>
<body>
<img src="${picture}" alt="Planned and driven path">
<pre>${escape(output)}</pre>
</body>
</html>`;
}

function escape(text: string): string {
  return text.replaceAll("&", "&amp;").replaceAll("<", "&lt;");
}
