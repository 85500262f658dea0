#!/usr/bin/env bash
# Makes .venv, with what the Python checks and tests need, unless its requirements are those of tests/requirements.txt.
set -euo pipefail
source "$(dirname "$0")/lock.sh"
cd "$repository"

if ! cmp -s tests/requirements.txt .venv/requirements.txt; then
  wait_for_turn
  # `venv` needs ensurepip, which is a separate package in Debian.
  python3 -c 'import ensurepip' 2>/dev/null || tests/install/apt.sh python3-venv
  rm -rf .venv
  python3 -m venv .venv
  # Without compiling: most modules are never imported.
  .venv/bin/pip install --quiet --no-compile --disable-pip-version-check --require-hashes --requirement tests/requirements.txt
  cp tests/requirements.txt .venv
fi
