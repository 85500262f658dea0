// A page in Chromium with the files of editors/web/dist, under a strict content security policy.
import { createReadStream, existsSync } from "node:fs";
import { createServer } from "node:http";
import path from "node:path";

import { chromium } from "playwright-core";

const dist = path.resolve(import.meta.dirname, "../../../editors/web/dist");

const TYPES = { ".js": "text/javascript", ".wasm": "application/wasm" };

const POLICY = [
  "default-src 'none'",
  "connect-src 'self'",
  "script-src 'self' 'wasm-unsafe-eval'",
  "worker-src 'self' blob:",
].join("; ");

/** Opens an empty page; `close` ends everything. */
export async function openPage() {
  const server = createServer((request, response) => {
    const name = path.basename(request.url);
    const file = path.join(dist, name);
    response.setHeader("Content-Security-Policy", POLICY);
    if (name === "") {
      response.setHeader("Content-Type", "text/html").end("<!doctype html><title>test</title>");
    } else if (existsSync(file)) {
      response.setHeader("Content-Type", TYPES[path.extname(name)] ?? "text/plain");
      createReadStream(file).pipe(response);
    } else {
      response.writeHead(404).end();
    }
  });
  await new Promise((resolve) => server.listen(0, "127.0.0.1", resolve));
  const browser = await chromium.launch({
    executablePath: process.env.CHROMIUM,
    args: ["--no-sandbox", "--disable-gpu", "--no-first-run"],
  });
  const page = await browser.newPage();
  page.setDefaultTimeout(60_000);
  const errors = [];
  page.on("pageerror", (error) => errors.push(String(error)));
  page.on("console", (message) => message.type() === "error" && errors.push(message.text()));
  await page.goto(`http://127.0.0.1:${server.address().port}/`);
  await page.evaluate(installClient);
  const close = async () => {
    await browser.close();
    server.close();
  };
  return { page, errors, close };
}

/** Runs in the page: adds the class of a language client to it. */
function installClient() {
  globalThis.Client = class {
    /** Starts a worker and a session in the folder `/w`. */
    static async start({ fromBlob = false, capabilities = {} } = {}) {
      const client = new Client();
      const begin = performance.now();
      let address = "/worker.js";
      let wasm = new URL("/pydslrep_bg.wasm", location.href).href;
      if (fromBlob) {
        const read = async (name) => (await fetch(name)).arrayBuffer();
        address = URL.createObjectURL(new Blob([await read(address)], { type: "text/javascript" }));
        wasm = await read(wasm);
      }
      Object.assign(client, { worker: new Worker(address), answers: new Map(), published: new Map(), waiting: [], last: 0, begin });
      client.worker.onmessage = ({ data }) => client.receive(data);
      client.worker.postMessage({ wasm });
      const workspaceFolders = [{ uri: "file:///w", name: "w" }];
      client.initialized = await client.request("initialize", { processId: null, rootUri: null, workspaceFolders, capabilities });
      client.notify("initialized", {});
      return client;
    }

    /** Moves the cursor to the first line, as an editor reports it: what has been typed elsewhere is judged. */
    leaveLine(uri) {
      return this.request("textDocument/documentHighlight", { textDocument: { uri }, position: { line: 0, character: 0 } });
    }

    receive(message) {
      if (message.method === "textDocument/publishDiagnostics") {
        const { uri, diagnostics } = message.params;
        this.published.set(uri, diagnostics.map((problem) => problem.message));
        this.waiting.splice(0).forEach((resolve) => resolve());
      } else if (message.method === undefined) {
        this.answers.get(message.id)(message);
      } else {
        this.other = message;
        this.waiting.splice(0).forEach((resolve) => resolve());
      }
    }

    notify(method, params) {
      this.worker.postMessage({ jsonrpc: "2.0", method, params });
    }

    /** The answer, with its id. */
    send(method, params) {
      const id = (this.last += 1);
      this.worker.postMessage({ jsonrpc: "2.0", id, method, params });
      return new Promise((resolve) => this.answers.set(id, resolve));
    }

    async request(method, params) {
      const { result, error } = await this.send(method, params);
      if (error) throw new Error(error.message);
      return result;
    }

    open(uri, text) {
      this.version = 1;
      this.notify("textDocument/didOpen", { textDocument: { uri, languageId: "pydslrep", version: 1, text } });
    }

    change(uri, line, character, text, length = 0) {
      this.version += 1;
      const range = { start: { line, character }, end: { line, character: character + length } };
      this.notify("textDocument/didChange", { textDocument: { uri, version: this.version }, contentChanges: [{ range, text }] });
    }

    provide(files) {
      this.notify("pydslrep/files", { files });
    }

    /** Resolves when the diagnostics of a document are as a test wants them. */
    async problems(uri, wanted) {
      while (!(this.published.has(uri) && wanted(this.published.get(uri)))) {
        await new Promise((resolve) => this.waiting.push(resolve));
      }
      return this.published.get(uri);
    }
  };
}
