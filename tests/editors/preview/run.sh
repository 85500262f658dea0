#!/usr/bin/env bash
# Tests the path preview in a browser, with paths from the language server: as in VS Code, and as the server serves it.
# PYDSLREP_LSP: the server, next to the command (default: in target/debug). CHROMIUM: the browser (default: the system's).
# UPDATE_EXPECT=1 rewrites the pictures in docs/images/editors.
set -euo pipefail
here="$(cd "$(dirname "$0")" && pwd)"
root="$(cd "$here/../../.." && pwd)"
CHROMIUM=$("$root/tests/install/chromium.sh")
PATH=$("$root/tests/install/node.sh"):$PATH
export CHROMIUM
export PYDSLREP_LSP="${PYDSLREP_LSP:-${CARGO_TARGET_DIR:-$root/target}/debug/pydslrep-lsp}"

# The server runs the command next to it.
if [ ! -x "$PYDSLREP_LSP" ] || [ ! -x "$(dirname "$PYDSLREP_LSP")/pydslrep" ]; then
  (cd "$root" && cargo build --quiet --locked --bin pydslrep --bin pydslrep-lsp)
fi
"$root/tests/install/npm.sh" "$root/editors/vscode" "$here"
cd "$here"
[ $# -gt 0 ] || set -- *.test.mjs
exec node --test --test-timeout=1200000 --test-reporter=spec "$@"
