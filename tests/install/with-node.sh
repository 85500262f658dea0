#!/usr/bin/env bash
# `with-node.sh COMMAND...` runs a command with the Node of node.sh on the PATH.
set -euo pipefail
PATH=$("$(dirname "$0")/node.sh"):$PATH
exec "$@"
