// Pages about problems, in the editor: behind the code of each problem, in its light bulb, and by a command.
import * as vscode from "vscode";
import type { LanguageClient } from "vscode-languageclient/node";

import manifest from "../package.json";

/** The scheme of the pages' addresses; the server links codes to them. */
export const PAGES = "pydslrep-page";

/** How VS Code calls its preview of Markdown. */
const PREVIEW = "vscode.markdown.preview.editor";

/** The codes that have a page: those whose severity can be chosen. */
const CODES = new Set(
  manifest.contributes.configuration.flatMap(({ properties }) =>
    "pydslrep.severity" in properties ? Object.keys(properties["pydslrep.severity"].properties) : [],
  ),
);

export function registerExplanations(client: () => LanguageClient | undefined): vscode.Disposable {
  return vscode.Disposable.from(
    vscode.workspace.registerTextDocumentContentProvider(PAGES, {
      provideTextDocumentContent: async ({ path }) => {
        const code = path.replace(/^\/|\.md$/g, "");
        const page = await client()?.sendRequest<{ markdown: string }>("pydslrep/explain", { code });
        return page?.markdown ?? "The language server is not running.";
      },
    }),
    vscode.commands.registerCommand("pydslrep.explainProblem", (code?: unknown) => explain(typeof code === "string" ? code : undefined)),
  );
}

/** What the light bulb offers besides fixes. */
export function explanations(diagnostics: readonly vscode.Diagnostic[]): vscode.CodeAction[] {
  return codesOf(diagnostics).map((code) => {
    const action = new vscode.CodeAction(`Explain this problem: ${code}`, vscode.CodeActionKind.QuickFix);
    action.command = { command: "pydslrep.explainProblem", title: "Explain This Problem", arguments: [code] };
    action.diagnostics = diagnostics.filter((diagnostic) => codeOf(diagnostic) === code);
    return action;
  });
}

async function explain(chosen: string | undefined): Promise<void> {
  const code = chosen ?? (await codeAtCursor());
  if (code === undefined) {
    return;
  }
  const page = vscode.Uri.from({ scheme: PAGES, path: `/${code}.md` });
  await vscode.commands.executeCommand("vscode.openWith", page, PREVIEW, vscode.ViewColumn.Beside);
}

/** The code of the problem at the cursor, else of one on its line. */
async function codeAtCursor(): Promise<string | undefined> {
  const editor = vscode.window.activeTextEditor;
  const all = editor ? vscode.languages.getDiagnostics(editor.document.uri) : [];
  const cursor = editor?.selection.active ?? new vscode.Position(0, 0);
  const there = codesOf(all.filter(({ range }) => range.contains(cursor)));
  const near = there.length > 0 ? there : codesOf(all.filter(({ range }) => range.start.line <= cursor.line && cursor.line <= range.end.line));
  if (near.length === 0) {
    void vscode.window.showInformationMessage("There is no problem on the line of the cursor.");
  }
  return near.length > 1 ? vscode.window.showQuickPick(near, { placeHolder: "Which problem?" }) : near[0];
}

function codesOf(diagnostics: readonly vscode.Diagnostic[]): string[] {
  return [...new Set(diagnostics.map(codeOf).filter((code) => code !== undefined && CODES.has(code)))] as string[];
}

function codeOf({ source, code }: vscode.Diagnostic): string | undefined {
  const value = typeof code === "object" ? code.value : code;
  return source === "pydslrep" && value !== undefined ? String(value) : undefined;
}
