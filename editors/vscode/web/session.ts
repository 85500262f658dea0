// The language server of a window in a browser: a worker, and the files that it cannot read itself.
import * as vscode from "vscode";
import { LanguageClient } from "vscode-languageclient/browser";

import { CrashCounter } from "../src/crash_counter";
import { announceExtensions, clientOptions, type LanguageServer, serverState, type ServerState } from "../src/language_server";
import { showError } from "../src/notifications";
import { ProvidedFiles } from "./files";
import { startWorker } from "./worker";

/** A message of the worker: the server has failed, and the worker refuses requests. */
interface Crashed {
  method?: string;
  params?: { message: string };
}

export class WorkerSession implements LanguageServer, vscode.Disposable {
  client: LanguageClient | undefined;
  readonly server = undefined;
  readonly runs = undefined;
  state: ServerState = "starting";

  private worker: Worker | undefined;
  private files: ProvidedFiles | undefined;
  private readonly crashes = new CrashCounter();
  private readonly changed = new vscode.EventEmitter<ServerState>();
  readonly onDidChangeState = this.changed.event;
  readonly output = vscode.window.createOutputChannel("PyDSLRep", { log: true });

  constructor(private readonly extension: vscode.Uri) {}

  /** Starts the server; shows an error if that fails. */
  async start(): Promise<void> {
    try {
      await this.startClient();
    } catch (error) {
      this.failed(String(error));
    }
  }

  async restart(): Promise<void> {
    this.stop();
    await this.start();
  }

  dispose(): void {
    this.stop();
    this.changed.dispose();
    this.output.dispose();
  }

  private async startClient(): Promise<void> {
    const worker = await startWorker(this.extension);
    this.worker = worker;
    worker.addEventListener("message", ({ data }: MessageEvent<Crashed>) => {
      if (data.method === "pydslrep/crashed" && this.worker === worker) {
        this.crashed(data.params?.message ?? "");
      }
    });
    worker.addEventListener("error", (event) => {
      if (this.worker === worker) {
        this.crashed(event.message);
      }
    });
    const client = new LanguageClient("pydslrep", "PyDSLRep", worker, clientOptions(this));
    this.client = client;
    announceExtensions(client);
    client.onDidChangeState(({ newState }) => {
      if (this.client === client) {
        this.setState(serverState(newState));
      }
    });
    await client.start();
    if (this.client === client) {
      this.files = new ProvidedFiles(client);
    }
  }

  private crashed(message: string): void {
    this.output.error(message);
    if (this.crashes.add(Date.now())) {
      void this.restart();
    } else {
      this.stop();
      this.failed("The PyDSLRep server crashed repeatedly and was not restarted.");
    }
  }

  private failed(reason: string): void {
    this.output.error(reason);
    this.setState("stopped");
    showError(reason, { label: "Show Output", press: () => this.output.show() });
  }

  private stop(): void {
    const { client, worker, files } = this;
    this.client = this.worker = this.files = undefined;
    files?.dispose();
    worker?.terminate();
    // Without its worker it cannot say goodbye.
    client?.dispose(0).catch(() => undefined);
  }

  private setState(state: ServerState): void {
    this.state = state;
    this.changed.fire(state);
  }
}
