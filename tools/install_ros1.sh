#!/usr/bin/env bash
# Install ROS 1 (rospy, rosmaster, messages) from Debian 12's own packages and make a venv that runs our tests on it.
#
#   tools/install_ros1.sh [VENV]        VENV is .venv-ros1 beside the project by default
#
# Runs again in a second when everything is there. Exit code 3: this system cannot have it.
set -euo pipefail

root=$(cd "$(dirname "$0")/.." && pwd)
venv=${1:-$root/.venv-ros1}
python=/usr/bin/python3

# rosmaster alone is enough for tests: no roscore, no rosout. nav_msgs draws boost headers in (144 MB): Debian's way.
packages=(
  python3-rospy python3-rosmaster python3-genpy
  python3-std-msgs python3-geometry-msgs python3-nav-msgs python3-sensor-msgs python3-diagnostic-msgs
  python3-std-srvs python3-tf2-msgs python3-venv
  # For the tests alone: a genuine action type, and genuine peers.
  python3-actionlib python3-actionlib-msgs python3-move-base-msgs python3-tf2-ros python3-rosparam
)

say() { echo "install_ros1: $*" >&2; }
refuse() {
  say "########################################################################"
  say "CANNOT INSTALL ROS 1 HERE: $*"
  say "The ROS 1 tests need Debian 12 (bookworm), or a robot's own ROS 1."
  say "########################################################################"
  exit 3
}
as_root() {
  if [ "$(id -u)" = 0 ]; then "$@"; else
    command -v sudo >/dev/null || refuse "not root, and there is no sudo"
    sudo "$@"
  fi
}
installed() { dpkg-query -W -f='${Status}\n' "${packages[@]}" 2>/dev/null | grep -c '^install ok installed$' || true; }

command -v dpkg-query >/dev/null && command -v apt-get >/dev/null || refuse "this is not a Debian system"

if [ "$(installed)" -lt "${#packages[@]}" ]; then
  say "installing ${#packages[@]} Debian packages and what they need (about 240 MB on disk)"
  as_root apt-get update -q >&2
  apt-cache show python3-rospy >/dev/null 2>&1 || refuse "this Debian or Ubuntu has no package python3-rospy"
  as_root env DEBIAN_FRONTEND=noninteractive apt-get install -q -y --no-install-recommends "${packages[@]}" >&2
else
  say "Debian packages: all there"
fi

# Debian's rospy belongs to Debian's Python: a venv of that very interpreter sees it.
if [ ! -x "$venv/bin/python" ]; then
  say "making $venv"
  "$python" -m venv --system-site-packages "$venv"
fi
if ! "$venv/bin/python" -c 'import jacaros.robots.ros.open, jacaros.runtime.cli.watching, msgspec, ruamel.yaml, pytest, pytest_rerunfailures, hypothesis, rospy' 2>/dev/null; then
  say "installing the project and the test tools into $venv"
  "$venv/bin/python" -m pip install -q --disable-pip-version-check -e "$root" pytest pytest-rerunfailures hypothesis >&2
fi
"$venv/bin/python" -W ignore -c 'import jacaros.robots.ros.open, pytest, rospy; from nav_msgs.msg import Odometry; from tf2_msgs.msg import TFMessage
import actionlib, move_base_msgs.msg, rosparam, tf2_ros'
say "ready: $venv/bin/python -m pytest tests/contracts --require-ros1"
