// The window's language server: finds, starts and restarts it.
import type { ChildProcess } from "node:child_process";
import { statSync } from "node:fs";
import * as os from "node:os";

import * as vscode from "vscode";
import {
  CloseAction,
  type CloseHandlerResult,
  ErrorAction,
  LanguageClient,
  State,
} from "vscode-languageclient/node";

import { CrashCounter } from "./crash_counter";
import { type Executable, findServer, type SearchPaths } from "./executables";
import { announceExtensions, clientOptions, type LanguageServer, serverState, type ServerState } from "./language_server";
import { launch } from "./launch";
import { showError } from "./notifications";
import { Runs } from "./run";

/** A client that only writes its failures to the output while it is silent. */
class Client extends LanguageClient {
  /**
   * From the beginning until the server runs, as the session then says what to do, and again once the client is replaced, as its
   * failures concern nobody.
   */
  isSilent = true;

  override error(message: string, data?: unknown, show?: boolean | "force"): void {
    super.error(message, data, this.isSilent ? false : show);
  }
}

export class Session implements LanguageServer, vscode.Disposable {
  /** The connection to the server; undefined if no server was found. */
  client: Client | undefined;
  /** The server that was found. */
  server: Executable | undefined;
  state: ServerState = "starting";

  private process: ChildProcess | undefined;
  /** The last step of the queue. */
  private last: Promise<void> = Promise.resolve();

  private readonly changed = new vscode.EventEmitter<ServerState>();
  readonly onDidChangeState = this.changed.event;

  readonly output = vscode.window.createOutputChannel("PyDSLRep", { log: true });

  readonly runs = new Runs(this);

  constructor(private readonly context: vscode.ExtensionContext) {}

  /** Finds and starts the server; shows an error if that fails. */
  start(): Promise<void> {
    return this.enqueue(() => this.findAndStart());
  }

  /** Stops the server, if there is one, and finds and starts it again. */
  restart(): Promise<void> {
    this.stop();
    return this.enqueue(() => this.findAndStart());
  }

  private async findAndStart(): Promise<void> {
    const server = findServer(this.searchPaths());
    if (!("command" in server)) {
      this.server = undefined;
      this.setState("missing");
      this.reportMissing(server.reason, server.isSettingWrong);
      return;
    }
    this.server = server;
    this.output.info(`starting ${server.command} ${server.args.join(" ")}`);
    const client = this.createClient(server);
    this.client = client;
    try {
      await client.start();
    } catch (error) {
      if (this.client === client) {
        this.setState("stopped");
        this.reportMissing(`${server.command} is not a PyDSLRep language server: ${String(error)}`, server.origin === "setting");
      }
    }
  }

  private createClient(server: Executable): Client {
    const folder = vscode.workspace.workspaceFolders?.[0]?.uri.fsPath;
    const crashes = new CrashCounter();
    const closed = (): CloseHandlerResult => {
      if (this.client !== client) {
        return { action: CloseAction.DoNotRestart, handled: true };
      }
      if (crashes.add(Date.now())) {
        return { action: CloseAction.Restart, handled: true, message: "The server stopped and is being restarted." };
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
    const client = new Client("pydslrep", "PyDSLRep", start, {
      ...clientOptions(this),
      // Without a handler, the library shows the error itself.
      initializationFailedHandler: () => false,
      // Writing to a dead server fails before its exit is noticed; `closed` handles the exit.
      errorHandler: { error: () => ({ action: ErrorAction.Continue, handled: true }), closed },
    });
    announceExtensions(client);
    client.onDidChangeState(({ newState }) => {
      // A client that was replaced may still change.
      if (this.client === client) {
        if (newState === State.Running) {
          client.isSilent = false;
        }
        this.setState(serverState(newState));
      }
    });
    return client;
  }

  /** Detaches the client, if there is one, and queues its shutdown. */
  private stop(): void {
    const { client, process } = this;
    this.client = undefined;
    this.process = undefined;
    if (client) {
      client.isSilent = true;
    }
    if (client?.state === State.Starting) {
      // It may never respond, and the next step of the queue waits for it.
      process?.kill();
    }
    void this.enqueue(async () => {
      await client?.dispose().catch((error: unknown) => this.output.warn(String(error)));
      // A hanging server does not exit on request.
      process?.kill();
    });
  }

  /** Runs steps one after the other, so that a restart waits for a server that is still starting. */
  private enqueue(step: () => Promise<void>): Promise<void> {
    this.last = this.last.then(step, step);
    return this.last;
  }

  searchPaths(): SearchPaths {
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
    this.stop();
    this.runs.dispose();
    this.changed.dispose();
    this.output.dispose();
  }

  private setState(state: ServerState): void {
    this.state = state;
    if (state !== "running") {
      this.runs.forgetPictures();
    }
    this.changed.fire(state);
  }

  private reportMissing(reason: string, isSettingWrong: boolean): void {
    this.output.error(reason);
    const change = {
      label: isSettingWrong ? "Change Setting" : "Set Server Path",
      press: () => vscode.commands.executeCommand("workbench.action.openSettings", "pydslrep.server.path"),
    };
    showError(reason, change, { label: "Show Output", press: () => this.output.show() });
  }
}
