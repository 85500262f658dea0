// The preview's page in a browser, next to an editor whose language server serves it.
import type { Request } from "../host/follower";
import { PreviewHost } from "../host/host";
import type { ToPage } from "../host/messages";
import type { EnvironmentId, Position } from "../host/protocol";
import { followBrowserColours } from "../page/colours";
import { sessionState } from "../page/frame";
import { startPreview } from "../page/start";
import { download } from "./download";

/** The server's notification of where the cursor is; null if it has not seen one. */
const CURSOR_MOVED = "pydslrep/cursorMoved";
/** The request to show a location in the editor. */
const REVEAL = "pydslrep/reveal";
/** The request to apply a fix in the editor; the server names none where the editor cannot. */
const APPLY_FIX = "pydslrep/applyFix";

interface Cursor {
  textDocument: { uri: string };
  position: Position;
  /** The environment to show. */
  environment?: string;
  /** Whether it is where the text was edited. */
  isEdit: boolean;
}

interface Response {
  result?: unknown;
  error?: { message: string; data?: unknown };
}

let receive: (message: ToPage) => void = () => undefined;
let latest: Cursor | undefined;
let requests = 0;

const send: Request = async (method, params, signal) => {
  requests += 1;
  const body = JSON.stringify({ jsonrpc: "2.0", id: requests, method, params });
  const answer = await fetch("messages", { method: "POST", headers: { "content-type": "application/json" }, body, signal });
  if (!answer.ok) throw new Error(GONE);
  const { result, error } = (await answer.json()) as Response;
  if (error) throw Object.assign(new Error(error.message), { data: error.data });
  return result;
};

const GONE = "The editor's session has ended, or its language server was restarted: open the preview again.";

const host = new PreviewHost(send, (message) => receive(withoutSuggestion(message)), {
  reveal: (location) => void send(REVEAL, location, new AbortController().signal),
  accept: () => undefined,
  fix: (location, fix) => void send(APPLY_FIX, { location, fix }, new AbortController().signal),
  export: () => void host.capture().then((png) => download(png, `${host.follower.shown?.environment ?? "path"}.png`)),
});

followBrowserColours();
startPreview({
  post: (message) => void host.received(message),
  listen: (listener) => (receive = listener),
  // One tab shows one program after the other.
  ...sessionState("preview"),
});

const events = new EventSource("events");
events.onmessage = ({ data }: MessageEvent<string>) => {
  const { method, params } = JSON.parse(data) as { method: string; params: unknown };
  if (method === CURSOR_MOVED) void moved(params as Cursor | null);
  else void host.notified(method, params as EnvironmentId);
};
// The browser tries again.
events.onerror = () => receive({ type: "problem", uri: latest?.textDocument.uri ?? null, message: GONE });
// Everything may have changed while there was no connection, but not what the user has selected.
let isConnectedAgain = false;
events.onopen = () => {
  isConnectedAgain = host.follower.program !== undefined;
  void host.follower.resend();
};

async function moved(cursor: Cursor | null): Promise<void> {
  if (!cursor) return;
  latest = cursor;
  const { textDocument, position, environment, isEdit } = cursor;
  document.title = `Path: ${decodeURIComponent(textDocument.uri.slice(textDocument.uri.lastIndexOf("/") + 1))}`;
  if (isEdit && textDocument.uri === host.follower.program) await host.follower.update(position);
  else await host.follower.follow(textDocument.uri, position, isConnectedAgain ? undefined : environment);
  isConnectedAgain = false;
}

/** The page cannot edit the program. */
function withoutSuggestion(message: ToPage): ToPage {
  if (message.type !== "problem") return message;
  const { suggestion, ...rest } = message;
  return suggestion === undefined ? message : rest;
}
