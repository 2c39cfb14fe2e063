#!/usr/bin/env bash
# Run the unit tests with another interpreter, or some of them, on the wheel that test_wheel.sh has built.
#
#   tools/test_python.sh python3.13 [FOLDER ...]
set -euo pipefail

root=$(cd "$(dirname "$0")/.." && pwd)
python=$1
shift
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
"$python" -m venv "$scratch/venv"
wheel=$(echo "$root"/runs/dist/*.whl)
"$scratch/venv/bin/python" -m pip install --quiet --disable-pip-version-check "$wheel[behaviour-trees]" pytest hypothesis numpy rosbags
"$scratch/venv/bin/python" --version
cd "$root"
"$scratch/venv/bin/python" -m pytest -q -p no:cacheprovider "${@:-tests/unit}" -m "not browser"
