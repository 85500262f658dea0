// The commands of the palette and the menus. The client library registers those of the server.
import * as vscode from "vscode";
import type { Location, Position } from "vscode-languageclient/node";

import manifest from "../package.json";
import { findCommandLine, runCommandLine } from "./command_line";
import { chooseEnvironment } from "./environments";
import { reached } from "./milestones";
import { showInformation } from "./notifications";
import type { Session } from "./session";
import { showStatistics } from "./statistics";

export function registerCommands(session: Session): vscode.Disposable {
  const onEnvironment = (command: string) => async (uri?: vscode.Uri) => {
    const environment = await chooseEnvironment(session.client, uri);
    return environment && vscode.commands.executeCommand(command, environment);
  };
  const commands: Record<string, (...args: never[]) => unknown> = {
    "pydslrep.runInSimulator": onEnvironment("pydslrep.run"),
    "pydslrep.stopRun": () => session.runs.stop(),
    "pydslrep.generate": onEnvironment("pydslrep.generateScript"),
    "pydslrep.newProgram": () => newProgram(session),
    "pydslrep.newFile": () => newFile(),
    "pydslrep.showStatistics": () => showStatistics(session),
    "pydslrep.showVersion": () => showVersion(session),
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

/** Opens an empty, unsaved program. */
async function newFile(): Promise<void> {
  await vscode.window.showTextDocument(await vscode.workspace.openTextDocument({ language: "pydslrep" }));
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

/** Shows the versions of the extension and of the server. */
function showVersion(session: Session): void {
  const server = session.client?.initializeResult?.serverInfo?.version;
  const running = server === undefined ? "no server running" : `server ${server}`;
  const versions = `PyDSLRep ${manifest.version}, ${running} (${session.server?.command ?? "none found"})`;
  showInformation(versions, { label: "Copy", press: () => vscode.env.clipboard.writeText(versions) });
}
