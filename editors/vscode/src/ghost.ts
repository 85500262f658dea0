// Ghost text in an empty program that says how to begin; it disappears with the first character.
import * as vscode from "vscode";

const HINT = "Type a program, or press Ctrl+Space for suggestions";

export function registerGhostText(): vscode.Disposable {
  const decoration = vscode.window.createTextEditorDecorationType({
    after: { contentText: HINT, color: new vscode.ThemeColor("editorGhostText.foreground") },
  });
  const update = (editor: vscode.TextEditor) => {
    const { languageId } = editor.document;
    const isEmpty = editor.document.lineCount === 1 && editor.document.lineAt(0).text === "";
    editor.setDecorations(decoration, languageId === "pydslrep" && isEmpty ? [new vscode.Range(0, 0, 0, 0)] : []);
  };
  const updateAll = (editors: readonly vscode.TextEditor[]) => editors.forEach(update);
  updateAll(vscode.window.visibleTextEditors);
  return vscode.Disposable.from(
    decoration,
    vscode.window.onDidChangeVisibleTextEditors(updateAll),
    vscode.workspace.onDidChangeTextDocument(({ document }) => {
      updateAll(vscode.window.visibleTextEditors.filter((editor) => editor.document === document));
    }),
  );
}
