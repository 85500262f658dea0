#!/usr/bin/env bash
# A session in a real Kakoune: $KAK if it is set, else kak of the path, else that of Debian 13. What is no Debian package,
# kak-lsp, is built by cargo unless $KAK_LSP or the path has it; that takes minutes.
set -euo pipefail
. "$(dirname "$0")/../debian.sh"
need tmux tmux
if [ -z "${KAK:-}" ] && ! KAK=$(command -v kak); then
  folder=$(unpacked trixie kakoune)
  export KAK="$folder/usr/bin/kak" KAKOUNE_RUNTIME="$folder/usr/share/kak"
fi
if [ -z "${KAK_LSP:-}" ] && ! KAK_LSP=$(command -v kak-lsp); then
  KAK_LSP="$repository/target/editors/kak-lsp/bin/kak-lsp"
  [ -x "$KAK_LSP" ] || cargo install --quiet --locked --root "$repository/target/editors/kak-lsp" kak-lsp@22.0.0
fi
export KAK KAK_LSP
exec python3 "$repository/tests/editors/kakoune/check.py" "$@"
