#!/usr/bin/env bash
# Installs the browser, VS Code and Neovim that tests drive, and the packages of their tests. Where one cannot be had, the parts
# that need it fail and say so.
set -uo pipefail
cd "$(dirname "$0")/../.."

tests/install/chromium.sh >/dev/null
tests/install/code-server.sh "$(tests/install/node.sh 24)" >/dev/null
(. tests/editors/debian.sh && need tmux tmux && unpacked forky neovim && unpacked trixie neovim && unpacked trixie lua-check) >/dev/null
tests/install/npm.sh editors/playground editors/web editors/vscode/packaging tests/site \
  tests/editors/{playground,preview,vscode,web}
