// What the extension needs of a language server, whether it is a process or a worker.
import * as vscode from "vscode";
import { type BaseLanguageClient, type LanguageClientOptions, RevealOutputChannelOn, State } from "vscode-languageclient";

import type { Executable } from "./executables";
import type { Connection } from "./execute";
import { PAGE_SCHEME } from "./explain";
import { HeldDiagnostics } from "./held_diagnostics";
import { CLIENT_COMMANDS, middleware } from "./middleware";
import type { Runs } from "./run";

export type ServerState = "starting" | "running" | "stopped" | "missing";

/** Programs, settings and scenes. */
export const DOCUMENTS = [
  { language: "pydslrep" },
  { pattern: "**/pydslrep.toml" },
  { pattern: "**/*.scene.toml" },
] as const satisfies vscode.DocumentSelector;

/** The language server of a window. */
export interface LanguageServer extends Connection {
  /** The program that was found; undefined if there is none, or none is needed. */
  readonly server: Executable | undefined;
  readonly state: ServerState;
  readonly onDidChangeState: vscode.Event<ServerState>;
  /** The runs of the window; undefined where nothing can be run. */
  readonly runs: Runs | undefined;
  restart(): Promise<void>;
}

/** The options of every client. */
export function clientOptions(server: LanguageServer): LanguageClientOptions {
  return {
    documentSelector: [...DOCUMENTS],
    outputChannel: server.output,
    middleware: middleware(server, server.runs),
    // Failures are shown by the code that can explain them.
    revealOutputChannelOn: RevealOutputChannelOn.Never,
    diagnosticPullOptions: { onChange: true, onSave: true },
    diagnosticCollectionProvider: {
      create: (name) => new HeldDiagnostics(vscode.languages.createDiagnosticCollection(name)),
      dispose: (collection) => collection.dispose(),
    },
  };
}

/** Tells the server what this client can do beyond the protocol. */
export function announceExtensions(client: BaseLanguageClient): void {
  client.registerFeature({
    fillClientCapabilities: (capabilities) => {
      capabilities.experimental = { commands: { commands: CLIENT_COMMANDS }, pages: PAGE_SCHEME };
    },
    initialize: () => undefined,
    getState: () => ({ kind: "static" }),
    clear: () => undefined,
  });
}

/** A state of the client library in ours. */
export function serverState(state: State): ServerState {
  switch (state) {
    case State.Running:
      return "running";
    case State.Starting:
      return "starting";
    default:
      return "stopped";
  }
}
