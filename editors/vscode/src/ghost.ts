// Ghost text in an empty program: what to do with it, gone with the first character.
import * as vscode from "vscode";

const HINT = "Type a program, or press Ctrl+Space for suggestions";

export function registerGhostText(): vscode.Disposable {
  const decoration = vscode.window.createTextEditorDecorationType({
    after: { contentText: HINT, color: new vscode.ThemeColor("editorGhostText.foreground") },
  });
  const show = (editor: vscode.TextEditor) => {
    const { languageId } = editor.document;
    const isEmpty = editor.document.lineCount === 1 && editor.document.lineAt(0).text === "";
    editor.setDecorations(decoration, languageId === "pydslrep" && isEmpty ? [new vscode.Range(0, 0, 0, 0)] : []);
  };
  const showAll = (editors: readonly vscode.TextEditor[]) => editors.forEach(show);
  showAll(vscode.window.visibleTextEditors);
  return vscode.Disposable.from(
    decoration,
    vscode.window.onDidChangeVisibleTextEditors(showAll),
    vscode.workspace.onDidChangeTextDocument(({ document }) => {
      showAll(vscode.window.visibleTextEditors.filter((editor) => editor.document === document));
    }),
  );
}
