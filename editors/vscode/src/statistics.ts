// How much shorter a program is than its scripts, and which version this is.
import { execFile } from "node:child_process";
import * as path from "node:path";

import * as vscode from "vscode";

import { fail, inform } from "./notifications";
import { findCommand } from "./executables";
import type { Session } from "./session";
import { sentence } from "./failure";

/** Lines of a program, and of the Python that it stands for. */
interface Lines {
  program: number;
  python: number;
  /** Percent. */
  saved: number;
}

export interface Statistics {
  environments: ({ environment: string } & Lines)[];
  total: Lines;
}

/** Counts the program in the editor as it is there, saved or not. */
export async function showStatistics(session: Session): Promise<void> {
  const document = vscode.window.activeTextEditor?.document;
  if (document?.languageId !== "pydslrep") {
    inform("Open a program (a file that ends in .pyr) first.");
    return;
  }
  const command = findCommand(session.places());
  if (command === undefined) {
    fail("There is no command `pydslrep`: neither in the extension nor beside the server nor on the PATH.");
    return;
  }
  const folder = document.uri.scheme === "file" ? path.dirname(document.uri.fsPath) : vscode.workspace.workspaceFolders?.[0]?.uri.fsPath;
  try {
    const printed = await print(command, ["stats", "-", "--json"], folder, document.getText());
    inform(inWords(JSON.parse(printed) as Statistics));
  } catch (error) {
    fail(sentence(error instanceof Error ? error.message : String(error)));
  }
}

/** What a command prints; the error is what it says else. */
function print(command: string, args: string[], folder: string | undefined, input: string): Promise<string> {
  return new Promise((resolve, reject) => {
    const child = execFile(command, args, { cwd: folder }, (error, stdout, stderr) => {
      if (stdout.trim() !== "") {
        resolve(stdout);
      } else {
        reject(new Error(stderr.trim() === "" ? (error?.message ?? "pydslrep exited without output") : stderr));
      }
    });
    child.stdin?.on("error", () => undefined);
    child.stdin?.end(input);
  });
}

/** The lines in a sentence. */
export function inWords({ environments, total }: Statistics): string {
  const [only, ...others] = environments;
  if (only === undefined) {
    return "No environment of this program is without errors, so there is no script to compare with.";
  }
  const name = others.length === 0 ? only.environment : `${environments.length} environments`;
  return `${name}: ${total.program} lines of program stand for ${total.python} lines of Python (${total.saved.toFixed(0)} % fewer).`;
}

/** Says which extension and which server this is. */
export function showVersion(session: Session, version: string): void {
  const server = session.client?.initializeResult?.serverInfo?.version;
  const place = session.program?.command ?? "none";
  const words = server === undefined ? `PyDSLRep ${version}, no server running (${place})` : `PyDSLRep ${version}, server ${server} (${place})`;
  inform(words, { label: "Copy", press: () => vscode.env.clipboard.writeText(words) });
}
