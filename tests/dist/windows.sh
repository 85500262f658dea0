#!/usr/bin/env bash
# Tests the commands for Windows on Linux: `windows.sh FOLDER`, where FOLDER has pydslrep.exe.
# Requires wine, gcc-mingw-w64-x86-64 (both in Debian) and one run of tests/run.sh; makes a Python for Windows in
# target/windows.
set -euo pipefail
commands=$(realpath "${1:?usage: windows.sh FOLDER [PYTEST-ARGUMENT...]}")
cd "$(dirname "$0")/../.."
home=$(realpath "${CARGO_TARGET_DIR:-target}")/windows
export WINEPREFIX=$home/prefix WINEARCH=win64 WINEDEBUG=-all PYDSLREP_WINDOWS=$commands
drive=$WINEPREFIX/drive_c

if [ ! -e "$drive/windows/system32/kernel32.dll" ]; then
  wine wineboot --init >/dev/null 2>&1
  wineserver --wait
fi

# Programs of Rust ask bcryptprimitives.dll for random numbers, which wine 8 lacks.
if [ ! -e "$drive/windows/system32/bcryptprimitives.dll" ]; then
  x86_64-w64-mingw32-gcc -shared -O2 -o "$drive/windows/system32/bcryptprimitives.dll" -x c - -ladvapi32 <<'END'
#include <windows.h>
BOOLEAN NTAPI SystemFunction036(PVOID, ULONG);
__declspec(dllexport) BOOL WINAPI ProcessPrng(PBYTE data, SIZE_T size) { return SystemFunction036(data, (ULONG)size); }
END
fi

# No package index has Python for Windows as such, but panda3d's wheel contains its libraries. What is written in Python comes
# from this machine's.
if [ ! -e "$drive/python/python.exe" ]; then
  rm -rf "$home/wheels" "$home/panda3d" "$drive/python"
  mkdir -p "$drive/python/DLLs"
  python=$PWD/.venv/bin/python
  number=$("$python" -c 'import sys; print("%d%d" % sys.version_info[:2])')
  for package in panda3d==1.10.16 pyzmq==27.3.0 cbor2==6.2.1 coppeliasim-zmqremoteapi-client==2.0.4; do
    "$python" -m pip download --quiet --disable-pip-version-check --no-deps --only-binary :all: --platform win_amd64 \
      --python-version "$number" --dest "$home/wheels" "$package"
  done
  "$python" -m zipfile -e "$home"/wheels/panda3d-*.whl "$home/panda3d"
  cp "$home"/panda3d/deploy_libs/*.pyd "$home"/panda3d/deploy_libs/lib*.dll "$drive/python/DLLs"
  cp "$home"/panda3d/deploy_libs/python3*.dll "$home"/panda3d/deploy_libs/VCRUNTIME140.dll "$drive/python"
  cp -r "$("$python" -c 'import os; print(os.path.dirname(os.__file__))')" "$drive/python/Lib"
  rm -rf "$drive"/python/Lib/{test,lib-dynload,site-packages,dist-packages} "$home/panda3d"
  for wheel in "$home"/wheels/*.whl; do
    case $wheel in */panda3d-*) ;; *) "$python" -m zipfile -e "$wheel" "$drive/python/Lib/site-packages" ;; esac
  done
  x86_64-w64-mingw32-gcc -municode -O2 -o "$drive/python/python.exe" -x c - -x none "$drive/python/python$number.dll" <<'END'
#include <wchar.h>
int Py_Main(int, wchar_t **);
int wmain(int argc, wchar_t **argv) { return Py_Main(argc, argv); }
END
fi
exec .venv/bin/pytest tests/dist/test_windows.py "${@:2}"
