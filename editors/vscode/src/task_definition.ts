// What a task in tasks.json says, and the command line that comes of it. Knows nothing of VS Code.

/** What the command `pydslrep` is to do. */
export type Action = "check" | "build" | "run";

/** A task, as the manifest's `taskDefinitions` describes it. */
export interface Definition {
  type: "pydslrep";
  action: Action;
  path?: string;
  arguments?: string[];
}

/** The arguments for `pydslrep`. */
export function argumentsOf({ action, path, arguments: more = [] }: Definition): string[] {
  // A name that begins with a dash is no option.
  const named = path === undefined ? [] : [path.startsWith("-") ? `./${path}` : path];
  return [action, ...named, ...more];
}

/** What the task is called in lists. */
export function nameOf(definition: Definition): string {
  return argumentsOf(definition).join(" ");
}
