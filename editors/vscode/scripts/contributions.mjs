// Generates parts of package.json: the settings from pydslrep.schema.json, the grammar scope of each semantic token from
// grammar/colours.json, and the project's URLs from Cargo.toml. `--check` only reports whether it is up to date.
import { readFileSync, writeFileSync } from "node:fs";
import path from "node:path";

import { addresses } from "./addresses.mjs";

const root = path.resolve(import.meta.dirname, "..");
const manifest = path.join(root, "package.json");

/** The settings under their names in VS Code: `inlay-hints.pose` is `pydslrep.inlayHints.pose`. */
function settings(schema) {
  const flat = (properties, prefix) =>
    Object.entries(properties).flatMap(([key, value]) => {
      const name = prefix + key.replace(/-([a-z])/g, (_, letter) => letter.toUpperCase());
      const isTable = value.type === "object" && Object.values(value.properties).every((inner) => inner.type !== undefined);
      return isTable ? flat(value.properties, `${name}.`) : [[name, setting(value)]];
    });
  return Object.fromEntries(flat(schema.properties, "pydslrep."));
}

function setting({ description, pattern: _, properties, ...rest }) {
  const markdownDescription = description.replace("the folder of this file", "the workspace folder");
  const inner =
    properties === undefined
      ? {}
      : { properties: Object.fromEntries(Object.entries(properties).map(([key, value]) => [key, { type: "string", ...value }])), default: {} };
  const type = rest.enum === undefined ? {} : { type: "string" };
  return { scope: "window", markdownDescription, ...type, ...rest, ...inner };
}

/** The grammar scope of each type of semantic token. */
function scopes(colours) {
  const types = Object.entries(colours).filter(([type]) => !type.startsWith("$"));
  return Object.fromEntries(
    types.flatMap(([type, { scope }]) => {
      // VS Code's own rule for `readonly` would take precedence over a rule without it.
      return [type, `${type}.readonly`].map((selector) => [selector, [`${scope}.pydslrep`]]);
    }),
  );
}

/** The manifest with its generated parts. */
function generate(text, schema, colours, cargo) {
  const { repository: _, bugs: __, ...read } = JSON.parse(text);
  Object.assign(read, addresses(cargo));
  const group = read.contributes.configuration.find(({ title }) => title === "Programs");
  group.properties = settings(schema);
  read.contributes.semanticTokenScopes = [{ language: "pydslrep", scopes: scopes(colours) }];
  return `${JSON.stringify(read, null, 2)}\n`;
}

const text = readFileSync(manifest, "utf8");
const read = (file) => JSON.parse(readFileSync(path.join(root, file), "utf8"));
const generated = generate(text, read("../pydslrep.schema.json"), read("../../grammar/colours.json"), readFileSync(path.join(root, "../../Cargo.toml"), "utf8"));
if (process.argv.includes("--check")) {
  if (text !== generated) {
    console.error("package.json is out of date: run `npm run contributions` in editors/vscode");
    process.exit(1);
  }
} else {
  writeFileSync(manifest, generated);
}
