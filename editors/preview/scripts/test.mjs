// Runs the unit tests.
import path from "node:path";

import esbuild from "esbuild";

import { runTests } from "./run_tests.mjs";

await runTests(esbuild, path.resolve(import.meta.dirname, ".."));
