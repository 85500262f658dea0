#!/usr/bin/env bash
# A session in a real Kakoune.
set -euo pipefail
. "$(dirname "$0")/../debian.sh"
need tmux tmux
find_kakoune
exec python3 "$repository/tests/editors/kakoune/check.py" "$@"
