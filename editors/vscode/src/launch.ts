// Spawns the server's process and decides whether to restart it after a crash. Does not depend on VS Code.
import { type ChildProcessWithoutNullStreams, spawn } from "node:child_process";

import type { Executable } from "./executables";

/** A server that crashes this many times within `WINDOW` is not restarted. */
const MAX_CRASHES = 5;

/** Milliseconds. */
const WINDOW = 3 * 60_000;

/** Spawns an executable; rejects if the system cannot start it. */
export function launch({ command, args }: Executable, folder: string | undefined): Promise<ChildProcessWithoutNullStreams> {
  return new Promise((resolve, reject) => {
    const child = spawn(command, args, { cwd: folder });
    child.once("spawn", () => resolve(child));
    // Not `once`: a process that cannot be killed emits another error, and an error without a listener ends the extension
    // host.
    child.on("error", reject);
  });
}

/** Counts the recent crashes of a server. */
export class CrashCounter {
  private times: number[] = [];

  /** Records a crash; returns whether to restart the server. */
  add(now: number): boolean {
    this.times = [...this.times.filter((time) => now - time < WINDOW), now];
    return this.times.length < MAX_CRASHES;
  }
}
