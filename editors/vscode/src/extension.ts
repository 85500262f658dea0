// The extension: starts the language server and adds what the protocol has no word for.
import type * as vscode from "vscode";

import { registerPreview } from "./preview";
import { Session } from "./session";

export async function activate(context: vscode.ExtensionContext): Promise<void> {
  const session = new Session(context);
  context.subscriptions.push(session, registerPreview(context, () => session.client));
  await session.start();
}
