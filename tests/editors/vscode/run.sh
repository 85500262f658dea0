#!/usr/bin/env bash
# Tests the extension in the real editor: code-server, a VS Code in the browser, in a headless Chromium.
# Builds the packages of the extension, unless VSIX and VSIX_WEB (for the web) name them; `--pictures` also renews the
# pictures of the documentation, `--then COMMAND…` runs a command instead of the tests. Installs what is missing: Chromium and
# libraries with apt (as root), Node with pip, code-server with npm.
set -euo pipefail
cd "$(dirname "$0")"
repository=$(cd ../../.. && pwd)

pictures=
if [ "${1:-}" = --pictures ]; then
  pictures=$repository/docs/images/editors
  shift
fi

step() { printf '\n== %s\n' "$*"; }

step "Browser, Node and code-server"
CHROMIUM=$(../../install/chromium.sh)
# code-server requires this version.
node=$(../../install/node.sh 24)
CODE_SERVER=$(../../install/code-server.sh "$node")
export CHROMIUM CODE_SERVER PATH=$node:$PATH

step "The extension"
if [ -z "${VSIX:-}" ]; then
  VSIX=$("$repository/editors/vscode/package.sh" ${PYDSLREP:+--command "$PYDSLREP"})
fi
if [ -z "${VSIX_WEB:-}" ]; then
  VSIX_WEB=$("$repository/editors/vscode/package.sh" --target web)
fi
../../install/npm.sh .

export VSIX VSIX_WEB PICTURES=$pictures
if [ "${1:-}" = --then ]; then
  exec "${@:2}"
fi
step "Tests"
exec node --test --test-timeout=1200000 --test-concurrency=1 --test-reporter=spec "${@:-*.test.mjs}"
