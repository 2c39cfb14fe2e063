#!/usr/bin/env bash
# Install ROS 2 (rclpy with Fast DDS, common messages) from pip wheels into a venv of its own, and run our tests on it.
#
#   tools/install_ros2.sh [jazzy|kilted] [VENV]     jazzy, and .venv-ros2-<distribution> beside the project, by default
#
# Runs again in a second when everything is there. Exit code 3: this system cannot have it.
set -euo pipefail

root=$(cd "$(dirname "$0")/.." && pwd)
distribution=${1:-jazzy}
venv=${2:-$root/.venv-ros2-$distribution}
python=${PYTHON:-python3}

case $distribution in
  jazzy) rclpy=7.1.6 ;;
  kilted) rclpy=9.1.2 ;;
  *) echo "install_ros2: unknown distribution $distribution; jazzy or kilted" >&2; exit 2 ;;
esac

say() { echo "install_ros2 $distribution: $*" >&2; }
refuse() {
  say "########################################################################"
  say "CANNOT INSTALL ROS 2 HERE: $*"
  say "The wheels are for Linux on x86-64 with CPython 3.11 to 3.14; a robot's own ROS 2 needs none of this."
  say "########################################################################"
  exit 3
}

[ "$(uname -s)" = Linux ] && [ "$(uname -m)" = x86_64 ] || refuse "this is $(uname -s) on $(uname -m)"
"$python" -c 'import sys; raise SystemExit(not ((3, 11) <= sys.version_info < (3, 15)))' \
  || refuse "$("$python" --version) is not served"

if [ ! -x "$venv/bin/python" ]; then
  say "making $venv"
  "$python" -m venv "$venv"
fi
if ! "$venv/bin/python" -c 'import rclpy, nav_msgs.msg, sensor_msgs.msg, std_srvs.srv' 2>/dev/null; then
  say "installing rclpy $rclpy with Fast DDS and the common messages (about 270 MB on disk)"
  "$venv/bin/python" -m pip install -q --disable-pip-version-check \
    "ros-$distribution-common-interfaces" "ros-rclpy[fastrtps]==$rclpy" >&2
else
  say "rclpy: there"
fi
if ! "$venv/bin/python" -c 'import jacaros.robots.ros.open, jacaros.runtime.cli.watching, msgspec, ruamel.yaml, py_trees, pytest, pytest_rerunfailures, hypothesis' 2>/dev/null; then
  say "installing the project and the test tools into $venv"
  "$venv/bin/python" -m pip install -q --disable-pip-version-check -e "$root[behaviour-trees]" pytest pytest-rerunfailures hypothesis >&2
fi
"$root/tools/build_ros2_interfaces.sh" "$distribution" "$venv"
"$venv/bin/python" -c 'import jacaros.robots.ros.open, pytest, rclpy; import tf2_msgs.msg; from jacaros_interfaces.action import Count'
say "ready: $venv/bin/python -m pytest tests/contracts --require-ros2"
