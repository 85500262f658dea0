// Builds dist/: the page, its bundles, the language server and the simulator as WebAssembly, and Python. `--watch` rebuilds after
// every change.
import { copyFileSync, cpSync, existsSync, mkdirSync, readdirSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import path from "node:path";

import esbuild from "esbuild";

import { wheels } from "./wheels.mjs";

const root = path.resolve(import.meta.dirname, "..");
const repository = path.resolve(root, "../..");
const dist = path.join(root, "dist");
const read = (file) => readFileSync(file, "utf8");

/** The folder that editors/web/build.sh makes: the worker of the language server, and the simulator. */
const web = process.env.PYDSLREP_WEB ?? path.join(repository, "editors/web/dist");
if (!existsSync(path.join(web, "worker.js"))) {
  console.error(`${web} is incomplete: run editors/web/build.sh first`);
  process.exit(1);
}
const wasmModule = path.join(web, "pydslrep.js");
const packages = wheels();

/** The texts of all files below a folder, by path. */
function textsIn(folder, suits) {
  const files = readdirSync(folder, { recursive: true, withFileTypes: true }).filter((entry) => entry.isFile() && suits(entry.name));
  return Object.fromEntries(
    files
      .map(({ parentPath, name }) => path.join(parentPath, name))
      .sort()
      .map((file) => [path.relative(folder, file), read(file)]),
  );
}

/** The programs in a folder, each with its settings and scenes. */
function projectsIn(folder) {
  const scenes = Object.fromEntries(
    Object.entries(textsIn(folder, (name) => name.endsWith(".scene.toml"))).map(([name, text]) => [path.basename(name, ".scene.toml"), text]),
  );
  return readdirSync(folder)
    .filter((name) => name.endsWith(".pyr"))
    .sort()
    .map((file) => {
      const program = read(path.join(folder, file));
      const own = Object.entries(scenes).filter(([name]) => new RegExp(`\\benvironment\\s+${name}\\b`).test(program));
      return { name: path.basename(file, ".pyr"), program, settings: "", scenes: Object.fromEntries(own) };
    });
}

function examples() {
  const folder = path.join(repository, "examples");
  const projects = projectsIn(folder);
  // The first is what a visitor sees.
  projects.sort((a, b) => Number(b.name === "square") - Number(a.name === "square"));
  const groups = [
    { label: "Examples", projects },
    { label: "Programs of the article", projects: projectsIn(path.join(repository, "tests/paper")) },
  ];
  const parts = textsIn(path.join(folder, "parts"), (name) => name.endsWith(".pyr"));
  const imported = Object.fromEntries(Object.entries(parts).map(([name, text]) => [`parts/${name}`, text]));
  return { groups, imported };
}

function python() {
  const isPython = (name) => name.endsWith(".py");
  const runtime = textsIn(path.join(repository, "python/pydslrep_runtime"), isPython);
  const own = textsIn(path.join(root, "src/run/python"), isPython);
  const files = { ...Object.fromEntries(Object.entries(runtime).map(([name, text]) => [`pydslrep_runtime/${name}`, text])), ...own };
  return { files, wheels: packages.names };
}

/** Modules whose values are made here. */
const made = {
  name: "made",
  setup(build) {
    const modules = { "virtual:examples": examples, "virtual:python": python };
    build.onResolve({ filter: /^virtual:/ }, ({ path: name }) => (name in modules ? { path: name, namespace: "made" } : { path: wasmModule }));
    build.onLoad({ filter: /.*/, namespace: "made" }, ({ path: name }) => ({
      contents: Object.entries(modules[name]())
        .map(([key, value]) => `export const ${key} = ${JSON.stringify(value)};`)
        .join("\n"),
    }));
  },
};

const options = {
  absWorkingDir: root,
  outdir: dist,
  bundle: true,
  format: "esm",
  platform: "browser",
  target: "es2023",
  minify: true,
  logLevel: "warning",
  metafile: true,
  plugins: [made],
  // Pyodide has these for Node.
  external: ["node:*", "fs", "path", "url", "vm", "crypto", "child_process", "ws"],
  entryPoints: { main: "src/main.ts", preview: "src/preview_page.ts", run: "src/run/worker.ts" },
};

function copy() {
  for (const name of readdirSync(path.join(root, "static"))) copyFileSync(path.join(root, "static", name), path.join(dist, name));
  const preview = path.join(repository, "editors/preview/page");
  writeFileSync(path.join(dist, "preview.css"), read(path.join(preview, "style.css")) + read(path.join(preview, "colours.css")));
  copyFileSync(path.join(repository, "docs/site/theme/favicon.svg"), path.join(dist, "favicon.svg"));
  copyFileSync(path.join(web, "worker.js"), path.join(dist, "server.js"));
  copyFileSync(path.join(web, "pydslrep_bg.wasm"), path.join(dist, "pydslrep.wasm"));
  const pyodide = path.join(root, "node_modules/pyodide");
  for (const name of ["pyodide.asm.mjs", "pyodide.asm.wasm", "python_stdlib.zip", "pyodide-lock.json"]) {
    cpSync(path.join(pyodide, name), path.join(dist, "pyodide", name));
  }
  for (const name of packages.names) copyFileSync(path.join(packages.folder, name), path.join(dist, "pyodide", name));
}

/** The licences of the npm packages in the bundles and of the Python packages. */
function licences(inputs) {
  const folders = [...inputs, "node_modules/pyodide/"].map((input) => /^.*node_modules\/(?:@[^/]+\/)?[^/]+/.exec(input)?.[0]);
  const ofBundles = [...new Set(folders)]
    .filter((folder) => folder !== undefined)
    .sort()
    .map((folder) => {
      const manifest = JSON.parse(read(path.join(root, folder, "package.json")));
      const file = readdirSync(path.join(root, folder)).find((name) => /^licen[cs]e/i.test(name));
      const text = file === undefined ? `Licence: ${manifest.license}; ${manifest.homepage ?? ""}\n` : read(path.join(root, folder, file));
      return `${manifest.name} ${manifest.version}\n\n${text}`;
    });
  const ofWheels = packages.names.map((wheel) => {
    const [name, version] = wheel.split("-");
    const texts = textsIn(path.join(packages.folder, path.parse(wheel).name, `${name}-${version}.dist-info/licenses`), () => true);
    return `${name} ${version}\n\n${Object.values(texts).join("\n")}`;
  });
  return [...ofBundles, ...ofWheels].join("\n----\n\n");
}

rmSync(dist, { recursive: true, force: true });
mkdirSync(dist, { recursive: true });
copy();
if (process.argv.includes("--watch")) {
  await (await esbuild.context(options)).watch();
} else {
  const { metafile } = await esbuild.build(options);
  writeFileSync(path.join(dist, "LICENSES.txt"), licences(Object.keys(metafile.inputs)));
}
