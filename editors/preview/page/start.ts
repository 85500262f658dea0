// Starts the page with what connects it to its host.
import { pageState, type FromPage, type PageState, type ToPage } from "../host/messages";
import { Preview } from "./preview";

/** The page's side of the messages to and from its host, and where it keeps its state. */
export interface Connection {
  post: (message: FromPage) => void;
  /** Calls back with each message of the host. */
  listen: (receive: (message: ToPage) => void) => void;
  /** What `saveState` was last called with, also before the page was loaded again; anything else counts as no state. */
  loadState: () => unknown;
  saveState: (state: PageState) => void;
}

/** Fills the body of a page, whose colours are those of VS Code, or set by `setColours`. */
export function startPreview(connection: Connection): void {
  const preview = new Preview(document.body, pageState(connection.loadState()), connection);
  connection.listen((message) => preview.receive(message));
  connection.post({ type: "ready" });
}
