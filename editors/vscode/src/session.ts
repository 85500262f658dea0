// The language server for as long as the window is open: found, started, and started again.
import type { ChildProcess } from "node:child_process";
import { statSync } from "node:fs";
import * as os from "node:os";

import * as vscode from "vscode";
import {
  CloseAction,
  type CloseHandlerResult,
  ErrorAction,
  LanguageClient,
  type LanguageClientOptions,
  RevealOutputChannelOn,
  State,
} from "vscode-languageclient/node";

import { PAGES } from "./explain";
import { Ends, launch } from "./launch";
import { CLIENT_COMMANDS, middleware } from "./middleware";
import { Runs } from "./run";
import { findServer, type Places, type Program } from "./executables";

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

  private process: ChildProcess | undefined;
  /** What was begun last. */
  private last: Promise<void> = Promise.resolve();

  private readonly changed = new vscode.EventEmitter<ServerState>();
  readonly onDidChangeState = this.changed.event;

  readonly output = vscode.window.createOutputChannel("PyDSLRep", { log: true });

  readonly runs = new Runs(this);

  constructor(private readonly context: vscode.ExtensionContext) {}

  /** Looks for the server and starts it; says so where it cannot. */
  start(): Promise<void> {
    return this.inTurn(() => this.begin());
  }

  /** Ends the server, if there is one, and starts the one that is found now. */
  restart(): Promise<void> {
    this.letGo();
    return this.inTurn(() => this.begin());
  }

  private async begin(): Promise<void> {
    const server = findServer(this.places());
    if (!("command" in server)) {
      this.program = undefined;
      this.enter("missing");
      void this.complain(server.reason, server.setting);
      return;
    }
    this.program = server;
    this.output.info(`starting ${server.command} ${server.args.join(" ")}`);
    const client = this.connect(server);
    this.client = client;
    try {
      await client.start();
    } catch (error) {
      if (this.client === client) {
        this.enter("stopped");
        void this.complain(`${server.command} is not a PyDSLRep language server: ${String(error)}`, server.origin === "setting");
      }
    }
  }

  private connect(server: Program): LanguageClient {
    const folder = vscode.workspace.workspaceFolders?.[0]?.uri.fsPath;
    const ends = new Ends();
    const closed = (): CloseHandlerResult => {
      if (this.client !== client) {
        return { action: CloseAction.DoNotRestart, handled: true };
      }
      if (ends.add(Date.now())) {
        return { action: CloseAction.Restart, handled: true, message: "The server stopped and is started again." };
      }
      return { action: CloseAction.DoNotRestart, message: "The PyDSLRep server crashed repeatedly and was not restarted." };
    };
    const start = async () => {
      const process = await launch(server, folder);
      if (this.client === client) {
        this.process = process;
      } else {
        process.kill();
      }
      return process;
    };
    const client = new LanguageClient("pydslrep", "PyDSLRep", start, {
      ...this.options(),
      // What is written to a server that died fails before its end is seen: it is the end that counts.
      errorHandler: { error: () => ({ action: ErrorAction.Continue, handled: true }), closed },
    });
    client.registerFeature({
      fillClientCapabilities: (capabilities) => {
        capabilities.experimental = { commands: { commands: CLIENT_COMMANDS }, pages: PAGES };
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
    return client;
  }

  /** Lets go of the server, if there is one, and ends it in its turn. */
  private letGo(): void {
    const { client, process } = this;
    this.client = undefined;
    this.process = undefined;
    if (client?.state === State.Starting) {
      // It may never answer, and what comes next waits for it.
      process?.kill();
    }
    void this.inTurn(async () => {
      await client?.dispose().catch((error: unknown) => this.output.warn(String(error)));
      // One that hangs does not go by being asked.
      process?.kill();
    });
  }

  /** Does one thing after the other: what is asked for while a server starts comes behind that. */
  private inTurn(step: () => Promise<void>): Promise<void> {
    this.last = this.last.then(step, step);
    return this.last;
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
    this.letGo();
    this.runs.dispose();
    this.changed.dispose();
    this.output.dispose();
  }

  private options(): LanguageClientOptions {
    return {
      documentSelector: [...DOCUMENTS],
      outputChannel: this.output,
      middleware: middleware(this, this.runs),
      // Failures are told where they are understood, and once.
      revealOutputChannelOn: RevealOutputChannelOn.Never,
      diagnosticPullOptions: { onChange: true, onSave: true },
    };
  }

  private enter(state: ServerState): void {
    this.state = state;
    if (state !== "running") {
      this.runs.forget();
    }
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
