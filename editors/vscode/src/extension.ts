// The extension's entry point: starts the language server and registers everything that LSP does not cover.
import * as vscode from "vscode";

import { registerCommands } from "./commands";
import { closeAtWholeWords } from "./completion";
import { registerExplanations } from "./explain";
import { registerGhostText } from "./ghost";
import { registerIndentation } from "./indentation";
import { registerMilestones } from "./milestones";
import { registerPreview } from "./preview";
import { registerProcessCommands } from "./process_commands";
import { Session } from "./session";
import { registerStatus } from "./status";
import { registerTasks } from "./tasks";

export function activate(context: vscode.ExtensionContext): void {
  const session = new Session(context);
  context.subscriptions.push(
    session,
    registerCommands(session),
    registerProcessCommands(session),
    registerIndentation(),
    closeAtWholeWords(),
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
    // A trusted workspace may set the server's path.
    vscode.workspace.onDidGrantWorkspaceTrust(() => void session.restart()),
  );
  // Not awaited: a server that never responds must not block the activation of the extension.
  void session.start();
}
