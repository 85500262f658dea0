// The server's commands about an environment: carried out, and told once where they fail, with what helps.
import * as vscode from "vscode";
import { ExecuteCommandRequest, type LanguageClient, WorkDoneProgress } from "vscode-languageclient/node";

import type { ChosenEnvironment } from "./environments";
import { failureOf } from "./failure";
import { fail, warn } from "./notifications";
import type { Location } from "./preview/follower";

/** What the commands need of the window. */
export interface Surroundings {
  client: LanguageClient | undefined;
  output: vscode.LogOutputChannel;
}

let requests = 0;

/** Carries out a command of the server; undefined where it failed, which the person then knows. */
export async function execute(around: Surroundings, command: string, chosen: ChosenEnvironment): Promise<unknown> {
  try {
    return await request(around.client, command, chosen);
  } catch (error) {
    explain(around, command, chosen, error);
    return undefined;
  }
}

/** Carries out a command that takes a while: with its progress once it has begun, and until somebody stops it. */
export async function executeLong(
  around: Surroundings,
  command: string,
  chosen: ChosenEnvironment,
  stop: vscode.CancellationTokenSource,
): Promise<unknown> {
  const shown = new Shown(`Running ${chosen.environment}`, stop);
  try {
    return await request(around.client, command, chosen, (message) => shown.report(message), stop.token);
  } catch (error) {
    shown.end();
    explain(around, command, chosen, error);
    return undefined;
  } finally {
    shown.end();
  }
}

/** Progress as a message that stops what it is about; what fails before it begins has none. */
class Shown {
  private progress: vscode.Progress<{ message?: string }> | undefined;
  private finish: () => void = () => undefined;

  constructor(
    private readonly title: string,
    private readonly stop: vscode.CancellationTokenSource,
  ) {}

  report(message: string | undefined): void {
    if (this.progress === undefined) {
      this.begin();
    }
    if (message !== undefined) {
      this.progress?.report({ message });
    }
  }

  end(): void {
    this.finish();
  }

  private begin(): void {
    const options = { location: vscode.ProgressLocation.Notification, title: this.title, cancellable: true };
    void vscode.window.withProgress(options, (progress, pressed) => {
      this.progress = progress;
      pressed.onCancellationRequested(() => this.stop.cancel());
      return new Promise<void>((resolve) => (this.finish = resolve));
    });
  }
}

async function request(
  client: LanguageClient | undefined,
  command: string,
  chosen: ChosenEnvironment,
  report?: (message: string | undefined) => void,
  token?: vscode.CancellationToken,
): Promise<unknown> {
  if (client === undefined) {
    throw new Error("the language server is not running");
  }
  const params = { command, arguments: [chosen] };
  if (report === undefined) {
    return client.sendRequest(ExecuteCommandRequest.type, params);
  }
  const workDoneToken = `pydslrep command ${++requests}`;
  const following = client.onProgress(WorkDoneProgress.type, workDoneToken, (value) => {
    if (value.kind !== "end") {
      report(value.message);
    }
  });
  try {
    return await client.sendRequest(ExecuteCommandRequest.type, { ...params, workDoneToken }, token);
  } finally {
    following.dispose();
  }
}

/** Says once why a command failed, with what one can do about it as a button. */
function explain(around: Surroundings, command: string, chosen: ChosenEnvironment, error: unknown): void {
  const again = (which = chosen) => vscode.commands.executeCommand(command, which);
  const failure = failureOf(error);
  switch (failure.kind) {
    case "cancelled":
      return;
    case "ended":
      if (command === "pydslrep.run") {
        warn(`The run of ${chosen.environment} ended because the language server was restarted.`, { label: "Run Again", press: () => again() });
      }
      return;
    case "unsaved":
      fail(failure.message, { label: "Save As…", press: () => saveAs(chosen, again) });
      return;
    case "errors": {
      const { location } = failure;
      const show = location && { label: "Show Problem", press: () => showProblem(location) };
      fail(failure.message, ...(show ? [show] : []));
      return;
    }
    case "other":
      around.output.error(failure.details);
      fail(failure.message, { label: "Show Output", press: () => around.output.show() });
  }
}

async function saveAs(chosen: ChosenEnvironment, again: (which: ChosenEnvironment) => unknown): Promise<void> {
  const saved = await vscode.workspace.saveAs(vscode.Uri.parse(chosen.uri));
  if (saved !== undefined) {
    await again({ ...chosen, uri: saved.toString() });
  }
}

async function showProblem({ uri, range: { start, end } }: Location): Promise<void> {
  const selection = new vscode.Range(start.line, start.character, end.line, end.character);
  await vscode.window.showTextDocument(vscode.Uri.parse(uri), { selection });
  await vscode.commands.executeCommand("editor.action.showHover");
}
