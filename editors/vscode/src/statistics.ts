// Compares the length of the program in the editor with that of its generated scripts.
import * as path from "node:path";

import * as vscode from "vscode";

import { findCommandLine, runCommandLine } from "./command_line";
import { OPEN_A_PROGRAM } from "./environments";
import { showInformation } from "./notifications";
import type { Session } from "./session";

/** Lines of a program and of the Python generated from it. */
interface Lines {
  program: number;
  python: number;
  /** Percent. */
  saved: number;
}

/** What `pydslrep stats --json` prints. */
interface Statistics {
  environments: ({ environment: string } & Lines)[];
  total: Lines;
  /** Lines of the package that scripts import. */
  runtime: number;
}

/** Counts the text in the editor, saved or not. */
export async function showStatistics(session: Session): Promise<void> {
  const document = vscode.window.activeTextEditor?.document;
  if (document?.languageId !== "pydslrep") {
    showInformation(OPEN_A_PROGRAM);
    return;
  }
  const command = findCommandLine(session);
  if (command === undefined) {
    return;
  }
  const folder = document.uri.scheme === "file" ? path.dirname(document.uri.fsPath) : vscode.workspace.workspaceFolders?.[0]?.uri.fsPath;
  const json = await runCommandLine(command, ["stats", "-", "--json"], folder, document.getText());
  if (json !== undefined) {
    showInformation(summary(JSON.parse(json) as Statistics));
  }
}

function summary({ environments, total, runtime }: Statistics): string {
  const [only, ...others] = environments;
  if (only === undefined) {
    return "Every environment of this program has errors, so there is no script to compare with.";
  }
  const name = others.length === 0 ? only.environment : `${environments.length} environments`;
  const fewer = total.saved > 0 ? ` (${total.saved.toFixed(0)} % fewer)` : "";
  return `${name}: ${total.program} lines of program generate ${total.python} lines of Python${fewer}, which import a package of ${runtime}.`;
}
