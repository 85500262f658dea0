#!/usr/bin/env bash
# Builds the extension for this platform, with the server inside: a .vsix that works with no setting at all.
# Needs Rust; Node it finds or gets by pip. Prints the path of the package.
# `--command FILE` takes a command `pydslrep` that is already built, `--target NAME` says which platform that is for.
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
# The command is the server as well (`pydslrep lsp`), and is what runs programs.
cp "$command" "server/pydslrep$ending"
chmod +x "server/pydslrep$ending"
# What a debugger wants is most of a build that is not for release, and some of one that is.
if [ "$target" = "$(node -p 'process.platform + "-" + process.arch')" ] && command -v strip >/dev/null; then
  strip "server/pydslrep$ending"
fi
node scripts/build.mjs --production >&2
package=pydslrep-$target.vsix
# As long as Cargo.toml names no repository, links in the readme lead nowhere.
packaging/node_modules/.bin/vsce package --target "$target" --out "$package" --no-dependencies --allow-missing-repository \
  --no-rewrite-relative-links >&2
echo "$PWD/$package"
