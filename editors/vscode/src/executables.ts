// Finds the language server and the command: set by the user, bundled with the extension, or on the PATH. Does not depend on
// VS Code.
import * as path from "node:path";

/** A program to start. */
export interface Executable {
  command: string;
  args: string[];
  /** How it was found. */
  origin: "setting" | "bundled" | "path";
}

/** Why there is no server, as a message. */
export interface Missing {
  reason: string;
  /** Whether the setting is wrong; otherwise there is none. */
  isSettingWrong: boolean;
}

/** Where to search. */
export interface SearchPaths {
  /** The value of `pydslrep.server.path`; empty if unset. */
  setting: string;
  /** The value of `${workspaceFolder}`, which relative paths start from. */
  workspaceFolder: string | undefined;
  homeFolder: string;
  /** The extension's folder for bundled programs; packages for one platform have them. */
  bundledFolder: string;
  /** The environment's `PATH`. */
  searchPath: string;
  platform: NodeJS.Platform;
  isFile: (file: string) => boolean;
}

/** The language server: `pydslrep-lsp`, or the command `pydslrep`, which contains the server. */
export function findServer(search: SearchPaths): Executable | Missing {
  const named = search.setting.trim();
  if (named !== "") {
    const file = resolveSetting(named, search);
    return file === undefined
      ? { reason: `The setting \`pydslrep.server.path\` is \`${named}\`, but that file does not exist.`, isSettingWrong: true }
      : asServer(file, "setting", search);
  }
  const bundled = firstFile(search.bundledFolder, ["pydslrep-lsp", "pydslrep"], search);
  if (bundled !== undefined) {
    return asServer(bundled, "bundled", search);
  }
  for (const name of ["pydslrep-lsp", "pydslrep"]) {
    const found = onSearchPath(name, search);
    if (found !== undefined) {
      return asServer(found, "path", search);
    }
  }
  return {
    reason: "The PyDSLRep language server is not installed: the extension contains none, and `pydslrep-lsp` is not on the PATH.",
    isSettingWrong: false,
  };
}

/** The command `pydslrep`: next to the server, in the extension, or on the PATH. */
export function findCommand(search: SearchPaths): string | undefined {
  const server = findServer(search);
  const folders = "command" in server ? [pathModule(search).dirname(server.command)] : [];
  for (const folder of [...folders, search.bundledFolder]) {
    const found = firstFile(folder, ["pydslrep"], search);
    if (found !== undefined) {
      return found;
    }
  }
  return onSearchPath("pydslrep", search);
}

function asServer(command: string, origin: Executable["origin"], search: SearchPaths): Executable {
  const name = pathModule(search).basename(command).toLowerCase();
  const args = /^pydslrep(\.exe)?$/.test(name) ? ["lsp", "--stdio"] : ["--stdio"];
  return { command, args, origin };
}

function resolveSetting(named: string, search: SearchPaths): string | undefined {
  const paths = pathModule(search);
  if (!/[\\/]/.test(named)) {
    return onSearchPath(named, search);
  }
  const folder = search.workspaceFolder ?? search.homeFolder;
  const expanded = named.replace(/^~(?=[\\/])/, () => search.homeFolder).replaceAll("${workspaceFolder}", () => folder);
  const absolute = paths.resolve(folder, expanded);
  return firstFile(paths.dirname(absolute), [paths.basename(absolute)], search);
}

function onSearchPath(name: string, search: SearchPaths): string | undefined {
  const paths = pathModule(search);
  for (const folder of search.searchPath.split(paths.delimiter)) {
    const found = folder === "" ? undefined : firstFile(folder, [name], search);
    if (found !== undefined) {
      return found;
    }
  }
  return undefined;
}

function firstFile(folder: string, names: string[], search: SearchPaths): string | undefined {
  const endings = search.platform === "win32" ? ["", ".exe"] : [""];
  const candidates = names.flatMap((name) => endings.map((ending) => pathModule(search).join(folder, name + ending)));
  return candidates.find((file) => search.isFile(file));
}

function pathModule(search: SearchPaths): path.PlatformPath {
  return search.platform === "win32" ? path.win32 : path.posix;
}
