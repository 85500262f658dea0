#!/usr/bin/env bash
# Tests the extension in the real editor: code-server, a VS Code in the browser, in a headless Chromium.
# Builds the package of the extension, unless VSIX names one; `--pictures` also renews the pictures of the documentation,
# `--then COMMAND…` runs a command instead of the tests. Installs what is missing: Chromium and libraries with apt (as
# root), Node with pip, code-server with npm.
set -euo pipefail
cd "$(dirname "$0")"
repository=$(cd ../../.. && pwd)
code_server=4.139.1

pictures=
if [ "${1:-}" = --pictures ]; then
  pictures=$repository/docs/images/editors
  shift
fi

step() { printf '\n== %s\n' "$*"; }

browser() { command -v "${CHROMIUM:-chromium}" || command -v chromium-browser || command -v google-chrome || true; }

step "Browser and libraries"
# code-server has a native module that needs Kerberos.
if [ -z "$(browser)" ] || ! command -v g++ make >/dev/null || [ ! -e /usr/include/gssapi/gssapi.h ]; then
  if [ "$(id -u)" = 0 ] && command -v apt-get >/dev/null; then
    apt-get update -qq
    DEBIAN_FRONTEND=noninteractive apt-get install -y -qq --no-install-recommends \
      chromium fonts-dejavu-core build-essential python3 python3-pip libkrb5-dev >/dev/null
  else
    echo "missing: Chromium, a C++ compiler, or the headers of Kerberos (on Debian-based systems:" >&2
    echo "  apt install chromium fonts-dejavu-core build-essential python3-pip libkrb5-dev)" >&2
    exit 2
  fi
fi

step "Node and code-server"
# code-server requires this version.
node_folder=$(../../node.sh 24)
export PATH=$node_folder:$PATH
cache=${XDG_CACHE_HOME:-$HOME/.cache}/pydslrep/code-server-$code_server
if [ ! -e "$cache/node_modules/code-server/out/node/entry.js" ]; then
  echo "installing code-server $code_server in $cache (this takes a few minutes)"
  rm -rf "$cache" "$cache.part"
  mkdir -p "$cache.part"
  echo '{"private": true}' > "$cache.part/package.json"
  # Builds its native modules with the headers of this Node.
  npm_config_nodedir=$(dirname "$node_folder") npm_config_ignore_scripts=false \
    npm install --prefix "$cache.part" --no-audit --no-fund --loglevel error "code-server@$code_server"
  mv "$cache.part" "$cache"
fi

step "The extension"
if [ -z "${VSIX:-}" ]; then
  VSIX=$("$repository/editors/vscode/package.sh" ${PYDSLREP:+--command "$PYDSLREP"})
fi
npm ci --silent

export VSIX CHROMIUM="$(browser)" CODE_SERVER=$cache PICTURES=$pictures
if [ "${1:-}" = --then ]; then
  exec "${@:2}"
fi
step "Tests"
exec node --test --test-concurrency=1 --test-reporter=spec "${@:-*.test.mjs}"
