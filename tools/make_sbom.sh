#!/usr/bin/env bash
# Write the bill of materials (CycloneDX, JSON) of a release: the package, its extras and all that they bring along.
#
#     tools/make_sbom.sh [FOLDER]     FOLDER has the wheel (dist by default), and gets jacaros.cdx.json
#
# Versions are those of constraints.txt, licences those of the packages' metadata. The extra ros2 is left out: a robot has
# its own ROS.
set -euo pipefail

root=$(cd "$(dirname "$0")/.." && pwd)
python=${PYTHON:-python3}
folder=${1:-$root/dist}
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT

wheel=$(echo "$folder"/*.whl)
"$python" -m venv --without-pip "$scratch/venv"
"$python" -m pip --python "$scratch/venv/bin/python" install --quiet --disable-pip-version-check \
  --constraint "$root/constraints.txt" "$wheel[behaviour-trees,console,fleet,foxglove,maps,mcp,rosbridge,serve]"
"$python" -m cyclonedx_py environment --output-reproducible --output-format JSON --output-file "$scratch/sbom.json" \
  --pyproject "$root/pyproject.toml" "$scratch/venv/bin/python"
# Paths of this machine stay out.
"$python" - "$scratch/sbom.json" "$folder/jacaros.cdx.json" <<'PY'
import json, sys
sbom = json.load(open(sys.argv[1], encoding="utf-8"))
for part in (sbom["metadata"]["component"], *sbom["components"]):
    part["externalReferences"] = [r for r in part.get("externalReferences", []) if not r["url"].startswith("file:")]
    part.get("hashes", []).sort(key=str)
    if not part["externalReferences"]:
        del part["externalReferences"]
with open(sys.argv[2], "w", encoding="utf-8") as file:
    json.dump(sbom, file, indent=2, sort_keys=True)
    file.write("\n")
unlicensed = [p["name"] for p in sbom["components"] if not p.get("licenses")]
print(f"{sys.argv[2]}: {len(sbom['components'])} packages")
sys.exit(f"no licence is known of: {', '.join(unlicensed)}" if unlicensed else 0)
PY
