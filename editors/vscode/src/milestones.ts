// What a person has done for the first time: the steps of the walkthrough are ticked off by it.
import * as vscode from "vscode";

/** The steps; `pydslrep.done.…` is the context that the manifest names for each. */
export type Milestone = "program" | "preview" | "run" | "script";

export function reached(milestone: Milestone): void {
  void vscode.commands.executeCommand("setContext", `pydslrep.done.${milestone}`, true);
}

/** Programs and scripts that come to be in other ways than by a command of ours. */
export function registerMilestones(): vscode.Disposable {
  return vscode.Disposable.from(
    vscode.workspace.onDidSaveTextDocument((document) => {
      if (document.languageId === "pydslrep" && document.getText().trim() !== "") {
        reached("program");
      }
    }),
    // A code action makes a script by an edit, which begins with the file.
    vscode.workspace.onDidCreateFiles(({ files }) => {
      if (files.some(({ path }) => path.endsWith(".py")) && vscode.window.activeTextEditor?.document.languageId === "pydslrep") {
        reached("script");
      }
    }),
  );
}
