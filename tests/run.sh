#!/usr/bin/env bash
# Checks everything: formats, lints, the tests of every crate, and end-to-end tests of the command, the protocol and the
# generated scripts. Requires Rust and Python 3.11; installs the rest.
#
# run.sh            everything but editors
# run.sh --editors  also in real editors and browsers, which it installs on Debian-based systems
# run.sh --long     everything at full length
# run.sh NAME       only this and what it needs; --help lists the names
set -euo pipefail
cd "$(dirname "$0")/.."
exec python3 tests/runner/main.py "$@"
