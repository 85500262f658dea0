// The language server for as long as the window is open: found, started, and started again.
import { statSync } from "node:fs";
import * as os from "node:os";

import * as vscode from "vscode";
import { LanguageClient } from "vscode-languageclient/node";

import { findServer, type Places } from "./server";

export class Session implements vscode.Disposable {
  /** The connection to the server; none where no server was found. */
  client: LanguageClient | undefined;

  constructor(private readonly context: vscode.ExtensionContext) {}

  async start(): Promise<void> {
    const server = findServer(this.places());
    if (!("command" in server)) {
      void vscode.window.showErrorMessage(server.reason);
      return;
    }
    this.client = new LanguageClient("pydslrep", "PyDSLRep", server, {
      documentSelector: [{ language: "pydslrep" }, { pattern: "**/pydslrep.toml" }, { pattern: "**/*.scene.toml" }],
    });
    await this.client.start();
  }

  dispose(): void {
    void this.client?.dispose();
  }

  private places(): Places {
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
}
