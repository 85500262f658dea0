// The commands of the palette and the menus that work everywhere. The client library registers those of the server.
import * as vscode from "vscode";
import type { Location, Position } from "vscode-languageclient";

import manifest from "../package.json";
import { onEnvironment } from "./environments";
import type { LanguageServer, ServerState } from "./language_server";
import { showInformation } from "./notifications";

/** What to say of a server that is no program. */
const WITHOUT_PROGRAM: Record<ServerState, string> = { starting: "in a worker", running: "in a worker", stopped: "in a worker", missing: "none found" };

export function registerCommands(session: LanguageServer): vscode.Disposable {
  const commands: Record<string, (...args: never[]) => unknown> = {
    "pydslrep.generate": onEnvironment(session, "pydslrep.generateScript"),
    "pydslrep.newFile": () => newFile(),
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

/** Shows the versions of the extension and of the server. */
function showVersion(session: LanguageServer): void {
  const server = session.client?.initializeResult?.serverInfo?.version;
  const running = server === undefined ? "no server running" : `server ${server}`;
  const versions = `PyDSLRep ${manifest.version}, ${running} (${session.server?.command ?? WITHOUT_PROGRAM[session.state]})`;
  showInformation(versions, { label: "Copy", press: () => vscode.env.clipboard.writeText(versions) });
}
