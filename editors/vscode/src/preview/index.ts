// The command, the panel that VS Code restores, and the connection to the server.
import * as vscode from "vscode";
import type { LanguageClient } from "vscode-languageclient/node";

import { chooseEnvironment } from "../environments";
import { execute } from "../execute";
import type { Session } from "../session";
import type { Drawn } from "./export";
import type { Ask } from "./follower";
import { pageState } from "./messages";
import { isProgram, PANEL, PreviewPanel } from "./panel";
import { DRIVEN_PATH_CHANGED, PLANNED_PATH_CHANGED, type Which } from "./protocol";

/**
 * Registers the command `pydslrep.showPreview` and the panel behind it. Its arguments are both optional: the program's
 * `vscode.Uri`, which the button in the title bar gives, and the environment's name, which lenses give besides.
 */
export function registerPreview(
  context: vscode.ExtensionContext,
  session: Session,
): vscode.Disposable {
  const preview = new Preview(context.extensionUri, session);
  return vscode.Disposable.from(
    // A server that was started again knows of nobody who wants a path.
    session.onDidChangeState((state) => {
      if (state === "running") preview.refresh();
    }),
    vscode.commands.registerCommand("pydslrep.showPreview", (uri?: unknown, environment?: unknown) =>
      preview.open(uri, environment),
    ),
    vscode.commands.registerCommand("pydslrep.exportPath", () => preview.export()),
    vscode.window.registerWebviewPanelSerializer(PANEL, preview),
  );
}

class Preview implements vscode.WebviewPanelSerializer {
  private shown: PreviewPanel | undefined;
  /** The clients that tell this when paths change: each restart may bring another. */
  private readonly connected = new WeakSet<LanguageClient>();

  constructor(
    private readonly extension: vscode.Uri,
    private readonly session: Session,
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

  /** Of what is shown; where nothing is, of the program in the editor. */
  async export(): Promise<void> {
    if (this.shown?.which === undefined) {
      const chosen = await chooseEnvironment(this.session.client, undefined);
      if (chosen === undefined) return;
      await this.open(chosen.uri, chosen.environment);
    }
    await this.shown?.export();
  }

  refresh(): void {
    void this.shown?.refresh();
  }

  private adopt(panel: vscode.WebviewPanel): PreviewPanel {
    const adopted = new PreviewPanel(panel, this.extension, this.ask, this.draw);
    this.shown = adopted;
    panel.onDidDispose(() => {
      if (this.shown === adopted) this.shown = undefined;
    });
    return adopted;
  }

  /** Files of a path: those of its latest run, else drawn now. */
  private readonly draw = async (which: Which): Promise<Drawn | undefined> => {
    const driven = this.session.runs.picturesOf(which);
    if (driven) return { ...driven, isDriven: true };
    const planned = await execute(this.session, "pydslrep.previewPath", which);
    return planned === undefined ? undefined : { ...(planned as Drawn), isDriven: false };
  };

  private readonly ask: Ask = async (method, params, signal) => {
    const { client } = this.session;
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
