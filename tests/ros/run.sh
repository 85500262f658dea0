#!/usr/bin/env bash
# Tests the target ros2 with the real rclpy, on loopback: Kilted, and with --long also Jazzy. The arguments are pytest's.
set -euo pipefail
cd "$(dirname "$0")/../.."

for option in "$@"; do
  if [[ $option == --long ]]; then
    ROS_PYTHON_JAZZY=$(tests/ros/install.sh jazzy)
    export ROS_PYTHON_JAZZY
  fi
done
python=$(tests/ros/install.sh kilted)
[[ -n $python ]] || exit 0
export PYTHONPATH=$PWD/python:$PWD/tests/support
cd tests/ros
exec "$python" -m pytest "$@"
