// The preview's panel: passes messages between the follower, the editor and the page.
import { randomUUID } from "node:crypto";

import * as vscode from "vscode";

import { addEnvironment } from "../environments";
import { reached } from "../milestones";
import { type Drawings, exportPath } from "./export";
import { Follower, type Request } from "./follower";
import { fromPage, type ToPage } from "./messages";
import { page } from "./page";
import type { EnvironmentId, NumberedAction } from "./protocol";

/** VS Code restores panels by their type. */
export const PANEL_TYPE = "pydslrep.preview";

export function isProgram(document: vscode.TextDocument): boolean {
  return document.languageId === "pydslrep";
}

export class PreviewPanel {
  private readonly follower: Follower;
  private readonly subscriptions: vscode.Disposable[] = [];
  /** Resolves the pending capture. */
  private captured: ((png: string) => void) | undefined;

  constructor(
    private readonly panel: vscode.WebviewPanel,
    extension: vscode.Uri,
    request: Request,
    private readonly draw: (environment: EnvironmentId) => Promise<Drawings | undefined>,
  ) {
    this.follower = new Follower(request, (message) => this.post(message));
    const dist = vscode.Uri.joinPath(extension, "dist");
    const { webview } = panel;
    webview.options = { enableScripts: true, localResourceRoots: [dist] };
    this.subscriptions.push(
      webview.onDidReceiveMessage((message: unknown) => this.receive(message)),
      vscode.window.onDidChangeActiveTextEditor((editor) => {
        if (editor) this.cursorMoved(editor);
      }),
      vscode.window.onDidChangeTextEditorSelection(({ textEditor }) => this.cursorMoved(textEditor)),
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

  /** Shows a program. */
  async follow(uri: vscode.Uri, environment?: string): Promise<void> {
    this.panel.title = `Path: ${uri.path.slice(uri.path.lastIndexOf("/") + 1)}`;
    const cursor = visibleEditor(uri)?.selection.active ?? new vscode.Position(0, 0);
    await this.follower.follow(uri.toString(), cursor, environment);
  }

  reveal(): void {
    this.panel.reveal(undefined, true);
  }

  pathChanged(environment: EnvironmentId): Promise<void> {
    return this.follower.pathChanged(environment);
  }

  drivenChanged(environment: EnvironmentId): Promise<void> {
    return this.follower.drivenChanged(environment);
  }

  /** Requests everything again, for example from a restarted server. */
  refresh(): Promise<void> {
    return this.follower.resend();
  }

  get shown(): EnvironmentId | undefined {
    return this.follower.shown;
  }

  /** Exports the shown path to a file that the user chooses. */
  async export(): Promise<void> {
    const { shown } = this;
    if (shown !== undefined) {
      await exportPath(shown, () => this.draw(shown), () => this.capture());
    }
  }

  /** The page's picture as a data URI. */
  private capture(): Promise<string> {
    return new Promise((resolve) => {
      this.captured = resolve;
      this.post({ type: "capture" });
    });
  }

  private post(message: ToPage): void {
    if (message.type === "path") reached("preview");
    void this.panel.webview.postMessage(message);
  }

  private cursorMoved(editor: vscode.TextEditor): void {
    if (!isProgram(editor.document)) return;
    const uri = editor.document.uri;
    if (uri.toString() !== this.follower.program) {
      if (editor === vscode.window.activeTextEditor) void this.follow(uri);
    } else {
      void this.follower.update(editor.selection.active, true);
    }
  }

  /** Text may change without the cursor: by undo, or in another editor. */
  private textChanged({ uri }: vscode.TextDocument): void {
    if (uri.toString() === this.follower.program) {
      void this.follower.update(visibleEditor(uri)?.selection.active ?? new vscode.Position(0, 0));
    }
  }

  private receive(received: unknown): void {
    const message = fromPage(received);
    switch (message?.type) {
      case "ready":
        void this.follower.resend();
        break;
      case "select":
        void this.follower.select(message.environment);
        break;
      case "reveal":
        void this.revealAction(message.action);
        break;
      case "accept":
        void this.addEnvironment();
        break;
      case "export":
        void this.export();
        break;
      case "captured":
        this.captured?.(message.png);
        break;
    }
  }

  private async addEnvironment(): Promise<void> {
    const { program } = this.follower;
    if (program !== undefined) await addEnvironment(await vscode.workspace.openTextDocument(vscode.Uri.parse(program)));
  }

  /** Selects an action in the editor; the panel keeps the focus, so the user can move on to the next action. */
  private async revealAction(action: NumberedAction): Promise<void> {
    const location = await this.follower.locate(action);
    if (!location) return;
    const { start, end } = location.range;
    const uri = vscode.Uri.parse(location.uri);
    const beside = this.panel.viewColumn === vscode.ViewColumn.One ? vscode.ViewColumn.Beside : vscode.ViewColumn.One;
    await vscode.window.showTextDocument(uri, {
      selection: new vscode.Range(start.line, start.character, end.line, end.character),
      viewColumn: visibleEditor(uri)?.viewColumn ?? beside,
      preserveFocus: true,
    });
  }
}

function visibleEditor(uri: vscode.Uri): vscode.TextEditor | undefined {
  return vscode.window.visibleTextEditors.find((editor) => editor.document.uri.toString() === uri.toString());
}
