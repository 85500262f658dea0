// The entry point in VS Code for the Web: as src/extension.ts, but the server is a worker, and nothing starts a process.
import * as vscode from "vscode";

import { registerCommands } from "../src/commands";
import { closeAtWholeWords } from "../src/completion";
import { registerExplanations } from "../src/explain";
import { registerGhostText } from "../src/ghost";
import { registerIndentation } from "../src/indentation";
import { registerMilestones } from "../src/milestones";
import { registerPreview } from "../src/preview";
import { registerStatus } from "../src/status";
import { registerUnavailableCommands } from "./unavailable";
import { WorkerSession } from "./session";

export function activate(context: vscode.ExtensionContext): void {
  void vscode.commands.executeCommand("setContext", "pydslrep.inBrowser", true);
  const session = new WorkerSession(context.extensionUri);
  context.subscriptions.push(
    session,
    registerCommands(session),
    registerUnavailableCommands(),
    registerIndentation(),
    closeAtWholeWords(),
    registerGhostText(),
    registerMilestones(),
    registerExplanations(() => session.client),
    registerStatus(session),
    registerPreview(context, session),
  );
  void session.start();
}
