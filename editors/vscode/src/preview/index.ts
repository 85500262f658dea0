// The command, the panel that VS Code restores, and the connection to the server.
import * as vscode from "vscode";
import type { LanguageClient } from "vscode-languageclient/node";

import type { Ask } from "./follower";
import { pageState } from "./messages";
import { isProgram, PANEL, PreviewPanel } from "./panel";
import { DRIVEN_PATH_CHANGED, PLANNED_PATH_CHANGED, type Which } from "./protocol";

/**
 * Registers the command `pydslrep.showPreview` and the panel behind it. Its arguments are both optional: the program's
 * `vscode.Uri`, which the button in the title bar gives, and the environment's name, which lenses give besides.
 * `onDidChangeState` tells "running" when a server has been started.
 */
export function registerPreview(
  context: vscode.ExtensionContext,
  client: () => LanguageClient | undefined,
  onDidChangeState: vscode.Event<string>,
): vscode.Disposable {
  const preview = new Preview(context.extensionUri, client);
  return vscode.Disposable.from(
    // A server that was started again knows of nobody who wants a path.
    onDidChangeState((state) => {
      if (state === "running") preview.refresh();
    }),
    vscode.commands.registerCommand("pydslrep.showPreview", (uri?: unknown, environment?: unknown) =>
      preview.open(uri, environment),
    ),
    vscode.window.registerWebviewPanelSerializer(PANEL, preview),
  );
}

class Preview implements vscode.WebviewPanelSerializer {
  private shown: PreviewPanel | undefined;
  /** The clients that tell this when paths change: each restart may bring another. */
  private readonly connected = new WeakSet<LanguageClient>();

  constructor(
    private readonly extension: vscode.Uri,
    private readonly client: () => LanguageClient | undefined,
  ) {}

  async open(uri: unknown, environment: unknown): Promise<void> {
    const active = vscode.window.activeTextEditor?.document;
    const chosen = uri instanceof vscode.Uri ? uri : typeof uri === "string" ? vscode.Uri.parse(uri) : undefined;
    const program = chosen ?? (active && isProgram(active) ? active.uri : undefined);
    if (!program) {
      void vscode.window.showInformationMessage("Open a PyDSLRep program first: its planned path is shown beside it.");
      return;
    }
    if (this.shown) {
      this.shown.reveal();
    } else {
      const place = { viewColumn: vscode.ViewColumn.Beside, preserveFocus: true };
      this.adopt(vscode.window.createWebviewPanel(PANEL, "Path", place));
    }
    await this.shown?.follow(program, typeof environment === "string" ? environment : undefined);
  }

  async deserializeWebviewPanel(panel: vscode.WebviewPanel, state: unknown): Promise<void> {
    const adopted = this.adopt(panel);
    const { uri, environment } = pageState(state);
    if (uri !== undefined) await adopted.follow(vscode.Uri.parse(uri), environment);
  }

  refresh(): void {
    void this.shown?.refresh();
  }

  private adopt(panel: vscode.WebviewPanel): PreviewPanel {
    const adopted = new PreviewPanel(panel, this.extension, this.ask);
    this.shown = adopted;
    panel.onDidDispose(() => {
      if (this.shown === adopted) this.shown = undefined;
    });
    return adopted;
  }

  private readonly ask: Ask = async (method, params, signal) => {
    const client = this.client();
    if (!client) throw new Error("The language server is not running.");
    this.connect(client);
    const cancellation = new vscode.CancellationTokenSource();
    signal.addEventListener("abort", () => cancellation.cancel(), { once: true });
    try {
      return await client.sendRequest(method, params, cancellation.token);
    } finally {
      cancellation.dispose();
    }
  };

  private connect(client: LanguageClient): void {
    if (this.connected.has(client)) return;
    this.connected.add(client);
    client.onNotification(PLANNED_PATH_CHANGED, (which: Which) => void this.shown?.pathChanged(which));
    client.onNotification(DRIVEN_PATH_CHANGED, (which: Which) => void this.shown?.drivenChanged(which));
  }
}
