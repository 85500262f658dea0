#!/usr/bin/env bash
# `apt.sh PACKAGE...` installs Debian packages, or says which are missing where it cannot.
set -euo pipefail
source "$(dirname "$0")/lock.sh"

wait_for_turn
if [ "$(id -u)" = 0 ] && command -v apt-get >/dev/null; then
  apt-get update -qq -o Acquire::Retries=5 >&2
  DEBIAN_FRONTEND=noninteractive apt-get install -y -qq -o Acquire::Retries=5 --no-install-recommends "$@" >/dev/null
else
  echo "missing: install it and run this again (on Debian and Ubuntu: apt install $*)" >&2
  exit 2
fi
