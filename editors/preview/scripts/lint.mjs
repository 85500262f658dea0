// Runs ESLint in the current folder. It remembers which files have no problem, for as long as no file of any editor changes:
// its rules look at the types of other files, which its own cache does not notice.
import { spawnSync } from "node:child_process";
import { createHash } from "node:crypto";
import { existsSync, readFileSync, readdirSync, rmSync } from "node:fs";
import path from "node:path";

const editors = path.resolve(import.meta.dirname, "..", "..");
const BUILT = new Set(["node_modules", "dist", "server"]);

/** The files below a folder that are source code or settings. */
function* sources(folder) {
  const entries = readdirSync(folder, { withFileTypes: true }).sort((a, b) => (a.name < b.name ? -1 : 1));
  for (const entry of entries) {
    const file = path.join(folder, entry.name);
    if (entry.isDirectory()) {
      if (!BUILT.has(entry.name)) yield* sources(file);
    } else if (/\.(ts|mjs|json)$/.test(entry.name)) {
      yield file;
    }
  }
}

const digest = createHash("sha256");
for (const file of sources(editors)) {
  digest.update(`${file}\0`).update(readFileSync(file)).update("\0");
}
const caches = path.resolve("node_modules", ".cache", "eslint");
const cache = path.join(caches, digest.digest("hex"));
const eslint = path.resolve("node_modules", "eslint", "bin", "eslint.js");
const options = ["--cache", "--cache-strategy", "content", "--cache-location", `${cache}/`];

const kept = existsSync(caches) ? readdirSync(caches) : [];
for (const old of kept.map((name) => path.join(caches, name)).filter((folder) => folder !== cache)) {
  rmSync(old, { recursive: true });
}
const { status } = spawnSync(process.execPath, [eslint, ".", ...options, ...process.argv.slice(2)], { stdio: "inherit" });
process.exit(status ?? 1);
