#!/usr/bin/env bash
# Builds dist/: the language server and the simulator as WebAssembly (pydslrep_bg.wasm), the JavaScript module around it
# (pydslrep.js), and the worker of the language server (worker.js). Prints what a browser loads, compressed.
# CARGO_PROFILE: the profile (default: wasm, for publishing). `dev` is for tests: larger and slower, but compiled in a fraction of
# the time, with the macros and build scripts of other builds in the same target directory.
set -euo pipefail
here=$(cd "$(dirname "$0")" && pwd)
root=$(cd "$here/../.." && pwd)
target=$(mkdir -p "${CARGO_TARGET_DIR:-$root/target}" && cd "${CARGO_TARGET_DIR:-$root/target}" && pwd)
profile=${CARGO_PROFILE:-wasm}
folder=${profile/#dev/debug}

cd "$root"
cargo build --quiet --locked --package pydslrep-browser --target wasm32-unknown-unknown --profile "$profile"
cargo build --quiet --locked --manifest-path "$here/bindgen/Cargo.toml" --target-dir "$target"
compiled=$target/wasm32-unknown-unknown/$folder/pydslrep_browser.wasm bindgen=$target/debug/pydslrep-bindgen
# The hashes of what the module was made from, and of what was made: it takes ten seconds, and most runs would make it again.
made=$target/web-module.sha256
if ! grep -qF "$compiled" "$made" 2>/dev/null || ! sha256sum --check --status "$made" 2>/dev/null; then
  rm -rf "$here/dist" "$made"
  "$bindgen" "$compiled" "$here/dist"
  # Where there is no such command, it is made every time.
  sha256sum "$compiled" "$bindgen" "$here"/dist/* >"$made" 2>/dev/null || rm -f "$made"
fi

"$root/tests/install/npm.sh" "$here"
PATH=$("$root/tests/install/node.sh"):$PATH
"$here/node_modules/.bin/esbuild" "$here/src/worker.ts" --bundle --minify --format=iife --platform=browser --target=es2022 \
  --log-level=warning --outfile="$here/dist/worker.js"

for file in pydslrep_bg.wasm worker.js; do
  printf '%s: %d kB, %d kB with gzip\n' "$file" \
    $(($(wc -c <"$here/dist/$file") / 1000)) $(($(gzip -9 -c "$here/dist/$file" | wc -c) / 1000))
done
