// A server's process, and what to do when it ends unasked. Knows nothing of VS Code.
import { type ChildProcessWithoutNullStreams, spawn } from "node:child_process";

import type { Program } from "./executables";

/** A server that ended so many times within `WITHIN` is not started again. */
const MOST_ENDS = 5;

/** In milliseconds. */
const WITHIN = 3 * 60_000;

/** Starts a program, in a folder if there is one; it fails where the system cannot start it. */
export function launch(program: Program, folder: string | undefined): Promise<ChildProcessWithoutNullStreams> {
  return new Promise((resolve, reject) => {
    const child = spawn(program.command, program.args, { cwd: folder });
    child.once("spawn", () => resolve(child));
    // Not once: a process that cannot be ended says so by the same event, and one that nobody hears ends the extension host.
    child.on("error", reject);
  });
}

/** Counts how often a server ended unasked. */
export class Ends {
  private times: number[] = [];

  /** Takes note of an end; whether a further start is worth it. */
  add(now: number): boolean {
    this.times = [...this.times.filter((time) => now - time < WITHIN), now];
    return this.times.length < MOST_ENDS;
  }
}
