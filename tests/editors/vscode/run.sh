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
# Installed once, as a user does; each window gets a copy.
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
(
  mkdir "$scratch/home" && cd "$scratch/home"
  export XDG_CONFIG_HOME=$PWD XDG_DATA_HOME=$PWD TMPDIR=$PWD
  "$node/node" "$CODE_SERVER/node_modules/code-server/out/node/entry.js" --extensions-dir "$scratch/installed" \
    --install-extension "$VSIX" >/dev/null
)

export VSIX_WEB EXTENSIONS=$scratch/installed PICTURES=$pictures
if [ "${1:-}" = --then ]; then
  "${@:2}"
else
  step "Tests"
  node --test --test-timeout=1200000 --test-concurrency=1 --test-reporter=spec "${@:-*.test.mjs}"
fi
