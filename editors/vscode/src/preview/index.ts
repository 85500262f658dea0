// The preview's command, the panel that VS Code restores, and the connection to the server.
import * as vscode from "vscode";
import type { BaseLanguageClient } from "vscode-languageclient";

import { chooseEnvironment, chooseProgram, isScene } from "../environments";
import { execute } from "../execute";
import type { LanguageServer } from "../language_server";
import type { Draw, Drawings } from "./export";
import type { Request } from "../../../preview/host/follower";
import { pageState } from "../../../preview/host/messages";
import type { Outcome } from "../run";
import { PANEL_TYPE, PreviewPanel } from "./panel";
import { DRIVEN_PATH_CHANGED, type EnvironmentId, PLANNED_PATH_CHANGED } from "../../../preview/host/protocol";

/**
 * Registers the preview. Both arguments of `pydslrep.showPreview` are optional: the program's URI, which the button in the
 * title bar passes, and the name of the environment, which lenses pass as well.
 */
export function registerPreview(context: vscode.ExtensionContext, session: LanguageServer): vscode.Disposable {
  const preview = new Preview(context.extensionUri, session);
  if (session.runs) session.runs.show = (outcome, environment) => preview.showOutcome(outcome, environment);
  return vscode.Disposable.from(
    // A restarted server does not know which paths are shown.
    session.onDidChangeState((state) => {
      if (state === "running") preview.refresh();
    }),
    vscode.commands.registerCommand("pydslrep.showPreview", (uri?: unknown, environment?: unknown) =>
      preview.open(uri, environment),
    ),
    vscode.commands.registerCommand("pydslrep.exportPath", () => preview.export()),
    vscode.window.registerWebviewPanelSerializer(PANEL_TYPE, preview),
  );
}

class Preview implements vscode.WebviewPanelSerializer {
  private panel: PreviewPanel | undefined;
  /** The clients whose notifications are handled; each restart may create another. */
  private readonly connected = new WeakSet<BaseLanguageClient>();

  constructor(
    private readonly extension: vscode.Uri,
    private readonly session: LanguageServer,
  ) {}

  async open(uri: unknown, environment: unknown): Promise<void> {
    const given = uri instanceof vscode.Uri ? uri : typeof uri === "string" ? vscode.Uri.parse(uri) : undefined;
    const isChosen = given !== undefined && typeof environment === "string";
    const document = isChosen ? undefined : await chooseProgram(given);
    const program = isChosen ? given : document?.uri;
    if (!program) return;
    if (this.panel) {
      this.panel.reveal();
    } else {
      const column = { viewColumn: vscode.ViewColumn.Beside, preserveFocus: true };
      this.attach(vscode.window.createWebviewPanel(PANEL_TYPE, "Path", column));
    }
    if (document && isScene(document)) await this.panel?.followScene(program);
    else await this.panel?.follow(program, typeof environment === "string" ? environment : undefined);
  }

  /** Shows how a run ended in the panel; false if nobody would see it there. */
  showOutcome(outcome: Outcome | undefined, environment: EnvironmentId): boolean {
    return this.panel?.showOutcome(outcome, environment) ?? false;
  }

  async deserializeWebviewPanel(panel: vscode.WebviewPanel, state: unknown): Promise<void> {
    const attached = this.attach(panel);
    const { uri, environment } = pageState(state);
    if (uri !== undefined) await attached.follow(vscode.Uri.parse(uri), environment);
  }

  /** Exports the shown path; if none is shown, that of the program in the editor. */
  async export(): Promise<void> {
    if (this.panel?.shown === undefined) {
      const chosen = await chooseEnvironment(this.session.client, undefined);
      if (chosen === undefined) return;
      await this.open(chosen.uri, chosen.environment);
    }
    await this.panel?.export();
  }

  refresh(): void {
    void this.panel?.refresh();
  }

  private attach(panel: vscode.WebviewPanel): PreviewPanel {
    const attached = new PreviewPanel(panel, this.extension, this.request, this.draw(), this.session.runs !== undefined);
    this.panel = attached;
    panel.onDidDispose(() => {
      if (this.panel === attached) this.panel = undefined;
    });
    return attached;
  }

  /** The files drawn by the latest run; if that says nothing of the program now, the server draws the planned path, where it can. */
  private draw(): Draw | undefined {
    const { runs } = this.session;
    return runs && (async (environment, isRunCurrent) => {
      const driven = isRunCurrent ? runs.picturesOf(environment) : undefined;
      return driven ?? ((await execute(this.session, "pydslrep.previewPath", environment)) as Drawings | undefined);
    });
  }

  private readonly request: Request = async (method, params, signal) => {
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

  private connect(client: BaseLanguageClient): void {
    if (this.connected.has(client)) return;
    this.connected.add(client);
    for (const method of [PLANNED_PATH_CHANGED, DRIVEN_PATH_CHANGED]) {
      client.onNotification(method, (id: EnvironmentId) => void this.panel?.notified(method, id));
    }
  }
}
