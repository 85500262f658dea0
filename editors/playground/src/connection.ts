// The connection to the language server in its worker. The client of CodeMirror shares it with requests of our own.
import type { Transport } from "@codemirror/lsp-client";

interface Message {
  id?: number | string;
  method?: string;
  params?: unknown;
  result?: unknown;
  error?: { code: number; message: string; data?: unknown };
}

/** An error that the server answers. */
export class ServerError extends Error {
  constructor(
    readonly code: number,
    message: string,
    readonly data?: unknown,
  ) {
    super(message);
  }
}

/** Answers a request of the server; what it does not know, the server is told. */
export type Answer = (method: string, params: unknown) => unknown;

/** The capability of asking for diagnostics. CodeMirror's client announces it and never asks, so they would not come. */
const PULLED = "diagnostic";

/** Ids of our own requests start with this; those of CodeMirror's client are numbers. */
const PREFIX = "page-";

export class Connection implements Transport {
  private readonly subscribers = new Set<(message: string) => void>();
  private readonly pending = new Map<string, { resolve: (result: unknown) => void; reject: (error: Error) => void }>();
  private readonly listeners = new Map<string, (params: never) => void>();
  private sent = 0;
  /** Settled when the session has begun: messages of our own wait for it, as those of CodeMirror's client do. */
  private beginning: Promise<unknown> = Promise.resolve();

  constructor(
    private readonly worker: Worker,
    private readonly answer: Answer,
  ) {
    worker.addEventListener("message", (event: MessageEvent<Message>) => this.receive(event.data));
  }

  // For CodeMirror's client

  send(message: string): void {
    this.worker.postMessage(JSON.parse(message, (key, value: unknown) => (key === PULLED ? undefined : value)));
  }

  subscribe(handler: (message: string) => void): void {
    this.subscribers.add(handler);
  }

  unsubscribe(handler: (message: string) => void): void {
    this.subscribers.delete(handler);
  }

  // For everything else

  /** Call this before anything is sent. */
  waitFor(beginning: Promise<unknown>): void {
    this.beginning = beginning;
  }

  /** Sends a request; rejects with a `ServerError`. Aborting cancels it. */
  request(method: string, params: unknown, signal?: AbortSignal): Promise<unknown> {
    const id = `${PREFIX}${++this.sent}`;
    signal?.addEventListener("abort", () => this.notify("$/cancelRequest", { id }), { once: true });
    return new Promise((resolve, reject) => {
      this.pending.set(id, { resolve, reject });
      this.post({ jsonrpc: "2.0", id, method, params });
    });
  }

  notify(method: string, params: unknown): void {
    this.post({ jsonrpc: "2.0", method, params });
  }

  /** Calls back with each notification of this kind. */
  on(method: string, listener: (params: never) => void): void {
    this.listeners.set(method, listener);
  }

  private post(message: object): void {
    void this.beginning.then(() => this.worker.postMessage(message));
  }

  private receive(message: Message): void {
    const { id, method } = message;
    if (method === undefined && typeof id === "string" && id.startsWith(PREFIX)) {
      this.settle(id, message);
    } else if (method !== undefined && id !== undefined) {
      this.worker.postMessage({ jsonrpc: "2.0", id, ...this.answerTo(method, message.params) });
    } else {
      const listener = method === undefined ? undefined : this.listeners.get(method);
      if (listener) listener(message.params as never);
      else for (const handler of this.subscribers) handler(JSON.stringify(message));
    }
  }

  private settle(id: string, { result, error }: Message): void {
    const request = this.pending.get(id);
    this.pending.delete(id);
    if (error) request?.reject(new ServerError(error.code, error.message, error.data));
    else request?.resolve(result);
  }

  private answerTo(method: string, params: unknown): Partial<Message> {
    const result = this.answer(method, params);
    return result === undefined ? { error: { code: -32601, message: `the page has no ${method}` } } : { result };
  }
}
