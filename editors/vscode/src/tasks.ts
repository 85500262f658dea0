// Provides tasks for `pydslrep check`, `build` and `run`.
import * as path from "node:path";

import * as vscode from "vscode";

import { findCommand } from "./executables";
import type { Session } from "./session";
import { type Action, type Definition, argumentsOf, nameOf } from "./task_definition";

const TYPE = "pydslrep";

export function registerTasks(session: Session): vscode.Disposable {
  const taskFor = (definition: Definition, folder: vscode.WorkspaceFolder) => createTask(definition, folder, session);
  return vscode.tasks.registerTaskProvider(TYPE, {
    provideTasks: () => (vscode.workspace.workspaceFolders ?? []).flatMap((folder) => definitionsFor(folder).map((definition) => taskFor(definition, folder))),
    resolveTask: ({ definition, scope }) => {
      const folder = typeof scope === "object" ? scope : vscode.workspace.workspaceFolders?.[0];
      return folder && taskFor(definition as Definition & vscode.TaskDefinition, folder);
    },
  });
}

/** Tasks for the whole folder and for the program in the active editor if it is in the folder. */
function definitionsFor(folder: vscode.WorkspaceFolder): Definition[] {
  const definitions: Definition[] = (["check", "build"] as Action[]).map((action) => ({ type: TYPE, action }));
  const document = vscode.window.activeTextEditor?.document;
  if (document?.languageId === "pydslrep" && vscode.workspace.getWorkspaceFolder(document.uri) === folder) {
    definitions.push({ type: TYPE, action: "run", path: path.relative(folder.uri.fsPath, document.uri.fsPath) });
  }
  return definitions;
}

function createTask(definition: Definition, folder: vscode.WorkspaceFolder, session: Session): vscode.Task {
  const command = findCommand(session.searchPaths()) ?? "pydslrep";
  const execution = new vscode.ProcessExecution(command, argumentsOf(definition), { cwd: folder.uri.fsPath });
  // No problem matcher: the server already reports the problems of the workspace.
  const task = new vscode.Task(definition, folder, nameOf(definition), TYPE, execution, []);
  if (definition.action !== "run") {
    task.group = vscode.TaskGroup.Build;
  }
  task.presentationOptions = { clear: true, showReuseMessage: false };
  return task;
}
