// Applies the language's indentation to programs that VS Code opened as plain text.
import * as vscode from "vscode";

const LANGUAGE = "pydslrep";

/**
 * VS Code restores the files of the last session before it has loaded extensions, and a file that becomes a program later
 * keeps the indentation of plain text. Each document is changed only once, so a choice made in the status bar is kept.
 */
export function registerIndentation(): vscode.Disposable {
  const seen = new WeakSet<vscode.TextDocument>();
  const update = (editors: readonly vscode.TextEditor[]) => {
    for (const editor of editors) {
      if (editor.document.languageId === LANGUAGE && !seen.has(editor.document)) {
        seen.add(editor.document);
        setIndentation(editor);
      }
    }
  };
  update(vscode.window.visibleTextEditors);
  return vscode.window.onDidChangeVisibleTextEditors(update);
}

function setIndentation(editor: vscode.TextEditor): void {
  const settings = vscode.workspace.getConfiguration("editor", editor.document);
  // VS Code then takes it from the text.
  if (settings.get("detectIndentation") === true) {
    return;
  }
  editor.options = {
    tabSize: settings.get("tabSize", 2),
    insertSpaces: settings.get("insertSpaces", true),
  };
}
