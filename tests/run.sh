#!/usr/bin/env bash
# Checks everything: formats, lints, the tests of every crate, and end-to-end tests of the command, the protocol and the
# generated scripts. Requires Rust and Python; installs the rest.
#
# run.sh            everything but editors
# run.sh --editors  also in real editors and browsers, which it installs on Debian-based systems
# run.sh PART       one part: rust, python, extension, site; or vscode, playground, typing, preview, neovim, documentation, web
#
# What all parts need is installed and built first. Then some parts run at a time; each prints its output when it has ended.
set -euo pipefail
cd "$(dirname "$0")/.."

# The longest come first, because nothing runs beside the end of the last one.
parts=(rust python extension site)
in_editors=(vscode playground typing preview neovim documentation web)

step() { printf '\n== %s\n' "$*"; }

part_rust() {
  cargo fmt --all --check
  cargo clippy --workspace --all-targets --locked -- --deny warnings
  if cargo nextest --version >/dev/null 2>&1; then
    cargo nextest run --workspace --locked --no-fail-fast --status-level fail
  else
    cargo test --workspace --locked --no-fail-fast
  fi
}

part_python() {
  .venv/bin/ruff check .
  .venv/bin/ruff format --check .
  .venv/bin/mypy
  .venv/bin/pytest
  # Last, because it waits for cargo.
  .venv/bin/python python/check_scripts.py
}

# Types, lints, build and unit tests of the path preview and the extension for VS Code. The server builds without its process
# and the simulator without sockets: for editors as packages with the command and with WebAssembly.
part_extension() {
  npm run --silent --prefix editors/preview check
  npm run --silent --prefix editors/vscode check
  if [ -n "${FOR_EDITORS:-}" ]; then
    mkdir -p target/extension
    editors/vscode/package.sh --command "$PYDSLREP" >target/extension/native
    editors/vscode/package.sh --target web >target/extension/web
  else
    cargo check --package pydslrep-browser --target wasm32-unknown-unknown --locked
  fi
  # Only the command uses this crate, and it builds for browsers all the same.
  cargo check --package pydslrep-picture --target wasm32-unknown-unknown --locked
}

part_site() { .venv/bin/python docs/site/build.py --check; }

# Reads the site in a browser.
part_documentation() { tests/site/run.sh; }

part_neovim() { tests/editors/run.sh neovim; }
part_preview() { tests/editors/run.sh preview; }
part_web() { tests/editors/run.sh web; }
part_playground() { tests/editors/run.sh playground; }
part_vscode() { tests/editors/run.sh vscode; }
part_typing() { tests/editors/run.sh typing; }

# Installs Python packages, Node packages, and for editors a browser, VS Code and Neovim.
provide_tools() {
  if ! python3 -c 'import ensurepip' 2>/dev/null; then
    # `venv` needs ensurepip, which is a separate package in Debian.
    tests/install/apt.sh python3-venv
  fi
  if ! cmp -s tests/requirements.txt .venv/requirements.txt; then
    rm -rf .venv
    python3 -m venv .venv
    .venv/bin/pip install --quiet --disable-pip-version-check --requirement tests/requirements.txt
    cp tests/requirements.txt .venv
  fi
  # For VS Code's tokenizer, which tests the TextMate grammar, and for building and testing the preview and the extension.
  tests/install/npm.sh grammar/textmate editors/preview editors/vscode
  if [ -n "${FOR_EDITORS:-}" ]; then
    # Where one cannot be had, the parts that need it fail and say so.
    tests/install/chromium.sh >/dev/null || true
    tests/install/code-server.sh "$(tests/install/node.sh 24)" >/dev/null || true
    (. tests/editors/debian.sh; need tmux tmux; unpacked forky neovim) >/dev/null || true
  fi
}

prepare() {
  local log tools
  log=$(mktemp)
  trap "rm -f '$log'" EXIT
  # Incremental compilation costs time that only the next build saves.
  [ -z "${CI:-}" ] || export CARGO_INCREMENTAL=0
  # Most of it waits for the network while the compiler works.
  provide_tools >"$log" 2>&1 &
  tools=$!

  step "Rust: toolchain"
  # rust-toolchain.toml says which; rustup installs what is missing of it.
  if command -v rustup >/dev/null; then
    cargo --version >/dev/null 2>&1 || rustup toolchain install
    rustup target list --installed | grep -x wasm32-unknown-unknown >/dev/null || rustup target add wasm32-unknown-unknown
  fi

  step "Rust: build"
  # Examples have the dependencies of tests, whose features would change the crates again.
  cargo build --workspace --lib --bins --examples --locked

  step "Python, Node and packages"
  wait $tools || { cat "$log" >&2; exit 1; }
  PATH=$(tests/install/node.sh):$PATH

  # Building the tests of the crates replaces the commands, while other parts use them.
  local built tested=$PWD/target/tested
  built=$(realpath "${CARGO_TARGET_DIR:-target}/debug")
  rm -rf "$tested"
  mkdir -p "$tested"
  cp "$built/pydslrep" "$built/pydslrep-lsp" "$built/random-programs" "$tested"
  export PYDSLREP=$tested/pydslrep PYDSLREP_LSP=$tested/pydslrep-lsp RANDOM_PROGRAMS=$tested/random-programs
}

# Runs parts, some at a time. After all of them, fails if one has failed.
run() { # how many at a time, parts
  local status=0
  export FAILURES=$PWD/target/failures
  mkdir -p target
  : >"$FAILURES"
  # One that fails is in that file, and lets the others go on; another status than 0 says that one could not be run.
  printf '%s\n' "${@:2}" | xargs -P "$1" -I PART tests/run.sh --prepared PART || status=$?
  if [ $status != 0 ] || [ -s "$FAILURES" ]; then
    # Once more, because the output of other parts follows the failure.
    local part
    while read -r part; do
      step "the end of $part, which failed" >&2
      tail -n 60 "target/$part.failed" >&2
    done <"$FAILURES"
    step "FAILED: $(paste -s -d ' ' "$FAILURES")" >&2
    exit 1
  fi
}

run_prepared() { # part
  local output status=0
  # The compiler leaves the processors to what waits for robots and takes longest.
  case $1 in rust | extension) renice -n 5 $$ >/dev/null || true ;; esac
  output=$(mktemp)
  trap "rm -f '$output'" EXIT
  # In the background, because a function in a condition would not end at its first failure.
  ( "part_$1" ) >"$output" 2>&1 &
  wait $! || status=$?
  # One part prints at a time.
  exec 8>target/output.lock
  if command -v flock >/dev/null; then flock 8; fi
  step "$1 ($SECONDS s)"
  cat "$output"
  [ $status = 0 ] || { cp "$output" "target/$1.failed"; echo "$1" >>"$FAILURES"; }
}

is_part() { [[ " ${parts[*]} ${in_editors[*]} " == *" $1 "* ]]; }

case ${1:-} in
  --prepared) run_prepared "$2" ;;
  '')
    prepare
    run 3 "${parts[@]}"
    ;;
  --editors)
    export FOR_EDITORS=1
    prepare
    run 3 "${parts[@]}"
    VSIX=$(cat target/extension/native) VSIX_WEB=$(cat target/extension/web) PYDSLREP_WEB=$PWD/editors/web/dist
    export VSIX VSIX_WEB PYDSLREP_WEB
    run 3 "${in_editors[@]}"
    ;;
  *)
    is_part "$1" || { sed -n '5,7s/^# //p' "$0" >&2; exit 2; }
    prepare
    run 1 "$1"
    ;;
esac
