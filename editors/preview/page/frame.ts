// Connects a page in a frame to the page around it, which must be of the same origin.
import type { ToPage } from "../host/messages";
import type { Connection } from "./start";

/** The state is kept under this key in the session's storage. */
export function frameConnection(stateKey: string): Connection {
  return {
    post: (message) => window.parent.postMessage(message, location.origin),
    listen: (receive) =>
      window.addEventListener("message", (event: MessageEvent<ToPage>) => {
        if (event.source === window.parent && event.origin === location.origin) receive(event.data);
      }),
    ...sessionState(stateKey),
  };
}

/** State that lives as long as the browser's tab. */
export function sessionState(key: string): Pick<Connection, "loadState" | "saveState"> {
  return {
    loadState: () => {
      try {
        return JSON.parse(sessionStorage.getItem(key) ?? "null") as unknown;
      } catch {
        return undefined;
      }
    },
    saveState: (state) => sessionStorage.setItem(key, JSON.stringify(state)),
  };
}
