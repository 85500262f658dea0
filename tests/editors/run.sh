#!/usr/bin/env bash
# `run.sh NAME`: tests editors/NAME in the real editor.
set -euo pipefail
folder=$(cd "$(dirname "$0")" && pwd)
if [ $# = 0 ] || [ ! -x "$folder/$1/run.sh" ]; then
  echo "usage: run.sh NAME, one of:" "$(cd "$folder" && ls -d */run.sh | xargs -n1 dirname | tr '\n' ' ')" >&2
  exit 2
fi
exec "$folder/$1/run.sh" "${@:2}"
