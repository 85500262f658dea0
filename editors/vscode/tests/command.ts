// The command `pydslrep` that the tests compare with.
import assert from "node:assert/strict";
import { existsSync } from "node:fs";
import path from "node:path";

const repository = path.resolve(EXTENSION_FOLDER, "../..");

/** The command `pydslrep`: `$PYDSLREP`, else the one that was built last. */
export function command(): string {
  const target = process.env.CARGO_TARGET_DIR ?? path.join(repository, "target");
  const candidates = [process.env.PYDSLREP, `${target}/debug/pydslrep`, `${target}/release/pydslrep`];
  const found = candidates.find((file) => file !== undefined && existsSync(file));
  assert.ok(found, "build the command first: cargo build --bin pydslrep, or say where it is in PYDSLREP");
  return found;
}
