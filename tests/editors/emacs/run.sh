#!/usr/bin/env bash
# A session in a real Emacs.
set -euo pipefail
. "$(dirname "$0")/../debian.sh"
need tmux tmux
find_emacs
exec python3 "$repository/tests/editors/emacs/check.py" "$@"
