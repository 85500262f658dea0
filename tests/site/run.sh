#!/usr/bin/env bash
# Tests the documentation site in a browser; arguments are options and files for Node's test runner. CHROMIUM: the browser (default: the system's). LONG=1 leaves screenshots in `out`.
set -euo pipefail
cd "$(dirname "$0")"
CHROMIUM=$(../install/chromium.sh)
PATH=$(../install/node.sh):$PATH
export CHROMIUM

../install/npm.sh .
"${PYTHON:-../../.venv/bin/python}" ../../docs/site/build.py
[ $# -gt 0 ] || set -- site.test.mjs
exec node --test --test-timeout=1200000 --test-reporter=spec "$@"
