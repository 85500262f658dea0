// Builds dist/: the extension, the preview's page, and copies of files from elsewhere in the repository. `--watch` rebuilds
// after every change, `--production` minifies for
// the package, `--web` adds the language server as WebAssembly.
import { readFileSync, readdirSync, writeFileSync } from "node:fs";
import { copyFile, mkdir, rm } from "node:fs/promises";
import path from "node:path";

import esbuild from "esbuild";

import { forGallery } from "./addresses.mjs";

const root = path.resolve(import.meta.dirname, "..");
const repository = path.resolve(root, "../..");
const production = process.argv.includes("--production");

/** Files from elsewhere in the repository that the extension ships. */
const copies = [
  ["grammar/textmate/pydslrep.tmLanguage.json", "dist/pydslrep.tmLanguage.json"],
  ["grammar/textmate/toml.tmLanguage.json", "dist/toml.tmLanguage.json"],
  ["editors/preview/page/style.css", "dist/preview.css"],
  ["docs/images/square.svg", "dist/square.svg"],
  ["LICENSE", "LICENSE"],
];

/** The language server for VS Code for the Web, which editors/web builds. */
const server = ["worker.js", "pydslrep_bg.wasm"].map((name) => [`editors/web/dist/${name}`, `dist/${name}`]);

const common = {
  absWorkingDir: root,
  bundle: true,
  logLevel: "warning",
  minify: production,
  sourcemap: production ? false : "linked",
  metafile: true,
};
const bundles = [
  // VS Code 1.91 runs extensions in Node 20.
  {
    entryPoints: { extension: "src/extension.ts" },
    outdir: "dist",
    platform: "node",
    target: "node20",
    format: "cjs",
    external: ["vscode"],
  },
  {
    entryPoints: { web: "web/extension.ts" },
    outdir: "dist",
    platform: "browser",
    target: "es2022",
    format: "cjs",
    external: ["vscode"],
  },
  {
    entryPoints: { preview: "webview/preview.ts" },
    outdir: "dist",
    platform: "browser",
    target: "es2022",
    format: "iife",
  },
];

await rm(path.join(root, "dist"), { recursive: true, force: true });
await mkdir(path.join(root, "dist"), { recursive: true });
for (const [from, to] of process.argv.includes("--web") ? [...copies, ...server] : copies) {
  await copyFile(path.join(repository, from), path.join(root, to));
}
const inputs = new Set();
for (const bundle of bundles) {
  const options = { ...common, ...bundle };
  if (process.argv.includes("--watch")) {
    await (await esbuild.context(options)).watch();
  } else {
    const { metafile } = await esbuild.build(options);
    Object.keys(metafile.inputs).forEach((input) => inputs.add(input));
  }
}
writeFileSync(path.join(root, "dist", "LICENSES.txt"), licences(inputs));
const [readme, cargo] = [path.join(root, "README.md"), path.join(repository, "Cargo.toml")].map((file) => readFileSync(file, "utf8"));
writeFileSync(path.join(root, "dist", "README.md"), forGallery(readme, cargo));

/** The licences of the packages in a bundle. */
function licences(inputs) {
  const folders = [...inputs].map((input) => /^.*node_modules\/(?:@[^/]+\/)?[^/]+/.exec(input)?.[0]);
  return [...new Set(folders)]
    .filter((folder) => folder !== undefined)
    .sort()
    .map((folder) => {
      const licence = readdirSync(path.join(root, folder)).find((name) => /^licen[cs]e/i.test(name));
      if (licence === undefined) {
        throw new Error(`${folder} has no licence, so it cannot be bundled`);
      }
      const { name, version } = JSON.parse(readFileSync(path.join(root, folder, "package.json"), "utf8"));
      return `${name} ${version}\n\n${readFileSync(path.join(root, folder, licence), "utf8")}`;
    })
    .join("\n----\n\n");
}
