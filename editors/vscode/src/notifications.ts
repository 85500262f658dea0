// Notifications with buttons: what happened, and what to do about it.
import * as vscode from "vscode";

export interface Button {
  label: string;
  press: () => unknown;
}

type Show = (message: string, ...labels: string[]) => Thenable<string | undefined>;

/** Shows a notification and runs the action of the button that is pressed. */
async function notify(show: Show, message: string, buttons: readonly Button[]): Promise<void> {
  const pressed = await show(message, ...buttons.map(({ label }) => label));
  await buttons.find(({ label }) => label === pressed)?.press();
}

// Not awaited: a notification may stay for hours.
export const showInformation = (message: string, ...buttons: Button[]) => void notify(vscode.window.showInformationMessage, message, buttons);
export const showWarning = (message: string, ...buttons: Button[]) => void notify(vscode.window.showWarningMessage, message, buttons);
export const showError = (message: string, ...buttons: Button[]) => void notify(vscode.window.showErrorMessage, message, buttons);
