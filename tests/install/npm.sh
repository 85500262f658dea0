#!/usr/bin/env bash
# `npm.sh FOLDER...` installs the npm packages of folders whose lock file has changed: `npm ci` removes what it finds.
set -euo pipefail
source "$(dirname "$0")/lock.sh"

PATH=$("$repository/tests/install/node.sh"):$PATH
is_current() { cmp -s "$1/package-lock.json" "$1/node_modules/package-lock.json"; }

for folder; do
  if ! is_current "$folder"; then
    wait_for_turn
    is_current "$folder" && continue
    npm ci --prefix "$folder" --loglevel error --no-audit --no-fund >&2
    cp "$folder/package-lock.json" "$folder/node_modules"
  fi
done
