#!/usr/bin/env bash
# Builds what a release consists of into `target/dist`: for each platform an archive with the commands, a wheel, and the
# extension for VS Code; that extension without a command; the source distribution; and the checksums of all. Tests them.
#
# usage: .ci/dist.sh [TARGET...], where TARGET is a platform of Rust's (default: all of those below)
#
# Every platform is built on Linux: zig links for the others. Requires Rust with rustup, and Python. PYDSLREP names a command
# for this machine, which writes the manual pages; without it, it is built.
set -euo pipefail
cd "$(dirname "$0")/.."

# Rust's name of a platform, the tags of its wheel, and VS Code's name.
platforms=(
  "x86_64-unknown-linux-musl manylinux2014_x86_64.musllinux_1_1_x86_64 linux-x64"
  "aarch64-unknown-linux-musl manylinux2014_aarch64.musllinux_1_1_aarch64 linux-arm64"
  "x86_64-pc-windows-gnu win_amd64 win32-x64"
  "aarch64-apple-darwin macosx_11_0_arm64 darwin-arm64"
  "x86_64-apple-darwin macosx_11_0_x86_64 darwin-x64"
)
# Without it, the commands would need the newest macOS.
export MACOSX_DEPLOYMENT_TARGET=11.0
# Files in archives and wheels do not depend on when they are built.
SOURCE_DATE_EPOCH=$(git log -1 --format=%ct)
export SOURCE_DATE_EPOCH

version=$(sed -n 's/^version = "\(.*\)"$/\1/p' Cargo.toml | head -1)
dist=$PWD/target/dist
rm -rf "$dist"
mkdir -p "$dist"

tools=target/dist-tools
if ! cmp -s .ci/dist-requirements.txt "$tools/requirements.txt"; then
  rm -rf "$tools"
  python3 -m venv "$tools"
  "$tools/bin/pip" install --quiet --disable-pip-version-check --requirement .ci/dist-requirements.txt
  cp .ci/dist-requirements.txt "$tools/requirements.txt"
fi
PATH=$PWD/$tools/bin:$PATH

wanted() {
  [ $# = 1 ] || [[ " ${*:2} " == *" $1 "* ]]
}

# The manual pages and completions, which are the same on every platform.
if [ -z "${PYDSLREP:-}" ]; then
  cargo build --quiet --locked --bin pydslrep
  PYDSLREP=${CARGO_TARGET_DIR:-target}/debug/pydslrep
fi
export PYDSLREP_SHARE=$dist/share
"$PYDSLREP" share "$PYDSLREP_SHARE"

for platform in "${platforms[@]}"; do
  read -r target tags vscode <<<"$platform"
  wanted "$target" "$@" || continue
  echo "== $target" >&2
  rustup target add "$target"
  # Only the two packages: together with the others, they would have features that only tests need.
  cargo zigbuild --profile shipped --locked -p pydslrep-cli -p pydslrep-server --target "$target"
  built=$(realpath "${CARGO_TARGET_DIR:-target}/$target/shipped")
  ending=''
  case $target in *-windows-*) ending=.exe ;; esac

  name=pydslrep-$version-$target
  mkdir "$dist/$name"
  cp "$built/pydslrep$ending" "$built/pydslrep-lsp$ending" LICENSE README.md CHANGELOG.md "$dist/$name"
  cp -r "$PYDSLREP_SHARE" "$dist/$name"
  case $target in
    *-windows-*) (cd "$dist" && python3 -m zipfile -c "$name.zip" "$name") ;;
    *) tar --sort=name --owner=0 --group=0 --mtime="@$SOURCE_DATE_EPOCH" -C "$dist" -czf "$dist/$name.tar.gz" "$name" ;;
  esac
  rm -r "${dist:?}/$name"

  PYDSLREP_BINARIES=$built PYDSLREP_PLATFORM=$tags hatchling build -t wheel -d "$dist"
  mv "$(editors/vscode/package.sh --command "$built/pydslrep$ending" --target "$vscode")" "$dist"
done
mv "$(editors/vscode/package.sh --without-command)" "$dist"
hatchling build -t sdist -d "$dist"
rm -r "$PYDSLREP_SHARE"
twine check --strict "$dist"/*.whl "$dist"/*-"$version".tar.gz
cd "$dist"
sha256sum -- * >SHA256SUMS
cd "$OLDPWD"
echo "== tests" >&2
PYDSLREP_DIST=$dist python -m pytest tests/dist/test_artefacts.py
ls -l "$dist" >&2
