// The preview's panel: passes messages between the preview's host, the editor and the page.
import * as vscode from "vscode";

import { addEnvironment } from "../environments";
import { reached } from "../milestones";
import { type Draw, exportPath } from "./export";
import type { Request } from "../../../preview/host/follower";
import { PreviewHost } from "../../../preview/host/host";
import type { ToPage } from "../../../preview/host/messages";
import { page } from "./page";
import type { EnvironmentId, Location, Position } from "../../../preview/host/protocol";

/** VS Code restores panels by their type. */
export const PANEL_TYPE = "pydslrep.preview";

export function isProgram(document: vscode.TextDocument): boolean {
  return document.languageId === "pydslrep";
}

export class PreviewPanel {
  private readonly host: PreviewHost;
  private readonly subscriptions: vscode.Disposable[] = [];

  constructor(
    private readonly panel: vscode.WebviewPanel,
    extension: vscode.Uri,
    request: Request,
    private readonly draw: Draw | undefined,
  ) {
    this.host = new PreviewHost(request, (message) => this.post(message), {
      reveal: (location) => void this.showLocation(location),
      accept: (_, program) => void addEnvironmentTo(program),
      export: () => void this.export(),
    });
    const dist = vscode.Uri.joinPath(extension, "dist");
    const { webview } = panel;
    webview.options = { enableScripts: true, localResourceRoots: [dist] };
    this.subscriptions.push(
      webview.onDidReceiveMessage((message: unknown) => void this.host.received(message)),
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
      nonce: crypto.randomUUID(),
    });
  }

  /** Shows a program. */
  async follow(uri: vscode.Uri, environment?: string): Promise<void> {
    this.panel.title = `Path: ${uri.path.slice(uri.path.lastIndexOf("/") + 1)}`;
    const cursor = cursorOf(visibleEditor(uri));
    await this.host.follower.follow(uri.toString(), cursor, environment);
  }

  reveal(): void {
    this.panel.reveal(undefined, true);
  }

  notified(method: string, environment: EnvironmentId): Promise<void> {
    return this.host.notified(method, environment);
  }

  /** Requests everything again, for example from a restarted server. */
  refresh(): Promise<void> {
    return this.host.follower.resend();
  }

  get shown(): EnvironmentId | undefined {
    return this.host.follower.shown;
  }

  /** Exports the shown path to a file that the user chooses. */
  async export(): Promise<void> {
    const { shown } = this;
    if (shown !== undefined) {
      await exportPath(shown, this.draw, () => this.host.capture());
    }
  }

  private post(message: ToPage): void {
    if (message.type === "path") reached("preview");
    void this.panel.webview.postMessage(message);
  }

  private cursorMoved(editor: vscode.TextEditor): void {
    if (!isProgram(editor.document)) return;
    const uri = editor.document.uri;
    if (uri.toString() !== this.host.follower.program) {
      if (editor === vscode.window.activeTextEditor) void this.follow(uri);
    } else {
      void this.host.follower.update(cursorOf(editor), true);
    }
  }

  /** Text may change without the cursor: by undo, or in another editor. */
  private textChanged({ uri }: vscode.TextDocument): void {
    if (uri.toString() === this.host.follower.program) {
      void this.host.follower.update(cursorOf(visibleEditor(uri)));
    }
  }

  /** Selects an action in the editor; the panel keeps the focus, so the user can move on to the next action. */
  private async showLocation(location: Location): Promise<void> {
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

async function addEnvironmentTo(program: string): Promise<void> {
  await addEnvironment(await vscode.workspace.openTextDocument(vscode.Uri.parse(program)));
}

/** As a plain object: the properties of VS Code's own do not reach a worker. */
function cursorOf(editor: vscode.TextEditor | undefined): Position {
  const { line, character } = editor?.selection.active ?? { line: 0, character: 0 };
  return { line, character };
}

function visibleEditor(uri: vscode.Uri): vscode.TextEditor | undefined {
  return vscode.window.visibleTextEditors.find((editor) => editor.document.uri.toString() === uri.toString());
}
