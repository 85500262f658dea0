#!/usr/bin/env bash
# Prints the path of Chromium, which it installs if necessary: CHROMIUM if that is set, else the one on the PATH. Chromium without
# windows is the first choice: the tests take half the processor time in it.
set -euo pipefail
source "$(dirname "$0")/lock.sh"

found() {
  local name
  if [ -n "${CHROMIUM:-}" ]; then
    command -v "$CHROMIUM"
    return
  fi
  for name in chromium-headless-shell chrome-headless-shell chromium chromium-browser google-chrome; do
    if command -v "$name"; then return; fi
  done
}
if [ -z "$(found)" ]; then
  wait_for_turn
fi
if [ -z "$(found)" ]; then
  if [ -n "${CHROMIUM:-}" ]; then
    echo "CHROMIUM names no program: $CHROMIUM" >&2
    exit 2
  fi
  "$repository/tests/install/apt.sh" chromium-headless-shell fonts-dejavu-core
fi
found
