// Runs the unit tests.
import path from "node:path";

import esbuild from "esbuild";

import { runTests } from "../../preview/scripts/run_tests.mjs";

const root = path.resolve(import.meta.dirname, "..");
await runTests(esbuild, root, {
  external: ["vscode"],
  // Tests find the repository's files from here; their bundles are elsewhere.
  define: { EXTENSION_FOLDER: JSON.stringify(root) },
});
