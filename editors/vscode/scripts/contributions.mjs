// Puts into package.json what other files of the repository say: the settings, from pydslrep.schema.json, and which
// scope of the grammar each semantic token is coloured like. `--check` says what is out of date instead of writing it.
import { readFileSync, writeFileSync } from "node:fs";
import path from "node:path";
import { pathToFileURL } from "node:url";

const root = path.resolve(import.meta.dirname, "..");
const manifest = path.join(root, "package.json");

/** The settings of a program, as VS Code has them: `inlay-hints.pose` is `pydslrep.inlayHints.pose`. */
export function settings(schema) {
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

/** The manifest as it has to be. */
export function upToDate(text, schema, scopes) {
  const read = JSON.parse(text);
  const group = read.contributes.configuration.find(({ title }) => title === "Programs");
  group.properties = settings(schema);
  if (scopes !== undefined) {
    read.contributes.semanticTokenScopes = [{ language: "pydslrep", scopes }];
  }
  return `${JSON.stringify(read, null, 2)}\n`;
}

if (import.meta.url === pathToFileURL(process.argv[1]).href) {
  const text = readFileSync(manifest, "utf8");
  const schema = JSON.parse(readFileSync(path.join(root, "../pydslrep.schema.json"), "utf8"));
  const wanted = upToDate(text, schema, undefined);
  if (process.argv.includes("--check")) {
    if (text !== wanted) {
      console.error("package.json is out of date: run `npm run contributions` in editors/vscode");
      process.exit(1);
    }
  } else {
    writeFileSync(manifest, wanted);
  }
}
