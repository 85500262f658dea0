// What the status bar says about the server, behind the braces beside the language's name.
import * as vscode from "vscode";

import { DOCUMENTS, type ServerState, type Session } from "./session";

interface Words {
  text: string;
  detail: string;
  severity: vscode.LanguageStatusSeverity;
  command: vscode.Command;
}

const RESTART = { command: "pydslrep.restartServer", title: "Restart Server" };
const OUTPUT = { command: "pydslrep.showOutput", title: "Show Output" };

export function registerStatus(session: Session): vscode.Disposable {
  const item = vscode.languages.createLanguageStatusItem("pydslrep.server", [...DOCUMENTS]);
  item.name = "PyDSLRep Language Server";
  const show = () => {
    const words = wordsFor(session.state, session);
    item.text = words.text;
    item.detail = words.detail;
    item.severity = words.severity;
    item.command = words.command;
    item.busy = session.state === "starting";
  };
  show();
  return vscode.Disposable.from(item, session.onDidChangeState(show));
}

function wordsFor(state: ServerState, session: Session): Words {
  switch (state) {
    case "starting":
      return { text: "PyDSLRep is starting", detail: "", severity: vscode.LanguageStatusSeverity.Information, command: OUTPUT };
    case "running": {
      const version = session.client?.initializeResult?.serverInfo?.version;
      const origin = { bundled: "of the extension", path: "on the PATH", setting: "of the settings" };
      const from = session.program && origin[session.program.origin];
      return {
        text: `PyDSLRep ${version ?? ""}`.trim(),
        detail: `server ${from ?? ""} is running`,
        severity: vscode.LanguageStatusSeverity.Information,
        command: RESTART,
      };
    }
    case "stopped":
      return { text: "Server stopped", detail: "completion and checks are off", severity: vscode.LanguageStatusSeverity.Error, command: RESTART };
    case "missing":
      return {
        text: "PyDSLRep has no server",
        detail: "completion and checks are off",
        severity: vscode.LanguageStatusSeverity.Error,
        command: { command: "workbench.action.openSettings", title: "Set a Path", arguments: ["pydslrep.server.path"] },
      };
  }
}
