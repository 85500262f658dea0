// The preview's panel: passes messages between the preview's host, the editor and the page.
import * as vscode from "vscode";

import { addEnvironment, isProgram, isScene } from "../environments";
import { reached } from "../milestones";
import { type Draw, exportPath } from "./export";
import type { Request } from "../../../preview/host/follower";
import { PreviewHost } from "../../../preview/host/host";
import type { ToPage } from "../../../preview/host/messages";
import type { Outcome } from "../run";
import { page } from "./page";
import { type EnvironmentId, keyOf, type Location, type Position } from "../../../preview/host/protocol";

/** VS Code restores panels by their type. */
export const PANEL_TYPE = "pydslrep.preview";

export class PreviewPanel {
  private readonly host: PreviewHost;
  private readonly subscriptions: vscode.Disposable[] = [];

  constructor(
    private readonly panel: vscode.WebviewPanel,
    extension: vscode.Uri,
    request: Request,
    private readonly draw: Draw | undefined,
    canRun: boolean,
  ) {
    const images = vscode.Uri.joinPath(extension, "images");
    panel.iconPath = { light: vscode.Uri.joinPath(images, "file-light.svg"), dark: vscode.Uri.joinPath(images, "file-dark.svg") };
    this.host = new PreviewHost(request, (message) => this.post(message), {
      fix: (location, title) => void applyFix(location, title),
      ...(canRun ? { run: (environment) => void vscode.commands.executeCommand("pydslrep.run", environment) } : {}),
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
    this.nameAfter(uri.toString());
    const cursor = cursorOf(visibleEditor(uri));
    await this.host.follower.follow(uri.toString(), cursor, environment);
  }

  /** Shows the environment of a scene. */
  async followScene(uri: vscode.Uri): Promise<void> {
    await this.host.follower.followScene(uri.toString());
    this.nameAfter(this.host.follower.program);
  }

  /** Shows how a run ended, or that another one has begun; false if the panel is hidden or shows something else. */
  showOutcome(outcome: Outcome | undefined, environment: EnvironmentId): boolean {
    const { shown } = this;
    if (!outcome) this.host.clearResult(environment);
    if (!outcome || !this.panel.visible || !shown || keyOf(shown) !== keyOf(environment)) return false;
    this.host.setResult(environment, outcome.message, outcome.isError, outcome.buttons);
    return true;
  }

  private nameAfter(program: string | undefined): void {
    if (program === undefined) return;
    const { path } = vscode.Uri.parse(program);
    this.panel.title = `Path: ${path.slice(path.lastIndexOf("/") + 1)}`;
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
      // What a run drew is not the picture of a program that has changed since.
      const draw = this.draw && ((environment: EnvironmentId) => this.draw?.(environment, !this.host.isRunEarlier));
      await exportPath(shown, draw, () => this.host.capture());
    }
  }

  private post(message: ToPage): void {
    if (message.type === "path") reached("preview");
    void this.panel.webview.postMessage(message);
  }

  private cursorMoved(editor: vscode.TextEditor): void {
    if (isScene(editor.document) && editor === vscode.window.activeTextEditor) void this.followScene(editor.document.uri);
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

/** Applies the quick fix of this title, if it is still offered. */
async function applyFix({ uri, range: { start, end } }: Location, title: string): Promise<void> {
  const document = vscode.Uri.parse(uri);
  const range = new vscode.Range(start.line, start.character, end.line, end.character);
  // The provider answers for open documents only.
  await vscode.workspace.openTextDocument(document);
  const kind = vscode.CodeActionKind.QuickFix.value;
  const actions = await vscode.commands.executeCommand<vscode.CodeAction[]>("vscode.executeCodeActionProvider", document, range, kind);
  const edit = actions.find((action) => action.title === title)?.edit;
  if (edit) await vscode.workspace.applyEdit(edit);
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
