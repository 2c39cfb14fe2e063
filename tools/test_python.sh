#!/usr/bin/env bash
# Run the unit tests with another interpreter, on the wheel that test_wheel.sh has built.
#
#   tools/test_python.sh python3.13
set -euo pipefail

root=$(cd "$(dirname "$0")/.." && pwd)
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
"$1" -m venv "$scratch/venv"
wheel=$(echo "$root"/runs/dist/*.whl)
"$scratch/venv/bin/python" -m pip install --quiet --disable-pip-version-check "$wheel[behaviour-trees]" pytest hypothesis
"$scratch/venv/bin/python" --version
cd "$root"
"$scratch/venv/bin/python" -m pytest -q -p no:cacheprovider tests/unit -m "not browser"
