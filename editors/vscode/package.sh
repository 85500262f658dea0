#!/usr/bin/env bash
# Builds the extension for this platform, with the server inside: a .vsix that needs no settings.
# Requires Rust; installs Node with pip if necessary. Prints the path of the package.
# `--target web` builds the package for VS Code for the Web: with the server as WebAssembly, without the command.
# `--command FILE` uses a command `pydslrep` that is already built, `--target NAME` names the platform that it is for.
# `--without-command` builds the package for all other platforms, whose users install the command themselves.
set -euo pipefail
cd "$(dirname "$0")"
repository=$(cd ../.. && pwd)

command=
target=
has_command=1
while [ $# -gt 0 ]; do
  case $1 in
    --command) command=$(realpath "${2:?--command needs a file}"); shift 2 ;;
    --target) target=${2:?--target needs a name, such as linux-x64}; shift 2 ;;
    --without-command) has_command=; shift ;;
    *) echo "usage: package.sh [--command FILE] [--target NAME] | --without-command" >&2; exit 2 ;;
  esac
done
PATH=$("$repository/tests/install/node.sh"):$PATH
this_platform=$(node -p 'process.platform + "-" + process.arch')
target=${target:-$this_platform}
if [ "$target" = web ]; then has_command=; fi
web=

"$repository/tests/install/npm.sh" . packaging

rm -rf server
if [ -n "$has_command" ]; then
  ending=
  case $target in win32-*) ending=.exe ;; esac
  if [ -z "$command" ]; then
    (cd "$repository" && cargo build --release --locked --bin pydslrep >&2)
    command=${CARGO_TARGET_DIR:-$repository/target}/release/pydslrep$ending
  fi
  mkdir server
  # The command contains the server (`pydslrep lsp`) and runs programs.
  cp "$command" "server/pydslrep$ending"
  chmod +x "server/pydslrep$ending"
  # Most of a debug build is debug information. A release build has neither that nor symbols, and stays byte by byte as it is.
  if [ "$target" = "$this_platform" ] && command -v strip >/dev/null; then
    if nm "server/pydslrep$ending" 2>/dev/null | grep . >/dev/null; then strip "server/pydslrep$ending"; fi
  fi
  package=pydslrep-$target.vsix
  for_target=(--target "$target")
elif [ "$target" = web ]; then
  # $PYDSLREP_WEB: it is built already.
  [ -n "${PYDSLREP_WEB:-}" ] || ../web/build.sh >&2
  package=pydslrep-web.vsix
  for_target=(--target web)
  web=--web
else
  package=pydslrep-universal.vsix
  for_target=()
fi
node scripts/build.mjs --production $web >&2
# Without a repository in Cargo.toml, relative links of the readme have no target.
packaging/node_modules/.bin/vsce package "${for_target[@]}" --out "$package" --no-dependencies --allow-missing-repository \
  --no-rewrite-relative-links --readme-path dist/README.md >&2
echo "$PWD/$package"
