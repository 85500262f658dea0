#!/usr/bin/env bash
# Builds the extension for this platform, with the server inside: a .vsix that needs no settings.
# Requires Rust; installs Node with pip if necessary. Prints the path of the package.
# `--command FILE` uses a command `pydslrep` that is already built, `--target NAME` names the platform that it is for.
set -euo pipefail
cd "$(dirname "$0")"
repository=$(cd ../.. && pwd)

command=
target=
while [ $# -gt 0 ]; do
  case $1 in
    --command) command=$(realpath "${2:?--command needs a file}"); shift 2 ;;
    --target) target=${2:?--target needs a name, such as linux-x64}; shift 2 ;;
    *) echo "usage: package.sh [--command FILE] [--target NAME]" >&2; exit 2 ;;
  esac
done
PATH=$("$repository/tests/node.sh"):$PATH
target=${target:-$(node -p 'process.platform + "-" + process.arch')}
ending=
case $target in win32-*) ending=.exe ;; esac

if [ -z "$command" ]; then
  (cd "$repository" && cargo build --release --locked --bin pydslrep >&2)
  command=${CARGO_TARGET_DIR:-$repository/target}/release/pydslrep$ending
fi

npm ci --loglevel error >&2
npm ci --loglevel error --prefix packaging >&2
rm -rf server
mkdir server
# The command contains the server (`pydslrep lsp`) and runs programs.
cp "$command" "server/pydslrep$ending"
chmod +x "server/pydslrep$ending"
# Most of a debug build, and part of a release build, is debug information.
if [ "$target" = "$(node -p 'process.platform + "-" + process.arch')" ] && command -v strip >/dev/null; then
  strip "server/pydslrep$ending"
fi
node scripts/build.mjs --production >&2
package=pydslrep-$target.vsix
# Without a repository in Cargo.toml, relative links of the readme have no target.
packaging/node_modules/.bin/vsce package --target "$target" --out "$package" --no-dependencies --allow-missing-repository \
  --no-rewrite-relative-links >&2
echo "$PWD/$package"
