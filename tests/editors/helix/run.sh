#!/usr/bin/env bash
# A session in a real Helix: $HX if it is set, else hx of the path, else that of Debian 13.
set -euo pipefail
. "$(dirname "$0")/../debian.sh"
need tmux tmux
if [ -z "${HX:-}" ] && ! HX=$(command -v hx); then
  folder=$(unpacked trixie hx)
  export HX="$folder/usr/bin/hx" HELIX_RUNTIME="$folder/usr/lib/hx/runtime"
fi
export HX
exec python3 "$repository/tests/editors/helix/check.py" "$@"
