// Where the language server is: named by a setting, beside the extension, or on the path. Knows nothing of VS Code.
import * as path from "node:path";

/** A program that can be started. */
export interface Program {
  command: string;
  args: string[];
  /** How it was found. */
  origin: "setting" | "bundled" | "path";
}

/** Why there is no program, in words for the person. */
export interface Missing {
  reason: string;
  /** The setting that is wrong, rather than none given. */
  setting: boolean;
}

/** Where to look. */
export interface Places {
  /** What `pydslrep.server.path` says; empty for nothing. */
  setting: string;
  /** The folder that `${workspaceFolder}` and relative paths are about. */
  workspaceFolder: string | undefined;
  homeFolder: string;
  /** The folder in the extension where a package for one platform has its programs. */
  bundledFolder: string;
  /** The environment's `PATH`. */
  searchPath: string;
  platform: NodeJS.Platform;
  isFile: (file: string) => boolean;
}

/** The language server: a program of its own, or the command `pydslrep`, which also serves. */
export function findServer(places: Places): Program | Missing {
  const named = places.setting.trim();
  if (named !== "") {
    const file = resolveSetting(named, places);
    return file === undefined
      ? { reason: `The setting \`pydslrep.server.path\` is \`${named}\`, but that file does not exist.`, setting: true }
      : serving(file, "setting", places);
  }
  const bundled = firstFile(places.bundledFolder, ["pydslrep-lsp", "pydslrep"], places);
  if (bundled !== undefined) {
    return serving(bundled, "bundled", places);
  }
  for (const name of ["pydslrep-lsp", "pydslrep"]) {
    const found = onSearchPath(name, places);
    if (found !== undefined) {
      return serving(found, "path", places);
    }
  }
  return { reason: "The language server of PyDSLRep is not installed: this package of the extension has none inside, and there is no `pydslrep-lsp` on the PATH.", setting: false };
}

/** The command `pydslrep`, for tasks: beside the server, in the extension, or on the path. */
export function findCommand(places: Places): string | undefined {
  const server = findServer(places);
  const folders = "command" in server ? [pathsOf(places).dirname(server.command)] : [];
  for (const folder of [...folders, places.bundledFolder]) {
    const found = firstFile(folder, ["pydslrep"], places);
    if (found !== undefined) {
      return found;
    }
  }
  return onSearchPath("pydslrep", places);
}

function serving(command: string, origin: Program["origin"], places: Places): Program {
  const name = pathsOf(places).basename(command).toLowerCase();
  const args = /^pydslrep(\.exe)?$/.test(name) ? ["lsp", "--stdio"] : ["--stdio"];
  return { command, args, origin };
}

function resolveSetting(named: string, places: Places): string | undefined {
  const paths = pathsOf(places);
  if (!/[\\/]/.test(named)) {
    return onSearchPath(named, places);
  }
  const folder = places.workspaceFolder ?? places.homeFolder;
  const expanded = named.replace(/^~(?=[\\/])/, () => places.homeFolder).replaceAll("${workspaceFolder}", () => folder);
  const absolute = paths.resolve(folder, expanded);
  return firstFile(paths.dirname(absolute), [paths.basename(absolute)], places);
}

function onSearchPath(name: string, places: Places): string | undefined {
  const paths = pathsOf(places);
  for (const folder of places.searchPath.split(paths.delimiter)) {
    const found = folder === "" ? undefined : firstFile(folder, [name], places);
    if (found !== undefined) {
      return found;
    }
  }
  return undefined;
}

function firstFile(folder: string, names: string[], places: Places): string | undefined {
  const endings = places.platform === "win32" ? ["", ".exe"] : [""];
  const candidates = names.flatMap((name) => endings.map((ending) => pathsOf(places).join(folder, name + ending)));
  return candidates.find((file) => places.isFile(file));
}

function pathsOf(places: Places): path.PlatformPath {
  return places.platform === "win32" ? path.win32 : path.posix;
}
