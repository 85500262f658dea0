// Opens the page of a diagnostic code: from the code's link, from the light bulb and by a command.
import * as vscode from "vscode";
import type { BaseLanguageClient } from "vscode-languageclient";

import manifest from "../package.json";
import { showInformation } from "./notifications";

/** The URI scheme of the pages; the server uses it in the links of codes. */
export const PAGE_SCHEME = "pydslrep-page";

/** The custom editor that previews Markdown in VS Code. */
const MARKDOWN_PREVIEW = "vscode.markdown.preview.editor";

/** The codes that have a page: those with a configurable severity. */
const CODES = new Set(
  manifest.contributes.configuration.flatMap(({ properties }) =>
    "pydslrep.severity" in properties ? Object.keys(properties["pydslrep.severity"].properties) : [],
  ),
);

export function registerExplanations(client: () => BaseLanguageClient | undefined): vscode.Disposable {
  return vscode.Disposable.from(
    vscode.workspace.registerTextDocumentContentProvider(PAGE_SCHEME, {
      provideTextDocumentContent: async ({ path }) => {
        const code = path.replace(/^\/|\.md$/g, "");
        const page = await client()?.sendRequest<{ markdown: string }>("pydslrep/explain", { code });
        return page?.markdown ?? "The language server is not running.";
      },
    }),
    vscode.commands.registerCommand("pydslrep.explainProblem", (code?: unknown) => explain(typeof code === "string" ? code : undefined)),
  );
}

/** The code actions that open pages. */
export function explainActions(diagnostics: readonly vscode.Diagnostic[]): vscode.CodeAction[] {
  return codesWithPage(diagnostics).map((code) => {
    const action = new vscode.CodeAction(`Explain this problem: ${code}`, vscode.CodeActionKind.QuickFix);
    action.command = { command: "pydslrep.explainProblem", title: "Explain This Problem", arguments: [code] };
    action.diagnostics = diagnostics.filter((diagnostic) => pydslrepCodeOf(diagnostic) === code);
    return action;
  });
}

async function explain(requested: string | undefined): Promise<void> {
  const code = requested ?? (await codeAtCursor());
  if (code === undefined) {
    return;
  }
  const page = vscode.Uri.from({ scheme: PAGE_SCHEME, path: `/${code}.md` });
  await vscode.commands.executeCommand("vscode.openWith", page, MARKDOWN_PREVIEW, vscode.ViewColumn.Beside);
}

/** The code of the problem at the cursor, or else of one on its line. */
async function codeAtCursor(): Promise<string | undefined> {
  const editor = vscode.window.activeTextEditor;
  const all = editor ? vscode.languages.getDiagnostics(editor.document.uri) : [];
  const cursor = editor?.selection.active ?? new vscode.Position(0, 0);
  const atCursor = codesWithPage(all.filter(({ range }) => range.contains(cursor)));
  const onLine = () => codesWithPage(all.filter(({ range }) => range.start.line <= cursor.line && cursor.line <= range.end.line));
  const codes = atCursor.length > 0 ? atCursor : onLine();
  if (codes.length === 0) {
    showInformation("There is no problem on this line.");
  }
  return codes.length > 1 ? vscode.window.showQuickPick(codes, { placeHolder: "Which problem?" }) : codes[0];
}

function codesWithPage(diagnostics: readonly vscode.Diagnostic[]): string[] {
  return [...new Set(diagnostics.map(pydslrepCodeOf))].filter((code): code is string => code !== undefined && CODES.has(code));
}

function pydslrepCodeOf(diagnostic: vscode.Diagnostic): string | undefined {
  return diagnostic.source === "pydslrep" ? codeOf(diagnostic) : undefined;
}

export function codeOf({ code }: vscode.Diagnostic): string | undefined {
  const value = typeof code === "object" ? code.value : code;
  return value === undefined ? undefined : String(value);
}
