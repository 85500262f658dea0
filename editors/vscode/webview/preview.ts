// The preview's page in VS Code.
import type { FromPage, PageState, ToPage } from "../../preview/host/messages";
import { startPreview } from "../../preview/page/start";

/** The API that VS Code gives a page. */
interface VsCodeApi {
  postMessage(message: FromPage): void;
  getState(): unknown;
  setState(state: PageState): void;
}
declare function acquireVsCodeApi(): VsCodeApi;

const vscode = acquireVsCodeApi();
startPreview({
  post: (message) => vscode.postMessage(message),
  listen: (receive) => window.addEventListener("message", (event: MessageEvent<ToPage>) => receive(event.data)),
  loadState: () => vscode.getState(),
  saveState: (state) => vscode.setState(state),
});
