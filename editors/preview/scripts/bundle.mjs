// Builds the page of the live preview, which the language server embeds: it is in the repository, so that building the
// server needs no Node. `--check` only reports whether it is up to date.
import { existsSync, readFileSync, writeFileSync } from "node:fs";
import path from "node:path";

import esbuild from "esbuild";

const root = path.resolve(import.meta.dirname, "..");
const out = path.resolve(root, "../../crates/server/src/handlers/preview");

const { outputFiles } = await esbuild.build({
  absWorkingDir: root,
  entryPoints: { page: "live/main.ts" },
  bundle: true,
  minify: true,
  write: false,
  outdir: out,
  platform: "browser",
  target: "es2022",
  format: "iife",
  logLevel: "warning",
  banner: { js: "// Built from editors/preview: `npm run bundle` there." },
});
const styles = ["style.css", "colours.css"].map((file) => readFileSync(path.join(root, "page", file), "utf8"));
const files = {
  "page.js": outputFiles[0].text,
  "page.css": styles.join("\n"),
  "page.html": readFileSync(path.join(root, "live", "page.html"), "utf8"),
};
for (const [name, content] of Object.entries(files)) {
  const file = path.join(out, name);
  if (!process.argv.includes("--check")) {
    writeFileSync(file, content);
  } else if (!existsSync(file) || readFileSync(file, "utf8") !== content) {
    console.error(`${file} is out of date: run \`npm run bundle\` in editors/preview`);
    process.exitCode = 1;
  }
}
