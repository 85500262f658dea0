// The commands that start a process.
import * as vscode from "vscode";

import { findCommandLine, runCommandLine } from "./command_line";
import { onEnvironment } from "./environments";
import { reached } from "./milestones";
import type { Session } from "./session";
import { showStatistics } from "./statistics";

export function registerProcessCommands(session: Session): vscode.Disposable {
  return vscode.Disposable.from(
    vscode.commands.registerCommand("pydslrep.runInSimulator", onEnvironment(session, "pydslrep.run")),
    vscode.commands.registerCommand("pydslrep.stopRun", () => session.runs.stop()),
    vscode.commands.registerCommand("pydslrep.pushToCoppeliaSim", onEnvironment(session, "pydslrep.pushScene")),
    vscode.commands.registerCommand("pydslrep.checkInCoppeliaSim", onEnvironment(session, "pydslrep.checkScene")),
    vscode.commands.registerCommand("pydslrep.removeFromCoppeliaSim", onEnvironment(session, "pydslrep.removeScene")),
    vscode.commands.registerCommand("pydslrep.newProgram", () => newProgram(session)),
    vscode.commands.registerCommand("pydslrep.showStatistics", () => showStatistics(session)),
  );
}

/** Asks for a name and creates a program with `pydslrep new`. */
async function newProgram(session: Session): Promise<void> {
  const command = findCommandLine(session);
  if (command === undefined) {
    return;
  }
  const folder = vscode.workspace.workspaceFolders?.[0]?.uri ?? (await chooseFolder());
  const name = folder && (await vscode.window.showInputBox({
    title: "New PyDSLRep Program",
    prompt: `Program name (creates NAME/NAME.pyr in ${folder.fsPath})`,
    value: "patrol",
    validateInput: (text) =>
      /^[A-Za-z_]\w*$/.test(text) ? undefined : "Use letters, digits and underscores; don't start with a digit",
  }));
  if (folder === undefined || name === undefined) {
    return;
  }
  if ((await runCommandLine(command, ["new", name], folder.fsPath)) !== undefined) {
    reached("program");
    await vscode.window.showTextDocument(vscode.Uri.joinPath(folder, name, `${name}.pyr`));
  }
}

async function chooseFolder(): Promise<vscode.Uri | undefined> {
  const chosen = await vscode.window.showOpenDialog({
    canSelectFiles: false,
    canSelectFolders: true,
    openLabel: "Create Here",
  });
  return chosen?.[0];
}
