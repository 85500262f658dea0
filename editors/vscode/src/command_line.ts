// Runs the command `pydslrep` and reports its failures.
import { execFile } from "node:child_process";

import { findCommand } from "./executables";
import { showError } from "./notifications";
import { sentence } from "../../preview/host/sentence";
import type { Session } from "./session";

/** The path of the command; undefined, with a message, if it is not installed. */
export function findCommandLine(session: Session): string | undefined {
  const command = findCommand(session.searchPaths());
  if (command === undefined) {
    showError("The command `pydslrep` was not found in the extension, next to the server or on the PATH.");
  }
  return command;
}

/** The standard output of the command; undefined, with its error as a message, if it prints none. */
export async function runCommandLine(command: string, args: string[], folder: string | undefined, input = ""): Promise<string | undefined> {
  try {
    return await output(command, args, folder, input);
  } catch (error) {
    showError(sentence(error instanceof Error ? error.message : String(error)));
    return undefined;
  }
}

function output(command: string, args: string[], folder: string | undefined, input: string): Promise<string> {
  return new Promise((resolve, reject) => {
    const child = execFile(command, args, { cwd: folder }, (error, stdout, stderr) => {
      if (stdout.trim() !== "") {
        resolve(stdout);
      } else {
        reject(new Error(stderr.trim() === "" ? (error?.message ?? "pydslrep exited without output") : stderr));
      }
    });
    // The command may exit without reading its input.
    child.stdin?.on("error", () => undefined);
    child.stdin?.end(input);
  });
}
