#!/usr/bin/env bash
# Tests the WebAssembly of editors/web in a browser. CHROMIUM: the browser (default: the
# system's). PYDSLREP_WEB=1: editors/web/dist is already built.
set -euo pipefail
here="$(cd "$(dirname "$0")" && pwd)"
root="$(cd "$here/../../.." && pwd)"
CHROMIUM=$("$root/tests/install/chromium.sh")
PATH=$("$root/tests/install/node.sh"):$PATH
export CHROMIUM
"$root/tests/install/npm.sh" "$root/editors/preview" "$root/editors/web" "$here"
if [ -z "${PYDSLREP_WEB:-}" ]; then CARGO_PROFILE=${CARGO_PROFILE:-dev} "$root/editors/web/build.sh"; fi
npm run --silent --prefix "$root/editors/web" check
cd "$here"
[ $# -gt 0 ] || set -- *.test.mjs
exec node --test --test-timeout=1200000 --test-reporter=spec "$@"
