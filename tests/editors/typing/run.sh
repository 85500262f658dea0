#!/usr/bin/env bash
# Types programs key by key into real editors: `run.sh typing [--editor NAME]... [OPTIONS]`, see README.md. The default
# editors are VS Code, Neovim and the playground.
set -euo pipefail
typing=$(cd "$(dirname "$0")" && pwd)
. "$typing/../debian.sh"

editors=() options=()
while [ $# -gt 0 ]; do
  case $1 in
    --editor) editors+=("${2:?--editor needs a name}"); shift 2 ;;
    *) options+=("$1"); shift ;;
  esac
done
[ ${#editors[@]} -gt 0 ] || editors=(vscode neovim playground)

# The generator of programs is not part of the product.
if [ -z "${PYDSLREP:-}" ] || [ -z "${PYDSLREP_LSP:-}" ] || [ -z "${RANDOM_PROGRAMS:-}" ]; then
  (cd "$repository" && cargo build --quiet --locked --bin random-programs --bin pydslrep --bin pydslrep-lsp)
fi
built=$(realpath "${CARGO_TARGET_DIR:-$repository/target}/debug")
export PYDSLREP=${PYDSLREP:-$built/pydslrep} PYDSLREP_LSP=${PYDSLREP_LSP:-$built/pydslrep-lsp}
export RANDOM_PROGRAMS=${RANDOM_PROGRAMS:-$built/random-programs}

type_into() { # editor
  local editor=$1 package
  local record=(python3 "$typing/record.py" --editor "$editor" "${options[@]}")
  case $editor in
    vscode* | playground) record=("$repository/tests/editors/${editor%%-*}/run.sh" --then "${record[@]}") ;;
    *) need tmux tmux ;;
  esac
  case $editor in
    neovim*)
      # In Neovim's terminal the variable contains the socket of that Neovim.
      [ -S "${NVIM:-}" ] && NVIM=
      export NVIM=${NVIM:-$(unpacked forky neovim)/usr/bin/nvim}
      ;;
    helix) find_helix ;;
    kakoune) find_kakoune ;;
    emacs-*)
      find_emacs
      # The package for terminals depends on corfu itself.
      case $editor in *corfu) package=elpa-corfu-terminal ;; *) package=elpa-company ;; esac
      ELPA=$(unpacked trixie $package)/usr/share/emacs/site-lisp/elpa-src
      export ELPA
      ;;
  esac
  "${record[@]}"
}

# In parallel: most of the time they wait for the next key.
running=()
for editor in "${editors[@]}"; do
  type_into "$editor" 2>&1 | sed -u "s/^/$editor: /" &
  running+=($!)
done
failed=0
for job in "${running[@]}"; do wait "$job" || failed=1; done
exit $failed
