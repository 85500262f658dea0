// Executes the server's commands on an environment and reports failures once, each with a button that helps.
import * as vscode from "vscode";
import {
  type BaseLanguageClient,
  ExecuteCommandRequest,
  WorkDoneProgress,
  type WorkDoneProgressBegin,
  type WorkDoneProgressEnd,
  type WorkDoneProgressReport,
} from "vscode-languageclient";

import { type Failure, failureOf } from "./failure";
import { type Button, showError, showWarning } from "./notifications";
import type { EnvironmentId, Location } from "../../preview/host/protocol";

/** The connection to the server and the channel for details. */
export interface Connection {
  client: BaseLanguageClient | undefined;
  output: vscode.LogOutputChannel;
  /** Marks the action that failed in a run. */
  markFailure?: (location: Location, message: string) => void;
}

let requests = 0;

/** The result of a command; undefined if it failed, which the user has been told. */
export async function execute(connection: Connection, command: string, environment: EnvironmentId): Promise<unknown> {
  try {
    return await request(connection.client, command, environment);
  } catch (error) {
    reportFailure(connection, command, environment, failureOf(error));
    return undefined;
  }
}

/** Like `execute`, for a command that takes a while: shows its progress and can be cancelled. */
export async function executeWithProgress(
  connection: Connection,
  command: string,
  environment: EnvironmentId,
  cancellation: vscode.CancellationTokenSource,
  title = `Running ${environment.environment}`,
  report: Report = showError,
): Promise<unknown> {
  const progress = new ProgressNotification(title, cancellation);
  const { client } = connection;
  try {
    return await request(client, command, environment, (value) => progress.follow(value), cancellation.token);
  } catch (error) {
    progress.end();
    // A server that is shut down may still respond, namely that the command was cancelled.
    const isLost = connection.client !== client && !cancellation.token.isCancellationRequested;
    reportFailure(connection, command, environment, isLost ? { kind: "disconnected" } : failureOf(error), report);
    return undefined;
  } finally {
    progress.end();
  }
}

/** A progress notification that cancels the command. It opens with the first report, so a command that fails at once shows none. */
class ProgressNotification {
  private progress: vscode.Progress<{ message?: string }> | undefined;
  private finish: () => void = () => undefined;

  constructor(
    private readonly title: string,
    private readonly cancellation: vscode.CancellationTokenSource,
  ) {}

  follow(value: WorkDoneProgressBegin | WorkDoneProgressReport | WorkDoneProgressEnd): void {
    if (value.kind === "end") {
      // The server may still have a question.
      this.end();
      return;
    }
    if (this.progress === undefined) {
      this.begin();
    }
    if (value.message !== undefined) {
      this.progress?.report({ message: value.message });
    }
  }

  end(): void {
    this.finish();
  }

  private begin(): void {
    const options = { location: vscode.ProgressLocation.Notification, title: this.title, cancellable: true };
    void vscode.window.withProgress(options, (progress, pressed) => {
      this.progress = progress;
      pressed.onCancellationRequested(() => this.cancellation.cancel());
      return new Promise<void>((resolve) => (this.finish = resolve));
    });
  }
}

async function request(
  client: BaseLanguageClient | undefined,
  command: string,
  environment: EnvironmentId,
  report?: (value: WorkDoneProgressBegin | WorkDoneProgressReport | WorkDoneProgressEnd) => void,
  token?: vscode.CancellationToken,
): Promise<unknown> {
  if (client === undefined) {
    throw new Error("the language server is not running");
  }
  const params = { command, arguments: [environment] };
  if (report === undefined) {
    return client.sendRequest(ExecuteCommandRequest.type, params);
  }
  const workDoneToken = `pydslrep command ${++requests}`;
  const listener = client.onProgress(WorkDoneProgress.type, workDoneToken, report);
  try {
    return await client.sendRequest(ExecuteCommandRequest.type, { ...params, workDoneToken }, token);
  } finally {
    listener.dispose();
  }
}

/** Tells the user of a failure, and what to do about it; an action that failed in a run has a location. */
export type Report = (message: string, ...buttons: Button[]) => void;

function reportFailure(connection: Connection, command: string, environment: EnvironmentId, failure: Failure, report: Report = showError): void {
  const retry = (which = environment) => vscode.commands.executeCommand(command, which);
  switch (failure.kind) {
    case "cancelled":
      return;
    case "disconnected":
      if (command === "pydslrep.run") {
        showWarning(`The run of ${environment.environment} ended because the language server was restarted.`, { label: "Run Again", press: () => retry() });
      }
      return;
    case "unsaved":
      report(failure.message, { label: "Save As…", press: () => saveAs(environment, retry) });
      return;
    case "errors": {
      const { location } = failure;
      const show = location && { label: "Show Problem", press: () => showProblem(location) };
      // A warning closes by itself; an error with a button would stay when the program has long been corrected.
      (report === showError ? showWarning : report)(failure.message, ...(show ? [show] : []));
      return;
    }
    case "run": {
      const { location, message } = failure;
      connection.markFailure?.(location, message);
      report(message, { label: "Show Action", press: () => showProblem(location) });
      return;
    }
    case "other":
      connection.output.error(failure.details);
      report(failure.message, { label: "Show Output", press: () => connection.output.show() });
  }
}

async function saveAs(environment: EnvironmentId, retry: (which: EnvironmentId) => unknown): Promise<void> {
  const saved = await vscode.workspace.saveAs(vscode.Uri.parse(environment.uri));
  if (saved !== undefined) {
    await retry({ ...environment, uri: saved.toString() });
  }
}

async function showProblem({ uri, range: { start, end } }: Location): Promise<void> {
  const selection = new vscode.Range(start.line, start.character, end.line, end.character);
  await vscode.window.showTextDocument(vscode.Uri.parse(uri), { selection });
  await vscode.commands.executeCommand("editor.action.showHover");
}
