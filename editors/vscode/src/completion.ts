// Keeps the list of completions out of the way of typing.
import * as vscode from "vscode";

import { filterTexts } from "./filter_texts";

/** The words of the last list. */
let offered: ReadonlySet<string> = new Set();

/** Items that the editor filters itself, so that an answer that is late changes nothing. */
export function filteredHere(found: vscode.CompletionItem[] | vscode.CompletionList): vscode.CompletionList {
  const items = Array.isArray(found) ? found : found.items;
  const words = items.map(({ label, filterText, kind }) => {
    const text = filterText ?? (typeof label === "string" ? label : label.label);
    // The names of files may have blanks; in other labels, what follows the first word is not typed as part of it.
    return kind === vscode.CompletionItemKind.File ? text : (text.split(" ", 1)[0] ?? "");
  });
  offered = new Set(words);
  const filters = filterTexts(words);
  for (const [index, item] of items.entries()) {
    item.filterText = filters[index] ?? " ";
  }
  return new vscode.CompletionList(items, false);
}

/** Closes a list that is open once one of its words is typed in full, even if others begin with it. */
export function closeAtWholeWords(): vscode.Disposable {
  return vscode.workspace.onDidChangeTextDocument(({ document, contentChanges: [change] }) => {
    if (change === undefined || document.languageId !== "pydslrep" || document !== vscode.window.activeTextEditor?.document) {
      return;
    }
    const end = document.positionAt(change.rangeOffset + change.text.length);
    const word = document.getWordRangeAtPosition(end);
    if (change.text !== "" && word?.end.isEqual(end) && offered.has(document.getText(word))) {
      void vscode.commands.executeCommand("hideSuggestWidget");
    }
  });
}
