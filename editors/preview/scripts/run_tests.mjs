// Runs unit tests: bundles every *.test.ts in a folder's tests/ for Node and starts its test runner.
import { spawnSync } from "node:child_process";
import { readdirSync, rmSync } from "node:fs";
import path from "node:path";

/** Ends the process as the tests end. Arguments are options for Node's test runner. The packages and `options` of the bundle are those of the folder. */
export async function runTests(esbuild, root, options = {}) {
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
    logLevel: "warning",
    ...options,
  });
  const files = readdirSync(out, { recursive: true }).filter((file) => file.endsWith(".test.js"));
  const { status } = spawnSync(
    process.execPath,
    ["--enable-source-maps", "--test", "--test-reporter=spec", ...process.argv.slice(2), ...files.map((file) => path.join(out, file))],
    { stdio: "inherit" },
  );
  process.exit(status ?? 1);
}
