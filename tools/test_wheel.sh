#!/usr/bin/env bash
# Build the wheel from a copy of the tree, and try it in a clean venv: a lone program, the patrol, the behaviour tree.
# The wheel stays in runs/dist for the tests with other interpreters.
set -euo pipefail

root=$(cd "$(dirname "$0")/.." && pwd)
python=${PYTHON:-python3}
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT

# Only what a source tree holds: no build folders, no metadata of an editable installation.
mkdir "$scratch/tree"
cp "$root"/{pyproject.toml,setup.cfg,setup.py,package.xml,README.md,LICENSE} "$scratch/tree"
cp -r "$root/resource" "$root/src" "$scratch/tree"
find "$scratch/tree" \( -name __pycache__ -o -name '*.egg-info' \) -prune -exec rm -rf {} +
(cd "$scratch/tree" && "$python" -m build --wheel --outdir "$scratch/dist" >"$scratch/build.log" 2>&1) \
  || { cat "$scratch/build.log"; exit 1; }
rm -rf "$root/runs/dist" && mkdir -p "$root/runs/dist" && cp "$scratch"/dist/*.whl "$root/runs/dist"
ls -l "$root"/runs/dist

# Everything in the package must be in the wheel, but for the settings of tools.
"$python" - "$root" "$scratch"/dist/*.whl <<'PY'
import pathlib, sys, zipfile
root, wheel = pathlib.Path(sys.argv[1]) / "src", sys.argv[2]
packed = set(zipfile.ZipFile(wheel).namelist())
files = {p.relative_to(root).as_posix() for p in (root / "jacaros").rglob("*") if p.is_file() and p.suffix != ".pyc" and p.name != "ruff.toml" and "/." not in p.relative_to(root).as_posix()}
missing = sorted(files - packed)
sys.exit(f"not in the wheel: {', '.join(missing)}" if missing else 0)
PY

"$python" -m venv "$scratch/venv"
"$scratch/venv/bin/python" -m pip install --quiet --disable-pip-version-check "$scratch"/dist/*.whl
cp -r "$root/examples" "$scratch/examples"
cd "$scratch"                   # away from the source tree: only the installed package can be imported
jacaros=$scratch/venv/bin/jacaros
"$jacaros" version
printf '!start.\n+!start <- .print("hello"); .stopMAS.\n' >hello.asl
test "$("$jacaros" run hello.asl)" = "[hello] hello"
"$jacaros" run examples/04_patrol/patrol.jcm --clock fast --for 120 --seed 1 --replay patrol.html >patrol.log
grep -q '^\[' patrol.log
grep -q '</html>' patrol.html
"$scratch/venv/bin/python" -m pip install --quiet --disable-pip-version-check "$(echo "$scratch"/dist/*.whl)[behaviour-trees]"
"$jacaros" run examples/07_shared_robot/shared_robot.jcm --clock fast --ground-truth truth.jsonl >shared_robot.log
"$scratch/venv/bin/python" examples/07_shared_robot/check.py truth.jsonl | grep -q '^passed$'
echo "the wheel works: hello, shared robot, patrol ($(wc -l <patrol.log) lines), replay ($(wc -c <patrol.html) bytes)"
