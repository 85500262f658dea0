// What the language server is told of the settings: only what somebody has set. Defaults are left out, since what an
// editor says counts more than a `pydslrep.toml`.

/** Where a setting has a value, as `WorkspaceConfiguration.inspect` tells; the later the more it counts. */
export interface Inspection {
  globalValue?: unknown;
  workspaceValue?: unknown;
  workspaceFolderValue?: unknown;
}

type Table = Record<string, unknown>;

/** The value that somebody has set; tables are put together from all places. */
export function setValue(inspection: Inspection | undefined): unknown {
  const values = [inspection?.globalValue, inspection?.workspaceValue, inspection?.workspaceFolderValue];
  // The settings editor leaves an empty text where somebody has deleted one.
  const said = values.filter((value) => value !== undefined && value !== null && value !== "");
  const tables = said.filter(isTable);
  return tables.length > 1 ? Object.assign({}, ...tables) : said.at(-1);
}

/** The settings that have a value, as one table of tables: `inlayHints.pose` is in `inlayHints`. */
export function setTable(keys: readonly string[], inspect: (key: string) => Inspection | undefined): Table {
  const table: Table = {};
  for (const key of keys) {
    const value = setValue(inspect(key));
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
