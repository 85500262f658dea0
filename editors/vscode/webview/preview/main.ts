// The preview's page in the browser: connects it to VS Code.
import { pageState, type FromPage, type PageState, type ToPage } from "../../src/preview/messages";
import { Preview } from "./preview";

/** The API that VS Code gives a page. */
interface VsCodeApi {
  postMessage(message: FromPage): void;
  getState(): unknown;
  setState(state: PageState): void;
}
declare function acquireVsCodeApi(): VsCodeApi;

const vscode = acquireVsCodeApi();
const preview = new Preview(document.body, pageState(vscode.getState()), {
  post: (message) => vscode.postMessage(message),
  saveState: (state) => vscode.setState(state),
});
window.addEventListener("message", (event: MessageEvent<ToPage>) => preview.receive(event.data));
vscode.postMessage({ type: "ready" });
