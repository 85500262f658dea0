// Tasks for the command `pydslrep`: check, build, run.
import * as path from "node:path";

import * as vscode from "vscode";

import { findCommand } from "./executables";
import type { Session } from "./session";
import { type Action, type Definition, argumentsOf, nameOf } from "./task_definition";

const TYPE = "pydslrep";

export function registerTasks(session: Session): vscode.Disposable {
  const make = (definition: Definition, folder: vscode.WorkspaceFolder) => task(definition, folder, session);
  return vscode.tasks.registerTaskProvider(TYPE, {
    provideTasks: () => (vscode.workspace.workspaceFolders ?? []).flatMap((folder) => offered(folder).map((definition) => make(definition, folder))),
    resolveTask: ({ definition, scope }) => {
      const folder = typeof scope === "object" ? scope : vscode.workspace.workspaceFolders?.[0];
      return folder && make(definition as Definition & vscode.TaskDefinition, folder);
    },
  });
}

/** Tasks for a whole folder, and for the program in the active editor if it is in there. */
function offered(folder: vscode.WorkspaceFolder): Definition[] {
  const all: Definition[] = (["check", "build"] as Action[]).map((action) => ({ type: TYPE, action }));
  const document = vscode.window.activeTextEditor?.document;
  if (document?.languageId === "pydslrep" && vscode.workspace.getWorkspaceFolder(document.uri) === folder) {
    all.push({ type: TYPE, action: "run", path: path.relative(folder.uri.fsPath, document.uri.fsPath) });
  }
  return all;
}

function task(definition: Definition, folder: vscode.WorkspaceFolder, session: Session): vscode.Task {
  const command = findCommand(session.places()) ?? "pydslrep";
  const execution = new vscode.ProcessExecution(command, argumentsOf(definition), { cwd: folder.uri.fsPath });
  // The server reports the problems of a workspace by itself: a matcher would double them.
  const made = new vscode.Task(definition, folder, nameOf(definition), TYPE, execution, []);
  if (definition.action !== "run") {
    made.group = vscode.TaskGroup.Build;
  }
  made.presentationOptions = { clear: true, showReuseMessage: false };
  return made;
}
