// Runs the unit tests: bundles every *.test.ts in tests/ for Node and starts its test runner.
import { spawnSync } from "node:child_process";
import { readdirSync, rmSync } from "node:fs";
import path from "node:path";

import esbuild from "esbuild";

const root = path.resolve(import.meta.dirname, "..");
const out = path.join(root, "dist", "tests");

const entryPoints = readdirSync(path.join(root, "tests"), { recursive: true })
  .filter((file) => file.endsWith(".test.ts"))
  .map((file) => path.join("tests", file));
rmSync(out, { recursive: true, force: true });
await esbuild.build({
  absWorkingDir: root,
  entryPoints,
  outdir: out,
  outbase: ".",
  bundle: true,
  platform: "node",
  target: "node20",
  format: "cjs",
  sourcemap: "inline",
  external: ["vscode"],
  logLevel: "warning",
  // Tests find the repository's files from here; their bundles are elsewhere.
  define: { EXTENSION_FOLDER: JSON.stringify(root) },
});
const files = readdirSync(out, { recursive: true }).filter((file) => file.endsWith(".test.js"));
const { status } = spawnSync(
  process.execPath,
  ["--enable-source-maps", "--test", "--test-reporter=spec", ...files.map((file) => path.join(out, file))],
  { stdio: "inherit" },
);
process.exit(status ?? 1);
