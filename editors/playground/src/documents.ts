// The files of the playground: a program, its settings, and the scene of each environment.

/** What a permalink carries, and what an example consists of. */
export interface Project {
  /** The program's file name without `.pyr`; generated scripts name it. */
  name: string;
  program: string;
  /** The text of `pydslrep.toml`. */
  settings: string;
  /** The texts of scene files, by environment. */
  scenes: Record<string, string>;
}

/** The folder in which the server sees the files. */
export const FOLDER = "file:///playground/";
export const SETTINGS_URI = `${FOLDER}pydslrep.toml`;

export function programUri(name: string): string {
  return `${FOLDER}${encodeURIComponent(name)}.pyr`;
}

/** The scene file of an environment. Without text there is no file, so the editor shows one that belongs to no environment. */
export function sceneUri(environment: string | undefined, text: string): string {
  const name = environment === undefined || text.trim() === "" ? "no environment" : environment;
  return `${FOLDER}${encodeURIComponent(name)}.scene.toml`;
}

/** Makes a project of what a permalink contains; undefined if it is none. */
export function projectOf(value: unknown): Project | undefined {
  if (!isRecord(value)) return undefined;
  const { name, program, settings, scenes } = value;
  if (typeof name !== "string" || typeof program !== "string") return undefined;
  return {
    name: /^[\p{L}\p{N}_-]{1,60}$/u.test(name) ? name : "program",
    program,
    settings: typeof settings === "string" ? settings : "",
    scenes: isRecord(scenes)
      ? Object.fromEntries(Object.entries(scenes).filter((scene): scene is [string, string] => typeof scene[1] === "string"))
      : {},
  };
}

function isRecord(value: unknown): value is Record<string, unknown> {
  return typeof value === "object" && value !== null;
}
