#!/usr/bin/env bash
# Prints the folder of code-server, which it installs in $XDG_CACHE_HOME/pydslrep on first use. Takes the folder of the Node
# that code-server requires.
set -euo pipefail
source "$(dirname "$0")/lock.sh"
version=4.139.1
node=${1:?the folder of Node is missing}

cache=${XDG_CACHE_HOME:-$HOME/.cache}/pydslrep/code-server-$version
is_there() { [ -e "$cache/node_modules/code-server/out/node/entry.js" ]; }

is_there || wait_for_turn
if ! is_there; then
  # Its native modules need a compiler and Kerberos.
  if ! command -v g++ make >/dev/null || [ ! -e /usr/include/gssapi/gssapi.h ]; then
    "$repository/tests/install/apt.sh" build-essential python3 python3-pip libkrb5-dev
  fi
  echo "installing code-server $version in $cache (this takes a few minutes)" >&2
  rm -rf "$cache" "$cache.part"
  mkdir -p "$cache.part"
  echo '{"private": true}' > "$cache.part/package.json"
  # Builds its native modules with the headers of this Node, and without optimising them, which would take as long as all the rest.
  CFLAGS=-O0 CXXFLAGS=-O0 PATH=$node:$PATH npm_config_nodedir=$(dirname "$node") npm_config_ignore_scripts=false \
    npm install --prefix "$cache.part" --no-audit --no-fund --loglevel error "code-server@$version" >&2
  mv "$cache.part" "$cache"
fi
echo "$cache"
