#!/usr/bin/env bash
# Build wheel and source distribution twice and compare them, check them as an index would, and try the wheel in a clean venv:
# the base install with a lone program and a robot of the embedded world, then the extras, then the bill of materials.
# They stay in runs/dist; the tests with other interpreters use the wheel.
set -euo pipefail

root=$(cd "$(dirname "$0")/.." && pwd)
python=${PYTHON:-python3}
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
dist=$root/runs/dist
fail() { echo "test_wheel.sh: $*" >&2; exit 1; }

rm -rf "$dist"
"$python" "$root/tools/build_release.py" "$dist"
ls -l "$dist"

# Again, from another folder, with other rights, times and without git: the same to the last byte.
mkdir "$scratch/tree"
(cd "$root" && git -c safe.directory='*' ls-files -z --cached --others --exclude-standard | xargs -0 ls -d 2>/dev/null \
  | tar c -T -) | (umask 077 && tar x -m --no-same-permissions -C "$scratch/tree")
epoch=${SOURCE_DATE_EPOCH:-$(git -c safe.directory='*' -C "$root" log -1 --format=%ct)}
(umask 077 && SOURCE_DATE_EPOCH=$epoch TZ=Asia/Tokyo "$python" "$scratch/tree/tools/build_release.py" "$scratch/dist" >/dev/null)
for file in "$dist"/*; do
  cmp "$file" "$scratch/dist/$(basename "$file")" || fail "$(basename "$file") is another one when it is built again"
done

"$python" -m twine check --strict "$dist"/*

# Everything in the package must be in the wheel, but for the settings of tools, and what a packager needs in the other one.
"$python" - "$root" "$dist" <<'PY'
import pathlib, re, sys, tarfile, zipfile
root, dist = pathlib.Path(sys.argv[1]), pathlib.Path(sys.argv[2])
[wheel], [source] = dist.glob("*.whl"), dist.glob("*.tar.gz")
zipped = zipfile.ZipFile(wheel)
files = {p.relative_to(root / "src").as_posix() for p in (root / "src/jacaros").rglob("*") if p.is_file() and p.suffix != ".pyc" and p.name != "ruff.toml" and "/." not in p.relative_to(root / "src").as_posix()}
if missing := sorted(files - set(zipped.namelist())):
    sys.exit(f"not in the wheel: {', '.join(missing)}")
[metadata] = (zipped.read(n).decode() for n in zipped.namelist() if n.endswith("/METADATA"))
if relative := re.findall(r'(?:\]\(|src=")(?!https:|#)[^)"]+', metadata):
    sys.exit(f"links that lead nowhere on the page of an index: {relative}")
for line in ("License-Expression: Apache-2.0", "License-File: LICENSE", "Classifier: Typing :: Typed"):
    if f"\n{line}\n" not in metadata:
        sys.exit(f"not in the metadata: {line}")
packed = {name.partition("/")[2] for name in tarfile.open(source).getnames()}
wanted = {"LICENSE", "CHANGELOG.md", "SECURITY.md", "CITATION.cff", "constraints.txt", "docs/index.md", "tests/conftest.py", "tools/test_all.py", ".importlinter", "examples/04_patrol/patrol.jcm"}
if missing := sorted(wanted - packed):
    sys.exit(f"not in the source distribution: {', '.join(missing)}")
PY

install() { "$scratch/venv/bin/python" -m pip install --quiet --disable-pip-version-check --constraint "$root/constraints.txt" "$@"; }
wheel=$(echo "$dist"/*.whl)
"$python" -m venv "$scratch/venv"
install "$wheel"
cp -r "$root/examples" "$scratch/examples"
cd "$scratch"                   # away from the source tree: only the installed package can be imported
jacaros=$scratch/venv/bin/jacaros
"$jacaros" version
"$scratch/venv/bin/python" -m pip list --disable-pip-version-check --format=freeze | grep -iE '^(numpy|rosbags|cbor2)=' \
  && fail "the base install brings along more than it needs"
printf '!start.\n+!start <- .print("hello"); .stopMAS.\n' >hello.asl
test "$("$jacaros" run hello.asl)" = "[hello] hello"
"$jacaros" run examples/04_patrol/patrol.jcm --clock fast --for 120 --seed 1 --replay patrol.html --record patrol.jsonl >patrol.log
grep -q '^\[' patrol.log
grep -q '</html>' patrol.html
grep -q '"scan"\|"pose"\|"frame"' patrol.jsonl
"$jacaros" check examples/04_patrol
"$jacaros" sim office --ros memory --clock fast --for 2

# What needs an extra says which one, and shows no traceback.
missing() {
  local wanted=$1; shift
  "$@" >missing.log 2>&1 && fail "$* works without the extra $wanted"
  grep -q "jacaros\[$wanted\]" missing.log || { cat missing.log; fail "$* does not name the extra $wanted"; }
  if grep -q Traceback missing.log; then cat missing.log; fail "$* shows a traceback"; fi
}
missing rosbridge "$jacaros" run hello.asl --ros rosbridge --for 1
missing fleet "$jacaros" run hello.asl --fleet lab
missing fleet "$jacaros" fleet list lab
missing serve "$jacaros" run hello.asl --serve 0 --for 1
missing mcp "$jacaros" mcp hello.asl
printf 'class A extends Artifact { @OPERATION void hello() { } }' >A.java
missing java "$jacaros" port A.java

install "$wheel[behaviour-trees,console,fleet,foxglove,java,maps,mcp,rosbridge,serve]"
"$jacaros" world show house --output house.svg
"$jacaros" port A.java | grep -q "class A(Artifact):"
"$jacaros" run examples/07_shared_robot/shared_robot.jcm --clock fast --ground-truth truth.jsonl >shared_robot.log
"$scratch/venv/bin/python" examples/07_shared_robot/check.py truth.jsonl | grep -q '^passed$'
printf 'MAS two {\n  agents: hello at "left"; hello2 hello at "right";\n}\n' >two.mas2j
test "$("$jacaros" run two.mas2j --all-nodes --for 5 2>/dev/null | sort | head -1)" = "[left] [hello] hello"
PYTHON=$python "$root/tools/make_sbom.sh" "$dist"
echo "the wheel works: hello, shared robot, patrol ($(wc -l <patrol.log) lines), replay ($(wc -c <patrol.html) bytes)"
