// Determines the environment of a program that a command applies to.
import * as vscode from "vscode";
import type { BaseLanguageClient } from "vscode-languageclient";

import type { Connection } from "./execute";
import { codeOf } from "./explain";
import { showInformation, showWarning } from "./notifications";
import { PLANNED_AT, type EnvironmentId, type PlannedAt } from "../../preview/host/protocol";

/** So many programs are offered. */
const MAX_PROGRAMS = 1000;

export const OPEN_A_PROGRAM = "Open a program (a .pyr file) first.";

/** A command on the environment at the cursor of a program. */
export function onEnvironment(connection: Connection, command: string): (uri?: vscode.Uri) => Promise<unknown> {
  return async (uri) => {
    const environment = await chooseEnvironment(connection.client, uri);
    return environment && vscode.commands.executeCommand(command, environment);
  };
}

/** The environment at the cursor; if there are several, the one that the user picks. */
export async function chooseEnvironment(
  client: BaseLanguageClient | undefined,
  document: vscode.Uri | undefined,
): Promise<EnvironmentId | undefined> {
  const program = await chooseProgram(document);
  if (program === undefined) {
    return undefined;
  }
  if (client?.isRunning() !== true) {
    const restart = () => vscode.commands.executeCommand("pydslrep.restartServer");
    showWarning("The PyDSLRep language server is not running.", { label: "Restart Server", press: restart });
    return undefined;
  }
  const uri = client.code2ProtocolConverter.asUri(program.uri);
  const editor = vscode.window.visibleTextEditors.find((visible) => visible.document === program);
  const position = client.code2ProtocolConverter.asPosition(editor?.selection.active ?? new vscode.Position(0, 0));
  const found = await client.sendRequest<PlannedAt | null>(PLANNED_AT, { textDocument: { uri }, position });
  const names = candidates(found);
  if (names.length === 0 && isScene(program)) {
    showInformation("No program beside this scene has an environment of its name.");
    return undefined;
  }
  if (names.length === 0) {
    offerToAddEnvironment(program);
    return undefined;
  }
  const environment = names.length === 1 ? names[0] : await vscode.window.showQuickPick(names, { placeHolder: "Which environment?" });
  return environment === undefined ? undefined : { uri: found?.program ?? uri, environment };
}

/** The environments that use what is at the cursor, or all if none does. */
function candidates(found: PlannedAt | null): string[] {
  if (found === null) {
    return [];
  }
  return found.using.length > 0 ? found.using : found.environments;
}

function offerToAddEnvironment(program: vscode.TextDocument): void {
  const message = "This program has no environment yet. Add one to say which robots and movements run.";
  showInformation(message, { label: "Add Environment", press: () => addEnvironment(program) });
}

/**
 * Adds the environment that the server's quick fix offers, with all robots and movements, or else a snippet. Its name is
 * selected, to be changed at once; what the editor shows stays where it is.
 */
export async function addEnvironment(program: vscode.TextDocument): Promise<void> {
  // The button may be in the preview, which must not be covered.
  const visible = vscode.window.visibleTextEditors.find(({ document }) => document === program);
  const editor = await vscode.window.showTextDocument(program, { viewColumn: visible?.viewColumn ?? vscode.ViewColumn.One });
  const problem = vscode.languages.getDiagnostics(program.uri).find((diagnostic) => codeOf(diagnostic) === "no-environment");
  if (problem !== undefined) {
    const kind = vscode.CodeActionKind.QuickFix.value;
    const actions = await vscode.commands.executeCommand<vscode.CodeAction[]>("vscode.executeCodeActionProvider", program.uri, problem.range, kind, 10);
    const edit = actions.find(({ title, edit }) => edit !== undefined && title.includes("environment"))?.edit;
    if (edit !== undefined) {
      await vscode.workspace.applyEdit(edit);
      const name = nameOfLastEnvironment(program);
      if (name) editor.selection = new vscode.Selection(name.start, name.end);
      return;
    }
  }
  const end = program.lineAt(program.lineCount - 1).range.end;
  const gap = program.getText().trim() === "" ? "" : end.character > 0 ? "\n\n" : "\n";
  const text = `${gap}environment \${1:area} has { \${2:robots} } robots with { \${3:movements} } moves\n`;
  await editor.insertSnippet(new vscode.SnippetString(text), end);
}

function nameOfLastEnvironment(program: vscode.TextDocument): vscode.Range | undefined {
  const match = [...program.getText().matchAll(/^environment +(\^?\w+)/gm)].at(-1);
  if (!match) return undefined;
  const [whole, name = ""] = match;
  const end = match.index + whole.length;
  return new vscode.Range(program.positionAt(end - name.length), program.positionAt(end));
}

export function isProgram(document: vscode.TextDocument): boolean {
  return document.languageId === "pydslrep";
}

/** Whether a document is the scene of an environment. */
export function isScene(document: vscode.TextDocument): boolean {
  return document.uri.path.endsWith(".scene.toml");
}

/**
 * The program or scene with this URI, or the one in the active editor. Commands also come from elsewhere, such as the
 * walkthrough: then the one that is visible, or the one that the user picks; undefined if there is none, which the user is
 * told.
 */
export async function chooseProgram(uri: vscode.Uri | undefined): Promise<vscode.TextDocument | undefined> {
  const isOurs = (document: vscode.TextDocument) => isProgram(document) || isScene(document);
  if (uri instanceof vscode.Uri) {
    const document = await vscode.workspace.openTextDocument(uri);
    if (isOurs(document)) return document;
  }
  const { activeTextEditor, visibleTextEditors } = vscode.window;
  if (activeTextEditor && isOurs(activeTextEditor.document)) return activeTextEditor.document;
  const visible = visibleTextEditors.map(({ document }) => document).find(isProgram);
  return visible ?? (await pickProgram());
}

async function pickProgram(): Promise<vscode.TextDocument | undefined> {
  const found = await vscode.workspace.findFiles("**/*.pyr", undefined, MAX_PROGRAMS);
  if (found.length === 0) {
    showInformation(OPEN_A_PROGRAM);
    return undefined;
  }
  const items = found.map((uri) => ({ label: vscode.workspace.asRelativePath(uri), uri })).sort((a, b) => a.label.localeCompare(b.label));
  const picked = items.length === 1 ? items[0] : await vscode.window.showQuickPick(items, { placeHolder: "Which program?" });
  if (!picked) return undefined;
  return (await vscode.window.showTextDocument(picked.uri)).document;
}
