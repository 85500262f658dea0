// The commands of the palette and the menus. Those of the server itself are registered by the client library.
import { execFile } from "node:child_process";
import { promisify } from "node:util";

import * as vscode from "vscode";
import type { Location, Position } from "vscode-languageclient/node";

import manifest from "../package.json";
import { chooseEnvironment } from "./environments";
import { sentence } from "./failure";
import { fail } from "./notifications";
import { reached } from "./milestones";
import { findCommand } from "./executables";
import type { Session } from "./session";
import { showStatistics, showVersion } from "./statistics";

export function registerCommands(session: Session): vscode.Disposable {
  const onEnvironment = (command: string) => async (uri?: vscode.Uri) => {
    const chosen = await chooseEnvironment(session.client, uri);
    return chosen && vscode.commands.executeCommand(command, chosen);
  };
  const commands: Record<string, (...args: never[]) => unknown> = {
    "pydslrep.runInSimulator": onEnvironment("pydslrep.run"),
    "pydslrep.stopRun": () => session.runs.stop(),
    "pydslrep.generate": onEnvironment("pydslrep.generateScript"),
    "pydslrep.newProgram": () => newProgram(session),
    "pydslrep.newFile": () => newFile(),
    "pydslrep.showStatistics": () => showStatistics(session),
    "pydslrep.showVersion": () => showVersion(session, manifest.version),
    "pydslrep.restartServer": () => session.restart(),
    "pydslrep.showOutput": () => session.output.show(),
    "pydslrep.showReferences": (uri: string, position: Position, locations: Location[]) => {
      const convert = session.client?.protocol2CodeConverter;
      return (
        convert &&
        vscode.commands.executeCommand(
          "editor.action.showReferences",
          convert.asUri(uri),
          convert.asPosition(position),
          locations.map((location) => convert.asLocation(location)),
        )
      );
    },
  };
  return vscode.Disposable.from(
    ...Object.entries(commands).map(([name, run]) => vscode.commands.registerCommand(name, run)),
  );
}

/** An empty program that is not saved yet. */
async function newFile(): Promise<void> {
  await vscode.window.showTextDocument(await vscode.workspace.openTextDocument({ language: "pydslrep" }));
}

/** Asks for a name, and has the command `pydslrep` write a program to start from. */
async function newProgram(session: Session): Promise<void> {
  const command = findCommand(session.places());
  if (command === undefined) {
    fail("There is no command `pydslrep`: neither in the extension nor beside the server nor on the PATH.");
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
  try {
    await promisify(execFile)(command, ["new", name], { cwd: folder.fsPath });
  } catch (error) {
    const printed = (error as { stderr?: string }).stderr?.trim();
    fail(sentence(printed === undefined || printed === "" ? String(error) : printed));
    return;
  }
  reached("program");
  await vscode.window.showTextDocument(vscode.Uri.joinPath(folder, name, `${name}.pyr`));
}

async function chooseFolder(): Promise<vscode.Uri | undefined> {
  const chosen = await vscode.window.showOpenDialog({
    canSelectFiles: false,
    canSelectFolders: true,
    openLabel: "Create Here",
  });
  return chosen?.[0];
}
