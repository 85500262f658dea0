// The language server for as long as the window is open: found, started, and started again.
import { statSync } from "node:fs";
import * as os from "node:os";

import * as vscode from "vscode";
import { LanguageClient, type LanguageClientOptions, State } from "vscode-languageclient/node";

import { CLIENT_COMMANDS, middleware } from "./middleware";
import { findServer, type Places, type Program } from "./server";

/** Where the server is in its life. */
export type ServerState = "starting" | "running" | "stopped" | "missing";

/** Programs, and the files beside them that the server knows. */
export const DOCUMENTS = [
  { language: "pydslrep" },
  { pattern: "**/pydslrep.toml" },
  { pattern: "**/*.scene.toml" },
] as const satisfies vscode.DocumentSelector;

export class Session implements vscode.Disposable {
  /** The connection to the server; none where no server was found. */
  client: LanguageClient | undefined;
  /** The server that was found. */
  program: Program | undefined;
  state: ServerState = "starting";

  private readonly changed = new vscode.EventEmitter<ServerState>();
  readonly onDidChangeState = this.changed.event;

  readonly output = vscode.window.createOutputChannel("PyDSLRep", { log: true });

  constructor(private readonly context: vscode.ExtensionContext) {}

  /** Looks for the server and starts it; says so where it cannot. */
  async start(): Promise<void> {
    const server = findServer(this.places());
    if (!("command" in server)) {
      this.program = undefined;
      this.enter("missing");
      void this.complain(server.reason, server.setting);
      return;
    }
    this.program = server;
    this.output.info(`starting ${server.command} ${server.args.join(" ")}`);
    const client = new LanguageClient("pydslrep", "PyDSLRep", { command: server.command, args: server.args }, this.options());
    client.registerFeature({
      fillClientCapabilities: (capabilities) => {
        capabilities.experimental = { commands: { commands: CLIENT_COMMANDS } };
      },
      initialize: () => undefined,
      getState: () => ({ kind: "static" }),
      clear: () => undefined,
    });
    client.onDidChangeState(({ newState }) => {
      // One that was let go of may still have something to say.
      if (this.client === client) {
        this.enter(named(newState));
      }
    });
    this.client = client;
    try {
      await client.start();
    } catch (error) {
      this.enter("stopped");
      void this.complain(`${server.command} is no language server of PyDSLRep: ${String(error)}`, server.origin === "setting");
    }
  }

  /** Ends the server, if there is one, and starts the one that is found now. */
  async restart(): Promise<void> {
    await this.stop();
    await this.start();
  }

  /** Ends the server. */
  async stop(): Promise<void> {
    const client = this.client;
    this.client = undefined;
    // A server that never started has nothing to stop, and one that hangs is left behind.
    await client?.dispose().catch((error: unknown) => this.output.warn(String(error)));
  }

  /** Where this window looks for programs. */
  places(): Places {
    return {
      setting: vscode.workspace.getConfiguration("pydslrep").get("server.path", ""),
      workspaceFolder: vscode.workspace.workspaceFolders?.[0]?.uri.fsPath,
      homeFolder: os.homedir(),
      bundledFolder: vscode.Uri.joinPath(this.context.extensionUri, "server").fsPath,
      searchPath: process.env.PATH ?? "",
      platform: process.platform,
      isFile: (file) => statSync(file, { throwIfNoEntry: false })?.isFile() === true,
    };
  }

  dispose(): void {
    void this.stop();
    this.changed.dispose();
    this.output.dispose();
  }

  private options(): LanguageClientOptions {
    return {
      documentSelector: [...DOCUMENTS],
      outputChannel: this.output,
      middleware: middleware(),
      diagnosticPullOptions: { onChange: true, onSave: true },
    };
  }

  private enter(state: ServerState): void {
    this.state = state;
    this.changed.fire(state);
  }

  private async complain(reason: string, setting: boolean): Promise<void> {
    this.output.error(reason);
    const change = setting ? "Change the Setting" : "Set a Path";
    const chosen = await vscode.window.showErrorMessage(reason, change, "Show Output");
    if (chosen === change) {
      await vscode.commands.executeCommand("workbench.action.openSettings", "pydslrep.server.path");
    } else if (chosen !== undefined) {
      this.output.show();
    }
  }
}

function named(state: State): ServerState {
  switch (state) {
    case State.Running:
      return "running";
    case State.Starting:
      return "starting";
    default:
      return "stopped";
  }
}
