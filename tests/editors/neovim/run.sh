#!/usr/bin/env bash
# Tests the plugin in real Neovims, set up as editors/neovim/README.md says. On Debian-based systems the editors are unpacked
# into target/editors; elsewhere $NVIM names the Neovim (0.11 or later), and there is no lint.
# $PYDSLREP_LSP and $PYDSLREP name the programs, which are built by default. Arguments select sessions; `pictures` takes the
# screenshots of the documentation.
set -euo pipefail
tests=$(cd "$(dirname "$0")" && pwd)
source "$tests/../debian.sh"
plugin="$repository/editors/neovim"
cache="$repository/target/editors"

# In Neovim's terminal the variable contains the socket of that Neovim.
[ -S "${NVIM:-}" ] && NVIM=
current=${NVIM:-} older='' lints=''
if [ -z "$current" ] && command -v apt-get > /dev/null; then
  # Debian stable has the oldest supported Neovim, Debian testing the newest.
  older=$(unpacked trixie neovim)/usr/bin/nvim
  current=$(unpacked forky neovim)/usr/bin/nvim
  lints=$(unpacked trixie lua-check)/usr
fi
current=$(command -v "${current:-nvim}") || { echo "Neovim was not found: install it, or set NVIM" >&2; exit 2; }
unset NVIM

if [ -z "${PYDSLREP:-}" ] || [ -z "${PYDSLREP_LSP:-}" ]; then
  cargo build --quiet --locked --manifest-path "$repository/Cargo.toml" --bin pydslrep --bin pydslrep-lsp
  built=${CARGO_TARGET_DIR:-$repository/target}/debug
fi
server=$(realpath -e "${PYDSLREP_LSP:-$built/pydslrep-lsp}")
command=$(realpath -e "${PYDSLREP:-$built/pydslrep}")

scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
mkdir "$scratch/bin"
ln -s "$server" "$scratch/bin/pydslrep-lsp"
ln -s "$command" "$scratch/bin/pydslrep"
export PATH="$scratch/bin:$PATH" TESTS="$tests" REPOSITORY="$repository"
export PROGRAM="$repository/tests/paper/table2_two_wheels.pyr"

lua_block() { # call, address; prints the readme's first block of Lua with this call, with the address (default: this folder)
  awk -v call="$1" '
    /^```/ { if (inside && index(block, call)) { printf "%s", block; exit } inside = $0 == "```lua"; block = ""; next }
    inside { block = block $0 "\n" }
  ' "$plugin/README.md" | sed "s|/path/to/pydslrep|${2:-$repository}|"
}

gone() { # process; waits until it has ended, zombies do not count
  for _ in {1..600}; do
    case $(ps -o stat= -p "$1" || true) in "" | Z*) return 0 ;; esac
    sleep 0.1
  done
  return 1
}

session() { # name, Neovim, file; reads init.lua from standard input
  echo "== $1"
  local home="$scratch/$1" failed=0
  mkdir -p "$home/config/nvim" "$home/work"
  cat > "$home/config/nvim/init.lua"
  if [ "$1" = package ]; then
    # As plugin managers do.
    mkdir -p "$home/data/nvim/site/pack/person/start"
    ln -s "$plugin" "$home/data/nvim/site/pack/person/start/pydslrep"
  fi
  (
    cd "$home/work"
    export XDG_CONFIG_HOME="$home/config" XDG_DATA_HOME="$home/data" XDG_STATE_HOME="$home/state"
    # Keeps what the first run installs.
    export XDG_CACHE_HOME="$cache/cache"
    timeout 600 "$2" --headless -S "$tests/$3" 2> "$home/messages"
  ) || failed=1
  local server_id
  server_id=$(cat "$home/server.pid" 2>/dev/null || true)
  if [ -n "$server_id" ] && gone "$server_id"; then
    echo "ok   the server exits with Neovim"
  else
    echo "FAIL the server exits with Neovim"
    failed=1
  fi
  [ $failed = 0 ] || cat "$home/messages" "$home/state/nvim/lsp.log" 2>/dev/null || true
  return $failed
}

lint() {
  echo "== lint"
  (
    cd "$repository"
    export PATH="$lints/bin:$PATH" LUA_PATH="$lints/share/lua/5.1/?.lua;$lints/share/lua/5.1/?/init.lua"
    LUA_CPATH=$(echo "$lints"/lib/*/lua/5.1)/?.so luacheck --quiet --config "$tests/luacheckrc" "$plugin" "$tests" \
      "$tests/../typing/neovim"
  )
}

failed=0
for name in ${*:-lint folder pasted package cloned colours older}; do
  case $name in
    lint) [ -z "$lints" ] || lint ;;
    folder) lua_block vim.opt.runtimepath:append | session folder "$current" session.lua ;;
    pasted) lua_block vim.lsp.config | session pasted "$current" session.lua ;;
    package) session package "$current" package.lua < "$tests/init.lua" ;;
    cloned)
      # Neovim 0.12 has a plugin manager. It would ask before it clones.
      "$current" --headless -u NONE -c 'lua os.exit(vim.pack and 0 or 1)' || continue
      # It asks the repository for its branch, which one that is on no branch lacks.
      git -c init.defaultBranch=main -c advice.detachedHead=false clone --quiet "$repository" "$scratch/pydslrep"
      git -C "$scratch/pydslrep" checkout --quiet -B main
      lua_block vim.pack.add "$scratch/pydslrep" | sed 's/^})$/  confirm = false,\n})/' | session cloned "$current" session.lua
      ;;
    colours) session colours "$current" colours.lua < <(echo "vim.g.pydslrep = { enable = false }"; lua_block vim.opt.runtimepath:append) ;;
    older) [ -z "$older" ] || session older "$older" older.lua < <(lua_block vim.opt.runtimepath:append) ;;
    pictures)
      need tmux tmux
      NVIM="$current" PYDSLREP="$command" PYDSLREP_LSP="$server" python3 "$tests/pictures.py"
      ;;
    *) echo "unknown session: $name" >&2; false ;;
  esac || failed=1
done
exit $failed
