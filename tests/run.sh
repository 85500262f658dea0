#!/usr/bin/env bash
# Checks everything: formats, lints, the tests of every crate, and end-to-end tests of the command, the protocol and the
# generated scripts. Requires Rust and Python; installs the rest. `--editors` also tests in real editors, which it installs
# on Debian-based systems.
set -euo pipefail
case ${1:-} in
  '') editors='' ;;
  --editors) editors='neovim preview vscode typing' ;;
  *) echo "usage: run.sh [--editors]" >&2; exit 2 ;;
esac
cd "$(dirname "$0")/.."

step() { printf '\n== %s\n' "$*"; }

step "Python environment"
if ! python3 -c 'import ensurepip' 2>/dev/null; then
  # `venv` needs ensurepip, which is a separate package in Debian.
  if [ "$(id -u)" = 0 ] && command -v apt-get >/dev/null; then
    apt-get update -qq && apt-get install -y -qq --no-install-recommends python3-venv
  else
    echo "Python's venv is missing: install it (on Debian-based systems: apt install python3-venv) and run this again" >&2
    exit 2
  fi
fi
stamp=.venv/requirements.txt
if ! cmp -s tests/requirements.txt "$stamp"; then
  rm -rf .venv
  python3 -m venv .venv
  .venv/bin/pip install --quiet --disable-pip-version-check --requirement tests/requirements.txt
  cp tests/requirements.txt "$stamp"
fi

step "Node packages"
# For VS Code's tokenizer, which tests the TextMate grammar, and for building and testing the extension.
PATH=$(tests/node.sh):$PATH
for folder in grammar/textmate editors/vscode; do
  stamp=$folder/node_modules/package-lock.json
  if ! cmp -s "$folder/package-lock.json" "$stamp"; then
    npm ci --prefix "$folder" --no-audit --no-fund
    cp "$folder/package-lock.json" "$stamp"
  fi
done

step "Rust: toolchain"
# rust-toolchain.toml says which; rustup installs what is missing of it.
if command -v rustup >/dev/null; then
  cargo --version >/dev/null 2>&1 || rustup toolchain install
  rustup target list --installed | grep -x wasm32-unknown-unknown >/dev/null || rustup target add wasm32-unknown-unknown
fi

step "Rust: format and lints"
cargo fmt --all --check
cargo clippy --workspace --all-targets --locked -- --deny warnings

step "Rust: build and test"
cargo build --workspace --locked
if cargo nextest --version >/dev/null 2>&1; then
  cargo nextest run --workspace --locked --no-fail-fast
else
  cargo test --workspace --locked --no-fail-fast
fi
# Every crate but the command builds for browsers: the server without its process, the simulator without sockets.
cargo check --workspace --exclude pydslrep-cli --exclude pydslrep-naive --no-default-features \
  --target wasm32-unknown-unknown --locked

step "Extension for VS Code: types, lints, build and tests"
npm run --silent --prefix editors/vscode check

step "Python: format, lints, types and tests"
.venv/bin/ruff check .
.venv/bin/ruff format --check .
.venv/bin/mypy
.venv/bin/python crates/script/python/check_scripts.py
.venv/bin/pytest

built=$(realpath "${CARGO_TARGET_DIR:-target}/debug")
export PYDSLREP=$built/pydslrep PYDSLREP_LSP=$built/pydslrep-lsp
if [ -n "$editors" ]; then
  step "Editors: the extension"
  VSIX=$(editors/vscode/package.sh --command "$PYDSLREP")
  export VSIX
fi
for editor in $editors; do
  step "Editors: $editor"
  tests/editors/run.sh "$editor"
done
