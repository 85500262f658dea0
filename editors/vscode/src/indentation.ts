// Indentation of a program that was open before VS Code knew its language: it keeps what plain text has.
import * as vscode from "vscode";

const LANGUAGE = "pydslrep";

/**
 * VS Code opens the files of the last session before it has read the extensions, and a file that becomes a program then
 * keeps the indentation of plain text. Each program gets that of its language once, so that a choice in the status bar stays.
 */
export function registerIndentation(): vscode.Disposable {
  const seen = new WeakSet<vscode.TextDocument>();
  const adopt = (editors: readonly vscode.TextEditor[]) => {
    for (const editor of editors) {
      if (editor.document.languageId === LANGUAGE && !seen.has(editor.document)) {
        seen.add(editor.document);
        indent(editor);
      }
    }
  };
  adopt(vscode.window.visibleTextEditors);
  return vscode.window.onDidChangeVisibleTextEditors(adopt);
}

function indent(editor: vscode.TextEditor): void {
  const settings = vscode.workspace.getConfiguration("editor", editor.document);
  // Whoever wants it detected has it from the text.
  if (settings.get("detectIndentation") === true) {
    return;
  }
  editor.options = {
    tabSize: settings.get("tabSize", 2),
    insertSpaces: settings.get("insertSpaces", true),
  };
}
