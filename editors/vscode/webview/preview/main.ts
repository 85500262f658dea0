// The browser side of the path preview.
import { pageState, type FromPage, type PageState, type ToPage } from "../../src/preview/messages";
import { Preview } from "./preview";

/** What VS Code gives a page. */
interface Host {
  postMessage(message: FromPage): void;
  getState(): unknown;
  setState(state: PageState): void;
}
declare function acquireVsCodeApi(): Host;

const host = acquireVsCodeApi();
const preview = new Preview(document.body, pageState(host.getState()), {
  say: (message) => host.postMessage(message),
  keep: (state) => host.setState(state),
});
window.addEventListener("message", (event: MessageEvent<ToPage>) => preview.hear(event.data));
host.postMessage({ type: "ready" });
