#!/usr/bin/env bash
# Writes src/ from grammar.js, for editors old and new (ABI 14), and notes from what, for the tests. Needs the
# tree-sitter command (0.26) and Node.
set -euo pipefail
cd "$(dirname "$0")"
tree-sitter generate --abi 14
{
  echo "# $(tree-sitter --version)"
  sha256sum grammar.js src/grammar.json src/node-types.json src/parser.c src/tree_sitter/*.h
} > src/checksums.txt
tree-sitter test
