// Puts into package.json what other files of the repository say: the settings, from pydslrep.schema.json, like which scope of
// the grammar each semantic token is coloured, from grammar/colours.json, and where the project is, from Cargo.toml. `--check`
// says what is out of date instead of writing it.
import { readFileSync, writeFileSync } from "node:fs";
import path from "node:path";

import { addresses } from "./addresses.mjs";

const root = path.resolve(import.meta.dirname, "..");
const manifest = path.join(root, "package.json");

/** The settings of a program, as VS Code has them: `inlay-hints.pose` is `pydslrep.inlayHints.pose`. */
function settings(schema) {
  const flat = (properties, prefix) =>
    Object.entries(properties).flatMap(([key, value]) => {
      const name = prefix + key.replace(/-([a-z])/g, (_, letter) => letter.toUpperCase());
      const isTable = value.type === "object" && Object.values(value.properties).every((inner) => inner.type === "boolean");
      return isTable ? flat(value.properties, `${name}.`) : [[name, setting(value)]];
    });
  return Object.fromEntries(flat(schema.properties, "pydslrep."));
}

function setting({ description, pattern: _, properties, ...rest }) {
  const words = description.replace("the folder of this file and inside of it", "the workspace folder and inside of it");
  const inner =
    properties === undefined
      ? {}
      : { properties: Object.fromEntries(Object.entries(properties).map(([key, value]) => [key, { type: "string", ...value }])), default: {} };
  const type = rest.enum === undefined ? {} : { type: "string" };
  return { scope: "window", markdownDescription: words, ...type, ...rest, ...inner };
}

/** For each type of semantic token the scope that the grammar gives to the same words. */
function scopes(colours) {
  const types = Object.entries(colours).filter(([type]) => !type.startsWith("$"));
  return Object.fromEntries(
    types.flatMap(([type, { scope }]) => {
      // VS Code has a rule of its own for what is readonly, which would win over one without the word.
      return [type, `${type}.readonly`].map((selector) => [selector, [`${scope}.pydslrep`]]);
    }),
  );
}

/** The manifest as it has to be. */
function upToDate(text, schema, colours, cargo) {
  const { repository: _, bugs: __, ...read } = JSON.parse(text);
  Object.assign(read, addresses(cargo));
  const group = read.contributes.configuration.find(({ title }) => title === "Programs");
  group.properties = settings(schema);
  read.contributes.semanticTokenScopes = [{ language: "pydslrep", scopes: scopes(colours) }];
  return `${JSON.stringify(read, null, 2)}\n`;
}

const text = readFileSync(manifest, "utf8");
const read = (file) => JSON.parse(readFileSync(path.join(root, file), "utf8"));
const wanted = upToDate(text, read("../pydslrep.schema.json"), read("../../grammar/colours.json"), readFileSync(path.join(root, "../../Cargo.toml"), "utf8"));
if (process.argv.includes("--check")) {
  if (text !== wanted) {
    console.error("package.json is out of date: run `npm run contributions` in editors/vscode");
    process.exit(1);
  }
} else {
  writeFileSync(manifest, wanted);
}
