#!/usr/bin/env bash
# Tests the documentation site in a browser. CHROMIUM: the browser (default: the system's). Leaves screenshots in `out`.
set -euo pipefail
cd "$(dirname "$0")"
CHROMIUM=$(../install/chromium.sh)
PATH=$(../install/node.sh):$PATH
export CHROMIUM

../install/npm.sh .
"${PYTHON:-../../.venv/bin/python}" ../../docs/site/build.py
exec node --test --test-reporter=spec site.test.mjs
