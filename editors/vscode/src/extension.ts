// The extension: starts the language server and adds what the protocol has no word for.
import * as vscode from "vscode";

import { registerCommands } from "./commands";
import { registerExplanations } from "./explain";
import { registerGhostText } from "./ghost";
import { registerIndentation } from "./indentation";
import { registerMilestones } from "./milestones";
import { registerPreview } from "./preview";
import { Session } from "./session";
import { registerStatus } from "./status";
import { registerTasks } from "./tasks";

export function activate(context: vscode.ExtensionContext): void {
  const session = new Session(context);
  context.subscriptions.push(
    session,
    registerCommands(session),
    registerIndentation(),
    registerGhostText(),
    registerMilestones(),
    registerExplanations(() => session.client),
    registerStatus(session),
    registerTasks(session),
    registerPreview(context, session),
    vscode.workspace.onDidChangeConfiguration((event) => {
      if (event.affectsConfiguration("pydslrep.server.path")) {
        void session.restart();
      }
    }),
    // Paths that the workspace names count from now on.
    vscode.workspace.onDidGrantWorkspaceTrust(() => void session.restart()),
  );
  // Nothing waits for it: a server that never answers must not keep anybody from starting another one.
  void session.start();
}
