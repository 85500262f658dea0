// Messages with buttons: what happened in a sentence, and what one can do about it.
import * as vscode from "vscode";

export interface Button {
  label: string;
  press: () => unknown;
}

type Show = (message: string, ...labels: string[]) => Thenable<string | undefined>;

/** Shows a message, and does what the button says that is pressed. */
async function ask(show: Show, message: string, buttons: readonly Button[]): Promise<void> {
  const pressed = await show(message, ...buttons.map(({ label }) => label));
  await buttons.find(({ label }) => label === pressed)?.press();
}

/** Nothing waits for an answer: a message may stay for hours. */
export const inform = (message: string, ...buttons: Button[]) => void ask(vscode.window.showInformationMessage, message, buttons);
export const warn = (message: string, ...buttons: Button[]) => void ask(vscode.window.showWarningMessage, message, buttons);
export const fail = (message: string, ...buttons: Button[]) => void ask(vscode.window.showErrorMessage, message, buttons);
