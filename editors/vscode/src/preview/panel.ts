// The panel beside the text: passes on between the follower, the editor and the page.
import { randomUUID } from "node:crypto";

import * as vscode from "vscode";

import { Follower, type Ask } from "./follower";
import { exportPath, type Drawn } from "./export";
import { fromPage, type ToPage } from "./messages";
import { page } from "./page";
import type { NumberedAction, Which } from "./protocol";
import { addEnvironment } from "../environments";
import { reached } from "../milestones";

/** The panel's type, which VS Code restores it by. */
export const PANEL = "pydslrep.preview";

/** Whether a document can have a path. */
export function isProgram(document: vscode.TextDocument): boolean {
  return document.languageId === "pydslrep";
}

export class PreviewPanel {
  private readonly follower: Follower;
  private readonly subscriptions: vscode.Disposable[] = [];
  /** Who waits for the page's picture. */
  private awaiting: ((data: string) => void) | undefined;

  constructor(
    private readonly panel: vscode.WebviewPanel,
    extension: vscode.Uri,
    ask: Ask,
    private readonly draw: (which: Which) => Promise<Drawn | undefined>,
  ) {
    this.follower = new Follower(ask, (message) => this.show(message));
    const dist = vscode.Uri.joinPath(extension, "dist");
    const { webview } = panel;
    webview.options = { enableScripts: true, localResourceRoots: [dist] };
    this.subscriptions.push(
      webview.onDidReceiveMessage((message: unknown) => this.hear(message)),
      vscode.window.onDidChangeActiveTextEditor((editor) => {
        if (editor) this.look(editor);
      }),
      vscode.window.onDidChangeTextEditorSelection(({ textEditor }) => this.look(textEditor)),
      vscode.workspace.onDidChangeTextDocument(({ document }) => this.textChanged(document)),
    );
    panel.onDidDispose(() => {
      for (const subscription of this.subscriptions) subscription.dispose();
    });
    webview.html = page({
      source: webview.cspSource,
      script: webview.asWebviewUri(vscode.Uri.joinPath(dist, "preview.js")).toString(),
      style: webview.asWebviewUri(vscode.Uri.joinPath(dist, "preview.css")).toString(),
      nonce: randomUUID(),
    });
  }

  /** Shows a program in it, and comes to the front. */
  async follow(uri: vscode.Uri, environment?: string): Promise<void> {
    const editor = vscode.window.visibleTextEditors.find((visible) => visible.document.uri.toString() === uri.toString());
    this.panel.title = `Path: ${uri.path.slice(uri.path.lastIndexOf("/") + 1)}`;
    await this.follower.follow(uri.toString(), editor?.selection.active ?? new vscode.Position(0, 0), environment);
  }

  reveal(): void {
    this.panel.reveal(undefined, true);
  }

  pathChanged(which: Which): Promise<void> {
    return this.follower.pathChanged(which);
  }

  drivenChanged(which: Which): Promise<void> {
    return this.follower.drivenChanged(which);
  }

  /** Asks for everything again, for instance of a server that was restarted. */
  refresh(): Promise<void> {
    return this.follower.again();
  }

  /** What is shown. */
  get which(): Which | undefined {
    return this.follower.which;
  }

  /** Writes what is shown into a file that the person chooses. */
  async export(): Promise<void> {
    const { which } = this.follower;
    if (which !== undefined) {
      await exportPath(which, () => this.draw(which), () => this.picture());
    }
  }

  /** The picture in the page, as an address with a PNG in it. */
  private picture(): Promise<string> {
    return new Promise((resolve) => {
      this.awaiting = resolve;
      this.show({ type: "draw" });
    });
  }

  private show(message: ToPage): void {
    if (message.type === "path") reached("preview");
    void this.panel.webview.postMessage(message);
  }

  private look(editor: vscode.TextEditor): void {
    if (!isProgram(editor.document)) return;
    const uri = editor.document.uri;
    if (uri.toString() !== this.follower.program) {
      if (editor === vscode.window.activeTextEditor) void this.follow(uri);
    } else {
      void this.follower.look(editor.selection.active, true);
    }
  }

  /** Text may change without the cursor: by an undo, or in another editor. */
  private textChanged(document: vscode.TextDocument): void {
    const editor = vscode.window.visibleTextEditors.find((visible) => visible.document === document);
    if (document.uri.toString() === this.follower.program) {
      void this.follower.look(editor?.selection.active ?? new vscode.Position(0, 0));
    }
  }

  private hear(message: unknown): void {
    const heard = fromPage(message);
    if (heard?.type === "ready") void this.follower.again();
    else if (heard?.type === "choose") void this.follower.choose(heard.environment);
    else if (heard?.type === "reveal") void this.select(heard.action);
    else if (heard?.type === "export") void this.export();
    else if (heard?.type === "picture") this.awaiting?.(heard.data);
    else if (heard?.type === "remedy") void this.remedy();
  }

  private async remedy(): Promise<void> {
    const { program } = this.follower;
    if (program !== undefined) await addEnvironment(await vscode.workspace.openTextDocument(vscode.Uri.parse(program)));
  }

  /** Selects an action in the editor; the focus stays in the panel, where one may go on to the next. */
  private async select(action: NumberedAction): Promise<void> {
    const found = await this.follower.place(action);
    if (!found) return;
    const { start, end } = found.range;
    const uri = vscode.Uri.parse(found.uri);
    const editor = vscode.window.visibleTextEditors.find((visible) => visible.document.uri.toString() === uri.toString());
    const column = editor?.viewColumn ?? (this.panel.viewColumn === vscode.ViewColumn.One ? vscode.ViewColumn.Beside : vscode.ViewColumn.One);
    await vscode.window.showTextDocument(uri, {
      selection: new vscode.Range(start.line, start.character, end.line, end.character),
      viewColumn: column,
      preserveFocus: true,
    });
  }
}
