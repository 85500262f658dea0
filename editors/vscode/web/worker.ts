// Starts the worker of the language server.
import * as vscode from "vscode";

/** A worker that has begun to load the server; `editors/web/src/worker.ts` is in it. */
export async function startWorker(extension: vscode.Uri): Promise<Worker> {
  const [script, wasm] = await Promise.all(
    ["worker.js", "pydslrep_bg.wasm"].map((name) => read(vscode.Uri.joinPath(extension, "dist", name))),
  );
  // The extension may be on another host than the editor, or on none: browsers start workers only from their own.
  // It is not revoked: VS Code's own workers load it later.
  const worker = new Worker(URL.createObjectURL(new Blob([script as BlobPart], { type: "text/javascript" })));
  worker.postMessage({ wasm });
  return worker;
}

async function read(file: vscode.Uri): Promise<Uint8Array> {
  if (file.scheme === "https" || file.scheme === "http") {
    const response = await fetch(file.toString(true));
    if (!response.ok) {
      throw new Error(`${file.path}: ${response.status} ${response.statusText}`);
    }
    return new Uint8Array(await response.arrayBuffer());
  }
  return vscode.workspace.fs.readFile(file);
}
