// Ticks off the steps of the walkthrough as a person first does them.
import * as vscode from "vscode";

/** The walkthrough of the manifest, as VS Code names it. */
const WALKTHROUGH = "pydslrep.pydslrep#start";

/** The steps; `pydslrep.done.…` is the context that the manifest names for each. */
export type Milestone = "program" | "preview" | "run" | "script";

/** The steps done in this window. */
const done = new Set<Milestone>();

export function reached(milestone: Milestone): void {
  if (done.has(milestone)) {
    return;
  }
  done.add(milestone);
  void vscode.commands.executeCommand("setContext", `pydslrep.done.${milestone}`, true);
  // VS Code registers the steps when a walkthrough is first opened in a window, and ignores a context that was set
  // before. Its own command records a step at any time, but fails for one that is not registered yet.
  vscode.commands.executeCommand("welcome.markStepComplete", `${WALKTHROUGH}#${milestone}`).then(undefined, () => undefined);
}

/** Notices programs and scripts that are not written by a command of the extension. */
export function registerMilestones(): vscode.Disposable {
  return vscode.Disposable.from(
    vscode.workspace.onDidSaveTextDocument((document) => {
      if (document.languageId === "pydslrep" && document.getText().trim() !== "") {
        reached("program");
      }
    }),
    // The code action that generates a script is an edit that creates the file.
    vscode.workspace.onDidCreateFiles(({ files }) => {
      if (files.some(({ path }) => path.endsWith(".py")) && vscode.window.activeTextEditor?.document.languageId === "pydslrep") {
        reached("script");
      }
    }),
  );
}
