#!/usr/bin/env bash
# A session in a real Neovim, set up as editors/README.md says: once for each of its two ways.
# $NVIM, $PYDSLREP_LSP and $PYDSLREP name the programs to use; what is not set is taken from the path.
set -euo pipefail
repository=$(cd "$(dirname "$0")/../../.." && pwd)

program() { # the program's file, absolute: the session starts it from another folder
  command -v "$1" | xargs -r realpath || { echo "$1 is missing: $2" >&2; exit 2; }
}
# Inside Neovim's own terminal the variable holds the socket of that Neovim.
[ -S "${NVIM:-}" ] && NVIM=
nvim=$(program "${NVIM:-nvim}" "install Neovim 0.11 or later, or say where it is in NVIM")
server=$(program "${PYDSLREP_LSP:-pydslrep-lsp}" "cargo install --locked --path crates/server, or say where it is in PYDSLREP_LSP")
command=$(program "${PYDSLREP:-pydslrep}" "cargo install --locked --path crates/cli, or say where it is in PYDSLREP")
unset NVIM

scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
mkdir "$scratch/bin"
ln -s "$server" "$scratch/bin/pydslrep-lsp"
ln -s "$command" "$scratch/bin/pydslrep"
export PATH="$scratch/bin:$PATH"
export PROGRAM="$repository/tests/paper/table2_two_wheels.pyr"

lua_block() { # the n-th Lua block of the readme, with the real folder in it
  awk -v wanted="$1" '/^```/ { inside = $0 == "```lua" && ++block == wanted; next } inside' "$repository/editors/README.md" |
    sed "s|/path/to/pydslrep|$repository|"
}

alive() { # a dead process that nobody has waited for yet does not count
  case $(ps -o stat= -p "$1" || true) in "" | Z*) return 1 ;; esac
}

session() { # name, n-th block
  echo "== $1"
  local home="$scratch/$1" failed=0
  mkdir -p "$home/config/nvim" "$home/work"
  lua_block "$2" > "$home/config/nvim/init.lua"
  grep -q "lsp.enable" "$home/config/nvim/init.lua" || { echo "the readme has no Lua block $2" >&2; return 1; }
  (
    cd "$home/work"
    export XDG_CONFIG_HOME="$home/config" XDG_DATA_HOME="$home/data" XDG_STATE_HOME="$home/state" XDG_CACHE_HOME="$home/cache"
    timeout 120 "$nvim" --headless -S "$repository/editors/neovim/tests/session.lua" 2> "$home/messages"
  ) || failed=1
  local server_id
  server_id=$(cat "$home/server.pid" 2>/dev/null || true)
  if [ -n "$server_id" ] && ! alive "$server_id"; then
    echo "ok   the server is gone when Neovim is"
  else
    echo "FAIL the server is gone when Neovim is"
    failed=1
  fi
  [ $failed = 0 ] || cat "$home/messages" "$home/state/nvim/lsp.log" 2>/dev/null || true
  return $failed
}

failed=0
session folder 1 || failed=1
session pasted 2 || failed=1
exit $failed
