#!/usr/bin/env bash
# Tests the path preview of editors/vscode in a browser, with paths from the language server.
# PYDSLREP_LSP: the server, next to the command (default: in target/debug). CHROMIUM: the browser (default: the system's).
# UPDATE_EXPECT=1 rewrites the pictures in docs/images/editors.
set -euo pipefail
here="$(cd "$(dirname "$0")" && pwd)"
root="$(cd "$here/../../.." && pwd)"
export CHROMIUM="${CHROMIUM:-/usr/bin/chromium}"
export PYDSLREP_LSP="${PYDSLREP_LSP:-${CARGO_TARGET_DIR:-$root/target}/debug/pydslrep-lsp}"

if [ ! -x "$CHROMIUM" ]; then
  if [ "$(id -u)" = 0 ] && command -v apt-get >/dev/null; then
    apt-get update -qq && apt-get install -y -qq --no-install-recommends chromium fonts-dejavu-core
  else
    echo "Chromium is missing: install it (on Debian-based systems: apt install chromium), or set CHROMIUM" >&2
    exit 2
  fi
fi
# The server runs the command next to it.
if [ ! -x "$PYDSLREP_LSP" ] || [ ! -x "$(dirname "$PYDSLREP_LSP")/pydslrep" ]; then
  (cd "$root" && cargo build --quiet --locked --bin pydslrep --bin pydslrep-lsp)
fi
install() { if [ ! -d "$1/node_modules" ]; then npm ci --silent --prefix "$1"; fi; }
install "$root/editors/vscode"
install "$here"
npm run --silent --prefix "$root/editors/vscode" build
exec node --test --test-reporter=spec "$here"/*.test.mjs
