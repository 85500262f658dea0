#!/usr/bin/env bash
# Installs what is missing of the toolchain that rust-toolchain.toml names, where there is a rustup.
set -euo pipefail

if command -v rustup >/dev/null; then
  cargo --version >/dev/null 2>&1 || rustup toolchain install
  rustup target list --installed | grep -x wasm32-unknown-unknown >/dev/null || rustup target add wasm32-unknown-unknown
fi
