#!/usr/bin/env bash
# Generates src/ from grammar.js with ABI 14, which old and new editors support, and checksums for the tests. Requires the
# tree-sitter command (0.26) and Node.
set -euo pipefail
cd "$(dirname "$0")"
tree-sitter generate --abi 14
{
  echo "# $(tree-sitter --version)"
  sha256sum grammar.js src/grammar.json src/node-types.json src/parser.c src/tree_sitter/*.h
} > src/checksums.txt
tree-sitter test
