// Which environment of a program a command is about.
import * as vscode from "vscode";
import type { LanguageClient } from "vscode-languageclient/node";

/** What a lens hands to a command: the program's address and the environment's name. */
export interface ChosenEnvironment {
  uri: string;
  environment: string;
}

interface Lens {
  range: { start: { line: number } };
  command?: { command: string; arguments?: unknown[] };
}

/** The environment that a command is about, once the person has chosen where there are several. */
export async function chooseEnvironment(
  client: LanguageClient | undefined,
  document: vscode.Uri | undefined,
): Promise<ChosenEnvironment | undefined> {
  const program = await openProgram(document);
  if (program === undefined) {
    void vscode.window.showInformationMessage("Open a program (a file that ends in .pyr) first.");
    return undefined;
  }
  if (client?.isRunning() !== true) {
    void vscode.window.showWarningMessage("The language server of PyDSLRep is not running: see the output PyDSLRep.");
    return undefined;
  }
  const lenses = await client.sendRequest<Lens[] | null>("textDocument/codeLens", {
    textDocument: { uri: client.code2ProtocolConverter.asUri(program.uri) },
  });
  const environments = environmentsOf(lenses ?? []);
  if (environments.length > 1) {
    return pick(environments);
  }
  if (environments.length === 0) {
    void vscode.window.showInformationMessage(
      "This program has no environment yet: one says which robots and movements run, as in `environment yard has { rover } robots with { patrol } moves`.",
    );
  }
  return environments[0];
}

/** The environments that the server offers to run, in the order of the program. */
export function environmentsOf(lenses: readonly Lens[]): ChosenEnvironment[] {
  const runs = lenses.filter(({ command }) => command?.command === "pydslrep.run");
  return runs.flatMap(({ command }) => (command?.arguments ?? []) as ChosenEnvironment[]);
}

async function pick(environments: ChosenEnvironment[]): Promise<ChosenEnvironment | undefined> {
  const items = environments.map((chosen) => ({ label: chosen.environment, chosen }));
  const picked = await vscode.window.showQuickPick(items, { placeHolder: "Which environment?" });
  return picked?.chosen;
}

/** The program of this address, or the one in the active editor. */
async function openProgram(uri: vscode.Uri | undefined): Promise<vscode.TextDocument | undefined> {
  const document = uri instanceof vscode.Uri ? await vscode.workspace.openTextDocument(uri) : vscode.window.activeTextEditor?.document;
  return document?.languageId === "pydslrep" ? document : undefined;
}
