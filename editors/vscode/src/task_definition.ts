// A task of tasks.json and its command line. Does not depend on VS Code.

/** The subcommand of `pydslrep`. */
export type Action = "check" | "build" | "run";

/** A task, as described by the manifest's `taskDefinitions`. */
export interface Definition {
  type: "pydslrep";
  action: Action;
  path?: string;
  arguments?: string[];
}

/** The arguments for `pydslrep`. */
export function argumentsOf({ action, path, arguments: more = [] }: Definition): string[] {
  // A path that starts with a dash would be read as an option.
  const paths = path === undefined ? [] : [path.startsWith("-") ? `./${path}` : path];
  return [action, ...paths, ...more];
}

/** The task's name in lists. */
export function nameOf(definition: Definition): string {
  return argumentsOf(definition).join(" ");
}
