// Shows the server's diagnostics, but those that the next word of the statement being typed will settle only once the cursor has
// left its line.
import * as vscode from "vscode";

import { isUnsettled, settled, TypedLines } from "./unsettled";

const LANGUAGE = "pydslrep";

export class HeldDiagnostics implements vscode.DiagnosticCollection {
  /** Those of documents that have some to hold back. */
  private readonly held = new Map<string, readonly vscode.Diagnostic[]>();
  private readonly typed = new TypedLines();
  private document: vscode.TextDocument | undefined;
  private readonly subscriptions: vscode.Disposable;

  constructor(private readonly shown: vscode.DiagnosticCollection) {
    this.follow(vscode.window.activeTextEditor);
    this.subscriptions = vscode.Disposable.from(
      vscode.window.onDidChangeActiveTextEditor((editor) => this.follow(editor)),
      vscode.workspace.onDidChangeTextDocument(({ document, contentChanges }) => {
        if (document === this.document && contentChanges.length > 0) {
          this.typed.changed();
        }
      }),
      vscode.window.onDidChangeTextEditorSelection(({ textEditor }) => {
        if (textEditor === vscode.window.activeTextEditor && textEditor.document === this.document) {
          this.typed.moved(cursorLines(textEditor));
          this.update();
        }
      }),
      vscode.workspace.onDidSaveTextDocument((document) => {
        if (document === this.document) {
          this.typed.left();
          this.update();
        }
      }),
    );
  }

  get name(): string {
    return this.shown.name;
  }

  set(uri: vscode.Uri, diagnostics: readonly vscode.Diagnostic[] | undefined): void;
  set(entries: readonly [vscode.Uri, readonly vscode.Diagnostic[] | undefined][]): void;
  set(target: vscode.Uri | readonly [vscode.Uri, readonly vscode.Diagnostic[] | undefined][], diagnostics?: readonly vscode.Diagnostic[]): void {
    const entries = target instanceof vscode.Uri ? [[target, diagnostics] as const] : target;
    for (const [uri, found = []] of entries) {
      if (found.some(isUnsettled)) {
        this.held.set(uri.toString(), found);
      } else {
        this.held.delete(uri.toString());
      }
      this.shown.set(uri, settled(found, this.linesOf(uri)));
    }
  }

  delete(uri: vscode.Uri): void {
    this.held.delete(uri.toString());
    this.shown.delete(uri);
  }

  clear(): void {
    this.held.clear();
    this.shown.clear();
  }

  forEach(callback: (uri: vscode.Uri, diagnostics: readonly vscode.Diagnostic[], collection: vscode.DiagnosticCollection) => unknown): void {
    this.shown.forEach((uri, diagnostics) => callback(uri, diagnostics, this));
  }

  get(uri: vscode.Uri): readonly vscode.Diagnostic[] | undefined {
    return this.shown.get(uri);
  }

  has(uri: vscode.Uri): boolean {
    return this.shown.has(uri);
  }

  [Symbol.iterator](): Iterator<[uri: vscode.Uri, diagnostics: readonly vscode.Diagnostic[]]> {
    return this.shown[Symbol.iterator]();
  }

  dispose(): void {
    this.subscriptions.dispose();
    this.shown.dispose();
  }

  private follow(editor: vscode.TextEditor | undefined): void {
    this.typed.left();
    this.update();
    this.document = editor?.document.languageId === LANGUAGE ? editor.document : undefined;
    this.typed.moved(editor === undefined ? [] : cursorLines(editor));
  }

  /** Shows those that are no longer held back. */
  private update(): void {
    const uri = this.document?.uri;
    const found = this.held.get(uri?.toString() ?? "");
    if (uri === undefined || found === undefined) {
      return;
    }
    const shown = settled(found, this.linesOf(uri));
    if (shown.length !== this.shown.get(uri)?.length) {
      this.shown.set(uri, shown);
    }
  }

  private linesOf(uri: vscode.Uri): ReadonlySet<number> {
    return uri.toString() === this.document?.uri.toString() ? this.typed.lines : new Set();
  }
}

function cursorLines(editor: vscode.TextEditor): number[] {
  return [...new Set(editor.selections.map(({ active }) => active.line))];
}
