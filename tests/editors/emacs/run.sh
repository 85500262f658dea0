#!/usr/bin/env bash
# A session in a real Emacs: $EMACS if it is set, else emacs of the path, else that of Debian 13.
set -euo pipefail
. "$(dirname "$0")/../debian.sh"
need tmux tmux
if [ -z "${EMACS:-}" ] && ! EMACS=$(command -v emacs); then
  folder=$(unpacked trixie emacs-nox)
  EMACS="$folder/usr/bin/emacs-nox"
  # Moved elsewhere, it has to be told where its parts are.
  shared=$(echo "$folder"/usr/share/emacs/[0-9]*)
  parts=$(echo "$folder"/usr/libexec/emacs/*/*)
  export EMACSLOADPATH="$shared/lisp" EMACSDATA="$shared/etc" EMACSDOC="$shared/etc" EMACSPATH="$parts"
  export EMACS_OPTIONS="--dump-file=$(echo "$parts"/*.pdmp)"
fi
export EMACS
exec python3 "$repository/tests/editors/emacs/check.py" "$@"
