// A client of the language server.
import { spawn } from "node:child_process";
import { pathToFileURL } from "node:url";

import { createMessageConnection, StreamMessageReader, StreamMessageWriter } from "vscode-jsonrpc/node";

export class Server {
  /** Starts the server in a folder, for a client with these capabilities. */
  static async start(folder, capabilities = {}) {
    const server = new Server();
    server.child = spawn(process.env.PYDSLREP_LSP, ["--stdio"], { stdio: ["pipe", "pipe", "ignore"] });
    const { stdout, stdin } = server.child;
    server.connection = createMessageConnection(new StreamMessageReader(stdout), new StreamMessageWriter(stdin));
    server.connection.listen();
    const workspaceFolders = [{ uri: pathToFileURL(folder).href, name: "examples" }];
    await server.connection.sendRequest("initialize", { processId: process.pid, rootUri: null, workspaceFolders, capabilities });
    await server.connection.sendNotification("initialized", {});
    return server;
  }

  open(uri, text) {
    this.version = 1;
    return this.connection.sendNotification("textDocument/didOpen", {
      textDocument: { uri, languageId: "pydslrep", version: this.version, text },
    });
  }

  /** Replaces a range. */
  change(uri, range, text) {
    this.version += 1;
    return this.connection.sendNotification("textDocument/didChange", {
      textDocument: { uri, version: this.version },
      contentChanges: [{ range, text }],
    });
  }

  /** Moves the cursor to the first line, as an editor reports it: what has been typed elsewhere is judged. */
  leaveLine(uri) {
    return this.request("textDocument/documentHighlight", { textDocument: { uri }, position: { line: 0, character: 0 } });
  }

  request(method, params) {
    return this.connection.sendRequest(method, params);
  }

  on(method, handler) {
    this.connection.onNotification(method, handler);
  }

  async stop() {
    await this.connection.sendRequest("shutdown");
    await this.connection.sendNotification("exit");
    this.connection.dispose();
  }
}

/** The LSP range of a part of a text. */
export function rangeOf(text, part, from = 0) {
  const start = text.indexOf(part, from);
  if (start < 0) throw new Error(`no ${part}`);
  const position = (offset) => {
    const lines = text.slice(0, offset).split("\n");
    return { line: lines.length - 1, character: lines.at(-1).length };
  };
  return { start: position(start), end: position(start + part.length) };
}
