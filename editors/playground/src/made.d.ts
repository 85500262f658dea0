// The modules that `scripts/build.mjs` makes or finds elsewhere in the repository.

/** The example projects and the files that they import. */
declare module "virtual:examples" {
  type Project = import("./documents").Project;

  export const groups: readonly { label: string; projects: readonly Project[] }[];
  /** Texts by their path in the project's folder. */
  export const imported: Readonly<Record<string, string>>;
}

/** What scripts import. */
declare module "virtual:python" {
  /** `python/pydslrep_runtime`, and the stand-in for `zmq`, by path. */
  export const files: Readonly<Record<string, string>>;
  /** The names of the packages in `pyodide/`. */
  export const wheels: readonly string[];
}

/** What wasm-bindgen makes of crates/browser. */
declare module "virtual:pydslrep" {
  export default function initialize(options: { module_or_path: URL }): Promise<unknown>;

  /** Replies are tickets and messages; see crates/browser. */
  export class Simulator {
    constructor(input: string);
    readonly isFreeRunning: boolean;
    request(connection: number, ticket: number, now: number, message: Uint8Array): [number, Uint8Array][];
    disconnect(connection: number): [number, Uint8Array][];
    tick(): [number, Uint8Array][];
    free(): void;
  }
}
