// Which environment of a program a command is about.
import * as vscode from "vscode";
import type { LanguageClient } from "vscode-languageclient/node";

import { inform, warn } from "./notifications";
import { PLANNED_AT, type PlannedAt } from "./preview/protocol";

/** What a lens hands to a command: the program's address and the environment's name. */
export interface ChosenEnvironment {
  uri: string;
  environment: string;
}

/** The environment that a command is about: the one at the cursor, else the one that the person chooses. */
export async function chooseEnvironment(
  client: LanguageClient | undefined,
  document: vscode.Uri | undefined,
): Promise<ChosenEnvironment | undefined> {
  const program = await openProgram(document);
  if (program === undefined) {
    inform("Open a program (a file that ends in .pyr) first.");
    return undefined;
  }
  if (client?.isRunning() !== true) {
    const restart = () => vscode.commands.executeCommand("pydslrep.restartServer");
    warn("The language server of PyDSLRep is not running.", { label: "Restart Server", press: restart });
    return undefined;
  }
  const uri = client.code2ProtocolConverter.asUri(program.uri);
  const editor = vscode.window.visibleTextEditors.find((visible) => visible.document === program);
  const position = client.code2ProtocolConverter.asPosition(editor?.selection.active ?? new vscode.Position(0, 0));
  const found = await client.sendRequest<PlannedAt | null>(PLANNED_AT, { textDocument: { uri }, position });
  const names = candidates(found);
  if (names.length === 0) {
    offerEnvironment(program);
    return undefined;
  }
  const environment = names.length === 1 ? names[0] : await vscode.window.showQuickPick(names, { placeHolder: "Which environment?" });
  return environment === undefined ? undefined : { uri, environment };
}

/** The environments that may be meant: those that use what is at the cursor, else all. */
export function candidates(found: PlannedAt | null): string[] {
  if (found === null) {
    return [];
  }
  return found.using.length > 0 ? found.using : found.environments;
}

/** Says that there is nothing to run yet, and what would be. */
function offerEnvironment(program: vscode.TextDocument): void {
  const message = "This program has no environment yet. Add one to say which robots and movements run.";
  inform(message, { label: "Add Environment", press: () => addEnvironment(program) });
}

/** Adds an environment: the one that the server offers, with all robots and movements, else one to fill in. */
export async function addEnvironment(program: vscode.TextDocument): Promise<void> {
  // Not over the preview, whose button asks for it, too.
  const visible = vscode.window.visibleTextEditors.find(({ document }) => document === program);
  const editor = await vscode.window.showTextDocument(program, { viewColumn: visible?.viewColumn ?? vscode.ViewColumn.One });
  const problem = vscode.languages.getDiagnostics(program.uri).find(({ code }) => (typeof code === "object" ? code.value : code) === "no-environment");
  if (problem !== undefined) {
    const kind = vscode.CodeActionKind.QuickFix.value;
    const actions = await vscode.commands.executeCommand<vscode.CodeAction[]>("vscode.executeCodeActionProvider", program.uri, problem.range, kind, 10);
    const edit = actions.find(({ title, edit }) => edit !== undefined && title.includes("environment"))?.edit;
    if (edit !== undefined) {
      await vscode.workspace.applyEdit(edit);
      editor.revealRange(new vscode.Range(program.lineCount, 0, program.lineCount, 0));
      return;
    }
  }
  const end = program.lineAt(program.lineCount - 1).range.end;
  const gap = program.getText().trim() === "" ? "" : end.character > 0 ? "\n\n" : "\n";
  const text = `${gap}environment \${1:area} has { \${2:robots} } robots with { \${3:movements} } moves\n`;
  await editor.insertSnippet(new vscode.SnippetString(text), end);
}

/** The program of this address, or the one in the active editor. */
async function openProgram(uri: vscode.Uri | undefined): Promise<vscode.TextDocument | undefined> {
  const document = uri instanceof vscode.Uri ? await vscode.workspace.openTextDocument(uri) : vscode.window.activeTextEditor?.document;
  return document?.languageId === "pydslrep" ? document : undefined;
}
