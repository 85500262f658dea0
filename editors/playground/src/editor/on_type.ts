// Formatting while typing: asks the server after a new line and after `}`, as other editors do.
import { LSPPlugin } from "@codemirror/lsp-client";
import { ChangeSet, type Extension, type Transaction } from "@codemirror/state";
import { EditorView } from "@codemirror/view";
import type { TextEdit } from "vscode-languageserver-protocol";

/** The character after which the server formats, if a transaction has typed one. */
function typedCharacter(transaction: Transaction): string | undefined {
  if (!transaction.docChanged || !transaction.isUserEvent("input") || transaction.isUserEvent("input.complete")) return undefined;
  let typed: string | undefined;
  transaction.changes.iterChanges((_from, _to, _start, _end, inserted) => {
    if (inserted.lines > 1 && /^\s*$/.test(inserted.toString())) typed = "\n";
    else if (inserted.toString() === "}") typed = "}";
  });
  return typed;
}

function request(view: EditorView, character: string): void {
  const plugin = LSPPlugin.get(view);
  if (!plugin) return;
  const { client, uri } = plugin;
  client.sync();
  const params = {
    textDocument: { uri },
    position: plugin.toPosition(view.state.selection.main.head),
    ch: character,
    options: { tabSize: view.state.tabSize, insertSpaces: true },
  };
  void client
    .withMapping(async (mapping) => {
      const edits = await client.request<typeof params, TextEdit[] | null>("textDocument/onTypeFormatting", params);
      const changes = (edits ?? []).map(({ range, newText }) => {
        const from = mapping.mapPosition(uri, range.start, -1);
        return { from, to: Math.max(from, mapping.mapPosition(uri, range.end, -1)), insert: newText };
      });
      if (changes.length === 0) return;
      const change = ChangeSet.of(changes, view.state.doc.length);
      // The cursor stays behind what is inserted at it: the indentation of its line.
      view.dispatch({ changes: change, selection: view.state.selection.map(change, 1), userEvent: "format" });
    })
    // Without an answer the text stays as it is.
    .catch(() => undefined);
}

export const formatOnType: Extension = EditorView.updateListener.of(({ view, transactions }) => {
  const typed = transactions.map(typedCharacter).find((character) => character !== undefined);
  if (typed !== undefined) queueMicrotask(() => request(view, typed));
});
