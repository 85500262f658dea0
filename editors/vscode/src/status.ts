// The server's state in the status bar, under the language's status icon.
import * as vscode from "vscode";

import { DOCUMENTS, type LanguageServer } from "./language_server";

type Status = Pick<vscode.LanguageStatusItem, "text" | "detail" | "severity" | "command">;

const RESTART = { command: "pydslrep.restartServer", title: "Restart Server" };
const OUTPUT = { command: "pydslrep.showOutput", title: "Show Output" };
const SET_PATH = { command: "workbench.action.openSettings", title: "Set Server Path", arguments: ["pydslrep.server.path"] };

export function registerStatus(session: LanguageServer): vscode.Disposable {
  const item = vscode.languages.createLanguageStatusItem("pydslrep.server", [...DOCUMENTS]);
  item.name = "PyDSLRep Language Server";
  const update = () => {
    Object.assign(item, statusOf(session));
    item.busy = session.state === "starting";
  };
  update();
  return vscode.Disposable.from(item, session.onDidChangeState(update));
}

function statusOf(session: LanguageServer): Status {
  const severity = vscode.LanguageStatusSeverity;
  switch (session.state) {
    case "starting":
      return { text: "PyDSLRep is starting", detail: "", severity: severity.Information, command: OUTPUT };
    case "running": {
      const version = session.client?.initializeResult?.serverInfo?.version;
      const origins = { bundled: "bundled server", path: "server from the PATH", setting: "server from the settings" };
      const origin = session.server && origins[session.server.origin];
      return { text: `PyDSLRep ${version ?? ""}`.trim(), detail: `${origin ?? "server in a worker"} is running`, severity: severity.Information, command: RESTART };
    }
    case "stopped":
      return { text: "Server stopped", detail: "completion and checks are off", severity: severity.Error, command: RESTART };
    case "missing":
      return { text: "PyDSLRep has no server", detail: "completion and checks are off", severity: severity.Error, command: SET_PATH };
  }
}
