// Finds the command `pydslrep` for tests.
import assert from "node:assert/strict";
import { existsSync } from "node:fs";
import path from "node:path";

const repository = path.resolve(EXTENSION_FOLDER, "../..");

/** `$PYDSLREP`, or else the command in the target folder. */
export function command(): string {
  const target = process.env.CARGO_TARGET_DIR ?? path.join(repository, "target");
  const candidates = [process.env.PYDSLREP, `${target}/debug/pydslrep`, `${target}/release/pydslrep`];
  const found = candidates.find((file) => file !== undefined && existsSync(file));
  assert.ok(found, "build the command first (cargo build --bin pydslrep), or set PYDSLREP");
  return found;
}
