// The language server with programs open, as an editor has them.
import { spawn } from "node:child_process";
import { pathToFileURL } from "node:url";

import { createMessageConnection, StreamMessageReader, StreamMessageWriter } from "vscode-jsonrpc/node";

export class Server {
  /** Starts the server in a folder. */
  static async start(folder) {
    const server = new Server();
    server.child = spawn(process.env.PYDSLREP_LSP, ["--stdio"], { stdio: ["pipe", "pipe", "ignore"] });
    const { stdout, stdin } = server.child;
    server.connection = createMessageConnection(new StreamMessageReader(stdout), new StreamMessageWriter(stdin));
    server.connection.listen();
    const workspaceFolders = [{ uri: pathToFileURL(folder).href, name: "examples" }];
    await server.connection.sendRequest("initialize", { processId: process.pid, rootUri: null, workspaceFolders, capabilities: {} });
    await server.connection.sendNotification("initialized", {});
    return server;
  }

  /** Opens a program. */
  open(uri, text) {
    this.version = 1;
    return this.connection.sendNotification("textDocument/didOpen", {
      textDocument: { uri, languageId: "pydslrep", version: this.version, text },
    });
  }

  /** Puts text in the place of a range. */
  change(uri, range, text) {
    this.version += 1;
    return this.connection.sendNotification("textDocument/didChange", {
      textDocument: { uri, version: this.version },
      contentChanges: [{ range, text }],
    });
  }

  ask(method, params) {
    return this.connection.sendRequest(method, params);
  }

  on(method, heard) {
    this.connection.onNotification(method, heard);
  }

  async stop() {
    await this.connection.sendRequest("shutdown");
    await this.connection.sendNotification("exit");
    this.connection.dispose();
  }
}

/** Where a piece of a text is in it, as a range of the protocol. */
export function rangeOf(text, piece, from = 0) {
  const start = text.indexOf(piece, from);
  if (start < 0) throw new Error(`no ${piece}`);
  const place = (offset) => {
    const lines = text.slice(0, offset).split("\n");
    return { line: lines.length - 1, character: lines.at(-1).length };
  };
  return { start: place(start), end: place(start + piece.length) };
}
