// The messages between the page and the worker that runs scripts.
import type { DrivenRobot } from "../../../preview/host/protocol";

/** What a run needs. */
export interface Task {
  /** The name of the script's file. */
  file: string;
  script: string;
  /** Further arguments of the script. */
  arguments: string[];
  /** The environment, and the files that its world is made of. */
  world: WorldFiles;
}

export interface WorldFiles {
  environment: string;
  /** The URI of the program. */
  program: string;
  /** Texts by URI: the program, what it imports, settings and scenes. */
  files: Record<string, string>;
}

/** What a run wrote. */
export interface Results {
  trace: string;
  map: string | null;
}

export type FromRun =
  /** Python is loaded. */
  | { type: "ready" }
  | { type: "output"; text: string; isError: boolean }
  /** The simulated time, seconds, and the paths so far, thinned. */
  | { type: "driven"; time: number; robots: DrivenRobot[] }
  /** The script has ended, with its exit code. */
  | { type: "ended"; code: number; results: Results }
  /** Something else than the script failed. */
  | { type: "failed"; message: string };
