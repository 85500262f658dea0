// Collects the settings that the user has set. Defaults are left out: what the server receives from an editor takes
// precedence over a `pydslrep.toml`.

/** The values of a setting by scope, from `WorkspaceConfiguration.inspect`; later ones take precedence. */
export interface Inspection {
  globalValue?: unknown;
  workspaceValue?: unknown;
  workspaceFolderValue?: unknown;
}

type Table = Record<string, unknown>;

/** The value that the user has set; tables of several scopes are merged. */
export function explicitValue(inspection: Inspection | undefined): unknown {
  const values = [inspection?.globalValue, inspection?.workspaceValue, inspection?.workspaceFolderValue];
  // The settings editor leaves an empty string when a text is deleted.
  const present = values.filter((value) => value !== undefined && value !== null && value !== "");
  const tables = present.filter(isTable);
  return tables.length > 1 ? Object.assign({}, ...tables) : present.at(-1);
}

/** All settings that have a value, as nested tables: `inlayHints.pose` is in `inlayHints`. */
export function explicitSettings(keys: readonly string[], inspect: (key: string) => Inspection | undefined): Table {
  const table: Table = {};
  for (const key of keys) {
    const value = explicitValue(inspect(key));
    if (value !== undefined) {
      insert(table, key.split("."), value);
    }
  }
  return table;
}

function insert(table: Table, [first = "", ...rest]: string[], value: unknown): void {
  if (rest.length === 0) {
    table[first] = value;
    return;
  }
  const inner = isTable(table[first]) ? table[first] : {};
  table[first] = inner;
  insert(inner, rest, value);
}

function isTable(value: unknown): value is Table {
  return typeof value === "object" && value !== null && !Array.isArray(value);
}
