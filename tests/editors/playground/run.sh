#!/usr/bin/env bash
# Tests the playground in a browser. PYDSLREP: the command (default: in target/debug). PYTHON: has the packages that
# `pydslrep run` needs (default: in .venv). CHROMIUM: the browser (default: the system's). PYDSLREP_PLAYGROUND: the playground
# (default: builds editors/playground/dist).
# LONG=1 also runs the programs that take long. UPDATE_EXPECT=1 rewrites the pictures in docs/images/playground.
# `--then COMMAND…` runs a command instead of the tests.
set -euo pipefail
here="$(cd "$(dirname "$0")" && pwd)"
root="$(cd "$here/../../.." && pwd)"
CHROMIUM=$("$root/tests/install/chromium.sh")
PATH=$("$root/tests/install/node.sh"):$PATH
export CHROMIUM
export PYDSLREP="${PYDSLREP:-${CARGO_TARGET_DIR:-$root/target}/debug/pydslrep}"
export PYTHON="${PYTHON:-$root/.venv/bin/python}"

if [ ! -x "$PYDSLREP" ]; then (cd "$root" && cargo build --quiet --locked --bin pydslrep); fi
"$root/tests/install/npm.sh" "$root/editors/playground" "$here"
# One that is built already: another test may be using it.
if [ -z "${PYDSLREP_PLAYGROUND:-}" ]; then
  if [ -z "${PYDSLREP_WEB:-}" ]; then CARGO_PROFILE=${CARGO_PROFILE:-dev} "$root/editors/web/build.sh"; fi
  npm run --silent --prefix "$root/editors/playground" build
fi
cd "$here"
if [ "${1:-}" = --then ]; then exec "${@:2}"; fi
npm run --silent --prefix "$root/editors/playground" check
[ $# -gt 0 ] || set -- *.test.mjs
exec node --test --test-timeout=1200000 --test-reporter=spec --test-concurrency=1 "$@"
