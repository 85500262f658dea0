# Sourced by the run.sh of terminal editors: finds an editor (find_NAME), or unpacks it and its dependencies from Debian
# packages.
#
# Unpacked editors are in target/editors with their own libraries, so an editor of a newer Debian runs on an older one and
# the system is not changed.

repository=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)

need() { # program, its package
  command -v "$1" >/dev/null || "$repository/tests/install/apt.sh" "$2"
}

unpacked() { # suite, package; prints the folder
  local folder="$repository/target/editors/$1-$2"
  if [ ! -e "$folder/complete" ]; then
    command -v apt-get >/dev/null || {
      echo "$2 is not on the PATH, and there is no apt-get to download it: install it and run this again" >&2
      exit 2
    }
    need patchelf patchelf >&2
    source "$repository/tests/install/lock.sh"
    wait_for_turn
    if [ ! -e "$folder/complete" ]; then
      rm -rf "$folder"
      unpack "$1" "$folder" "$2" >&2
      touch "$folder/complete"
    fi
  fi
  echo "$folder"
}

unpack() { # suite, folder, package
  local folder=$2 state="$2/apt" mirror
  mkdir -p "$folder/usr/"{bin,sbin,lib,lib64} "$state/lists/partial" "$state/cache/archives/partial"
  for name in bin sbin lib lib64; do ln -s "usr/$name" "$folder/$name"; done
  mirror=$(apt-get indextargets --format '$(SITE)' 'Created-By: Packages' | grep -v security | sort | uniq -c | sort -rn | awk 'NR == 1 { print $2 }')
  echo "deb [signed-by=/usr/share/keyrings/debian-archive-keyring.gpg] $mirror $1 main" > "$state/sources.list"
  : > "$state/status"
  local options=(
    -qq -o Dir::Etc::sourcelist="$state/sources.list" -o Dir::Etc::sourceparts=/dev/null
    -o Dir::Etc::preferencesparts=/dev/null -o Dir::State="$state" -o Dir::State::status="$state/status"
    -o Dir::Cache="$state/cache" -o APT::Sandbox::User=root -o APT::Install-Recommends=false
    -o Acquire::Languages=none -o Acquire::Retries=5 -o Debug::NoLocking=1
  )
  apt-get "${options[@]}" update
  apt-get "${options[@]}" -y --download-only install "$3" > /dev/null
  for package in "$state"/cache/archives/*.deb; do
    dpkg-deb --fsys-tarfile "$package" | tar -x -C "$folder" --keep-directory-symlink --no-same-owner
  done
  rm -rf "$state"
  local loader libraries
  loader=$(find "$folder"/usr/lib* -name 'ld-linux*.so.*' | head -n 1)
  libraries=$(dirname "$(find "$folder"/usr/lib* -name libc.so.6 | head -n 1)")
  find "$folder/usr" -type f -perm -100 ! -name '*.so*' | while read -r file; do
    patchelf --print-interpreter "$file" > /dev/null 2>&1 || continue
    patchelf --set-interpreter "$loader" --force-rpath --set-rpath "$libraries:$folder/usr/lib" "$file" 2> /dev/null || true
  done
}

find_helix() { # $HX, or else hx on the PATH, or else Debian 13's
  if [ -z "${HX:-}" ] && ! HX=$(command -v hx); then
    local folder
    folder=$(unpacked trixie hx)
    export HX="$folder/usr/bin/hx" HELIX_RUNTIME="$folder/usr/lib/hx/runtime"
  fi
  export HX
}

find_emacs() { # $EMACS, or else emacs on the PATH, or else Debian 13's
  if [ -z "${EMACS:-}" ] && ! EMACS=$(command -v emacs); then
    local folder shared parts
    folder=$(unpacked trixie emacs-nox)
    EMACS="$folder/usr/bin/emacs-nox"
    # It does not find its files outside /usr.
    shared=$(echo "$folder"/usr/share/emacs/[0-9]*)
    parts=$(echo "$folder"/usr/libexec/emacs/*/*)
    export EMACSLOADPATH="$shared/lisp" EMACSDATA="$shared/etc" EMACSDOC="$shared/etc" EMACSPATH="$parts"
    export EMACS_OPTIONS="--dump-file=$(echo "$parts"/*.pdmp)"
  fi
  export EMACS
}

find_kakoune() { # $KAK and $KAK_LSP, or else those on the PATH, or else Debian's and one that cargo builds
  if [ -z "${KAK:-}" ] && ! KAK=$(command -v kak); then
    local folder
    folder=$(unpacked trixie kakoune)
    export KAK="$folder/usr/bin/kak" KAKOUNE_RUNTIME="$folder/usr/share/kak"
  fi
  # Debian has no package of it; the build takes minutes.
  if [ -z "${KAK_LSP:-}" ] && ! KAK_LSP=$(command -v kak-lsp); then
    KAK_LSP="$repository/target/editors/kak-lsp/bin/kak-lsp"
    [ -x "$KAK_LSP" ] || cargo install --quiet --locked --root "$repository/target/editors/kak-lsp" kak-lsp@22.0.0
  fi
  export KAK KAK_LSP
}
