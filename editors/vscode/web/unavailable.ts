// The commands that need a process. The manifest hides them in a browser once the extension is active; the walkthrough and
// keybindings still have them.
import * as vscode from "vscode";

import { showInformation } from "../src/notifications";

const COMMANDS = {
  "pydslrep.runInSimulator": "Running programs",
  "pydslrep.pushToCoppeliaSim": "Building scenes in CoppeliaSim",
  "pydslrep.checkInCoppeliaSim": "Checking scenes in CoppeliaSim",
  "pydslrep.removeFromCoppeliaSim": "Removing scenes from CoppeliaSim",
  "pydslrep.newProgram": "Creating a program with its scene",
  "pydslrep.showStatistics": "Counting the lines of scripts",
};

export function registerUnavailableCommands(): vscode.Disposable {
  const commands = Object.entries(COMMANDS).map(([command, what]) =>
    vscode.commands.registerCommand(command, () => {
      showInformation(`${what} needs VS Code on a computer: a browser cannot start programs.`);
    }),
  );
  return vscode.Disposable.from(...commands);
}
