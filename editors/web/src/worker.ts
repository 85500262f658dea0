// The language server in a worker. The first message is a `Start`; then both sides send one JSON-RPC object per message, as
// `BrowserMessageReader` and `BrowserMessageWriter` of vscode-jsonrpc do. It may be started from a blob: address.
import init, { LanguageServer } from "../dist/pydslrep.js";

/** Where the WebAssembly is. */
interface Start {
  wasm: string | WebAssembly.Module | BufferSource;
}

interface Message {
  id?: number | string | null;
  method?: string;
}

/** JSON-RPC's code for internal errors. */
const INTERNAL_ERROR = -32603;

class Conversation {
  private readonly server = new LanguageServer();
  private readonly turns = new MessageChannel();
  private isTurnDue = false;
  private failure: string | undefined;

  constructor() {
    this.turns.port1.onmessage = () => this.attempt(() => this.turn());
  }

  receive(message: Message): void {
    this.attempt(() => {
      this.server.handle(JSON.stringify(message));
      this.send();
      this.plan();
    }, message);
  }

  /** Messages that wait come before a turn: each may change or cancel what it would do. */
  private plan(): void {
    if (!this.isTurnDue) {
      this.isTurnDue = true;
      this.turns.port2.postMessage(null);
    }
  }

  private turn(): void {
    this.isTurnDue = false;
    if (this.server.proceed()) {
      this.plan();
    }
    this.send();
  }

  private send(): void {
    for (const message of this.server.takeMessages()) {
      postMessage(JSON.parse(message));
    }
  }

  /** After a panic the WebAssembly cannot go on: requests are refused until the client starts another worker. */
  private attempt(run: () => void, message: Message = {}): void {
    if (this.failure === undefined) {
      try {
        run();
        return;
      } catch (error) {
        this.failure = `internal error: ${String(error)}`;
        crashed(this.failure);
      }
    }
    refuse(message, this.failure);
  }
}

async function start({ wasm }: Start): Promise<Conversation> {
  await init({ module_or_path: wasm });
  return new Conversation();
}

let conversation: Promise<Conversation> | undefined;

addEventListener("message", ({ data }: MessageEvent<unknown>) => {
  if (conversation === undefined) {
    conversation = start(data as Start);
    conversation.catch((error: unknown) => crashed(unstarted(error)));
  } else {
    // What comes before the server is there waits in order.
    conversation.then(
      (started) => started.receive(data as Message),
      (error: unknown) => refuse(data as Message, unstarted(error)),
    );
  }
});

function unstarted(error: unknown): string {
  return `the language server does not start: ${String(error)}`;
}

/** Answers a request, if it is one, with an error. */
function refuse({ id, method }: Message, message: string): void {
  if (method !== undefined && id !== undefined) {
    postMessage({ jsonrpc: "2.0", id, error: { code: INTERNAL_ERROR, message } });
  }
}

function crashed(message: string): void {
  postMessage({ jsonrpc: "2.0", method: "pydslrep/crashed", params: { message } });
}
