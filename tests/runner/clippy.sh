#!/usr/bin/env bash
# Prints what clippy says about the crates, and fails if that is anything.
set -euo pipefail
cd "$(dirname "$0")/../.."

if [[ ${RUSTC_WORKSPACE_WRAPPER:-} != clippy-driver ]]; then
  exec cargo clippy --workspace --all-targets --locked --quiet -- --deny warnings
fi
# All builds have asked clippy. Now cargo only repeats the answers.
said=$(cargo build --workspace --all-targets --locked --quiet 2>&1) && [[ -z $said ]] && exit
printf '%s\n' "$said"
exit 1
