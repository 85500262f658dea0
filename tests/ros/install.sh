#!/usr/bin/env bash
# install.sh NAME: makes the environment target/ros-NAME with a ROS 2 of its own, kilted or jazzy, unless it is there, and
# prints the path of its Python; nothing where there are no wheels. The wheels start each Python of their environment a
# second time, with another library path: never mix them with those of other tests.
set -euo pipefail
source "$(dirname "$0")/../install/lock.sh"
cd "$repository"

name=$1
folder=target/ros-$name requirements=tests/ros/$name.txt
if ! cmp -s "$requirements" "$folder/requirements.txt"; then
  platform=$(python3 -c 'import platform, sys; print(sys.platform, platform.machine(), platform.python_implementation(), *sys.version_info[:2])')
  if [[ $platform != "linux x86_64 CPython 3 11" ]]; then
    echo "ROS 2 is not tested: its wheels are pinned for CPython 3.11 on Linux (x86-64), and this is $platform" >&2
    exit
  fi
  wait_for_turn
  rm -rf "$folder"
  python3 -m venv "$folder"
  if ! said=$("$folder/bin/pip" install --quiet --disable-pip-version-check --require-hashes --no-deps --only-binary :all: --requirement "$requirements" 2>&1); then
    rm -rf "$folder"
    if [[ $said == *"No matching distribution"* ]]; then
      echo "ROS 2 is not tested, since there are no wheels of it any more: $said" >&2
      exit
    fi
    echo "$said" >&2
    exit 1
  fi
  cp "$requirements" "$folder"/requirements.txt
fi
echo "$repository/$folder/bin/python"
