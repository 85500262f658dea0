// Spawns the server's process. Does not depend on VS Code.
import { type ChildProcessWithoutNullStreams, spawn } from "node:child_process";

import type { Executable } from "./executables";

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
