#!/usr/bin/env bash
# A session in a real Helix.
set -euo pipefail
. "$(dirname "$0")/../debian.sh"
need tmux tmux
find_helix
exec python3 "$repository/tests/editors/helix/check.py" "$@"
