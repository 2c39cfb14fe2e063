#!/usr/bin/env bash
# Print figures of speed: what can be measured with the environments that are there. Nothing is judged.
set -euo pipefail

root=$(cd "$(dirname "$0")/.." && pwd)
python=$root/.venv/bin/python
"$python" "$root/benchmarks/patrol_speed.py"
"$python" "$root/benchmarks/mind_speed.py"
"$python" "$root/benchmarks/mind/compare.py" --rounds 1
"$python" "$root/benchmarks/robot.py"
"$python" "$root/benchmarks/latency.py" memory
for venv in ros1 ros2-jazzy ros2-kilted; do
  if [ -x "$root/.venv-$venv/bin/python" ]; then
    "$root/.venv-$venv/bin/python" "$root/benchmarks/latency.py" "${venv%%-*}" | sed "s/^ros2    /$(printf '%-8s' "${venv#ros2-}")/"
  else
    echo "$venv  not measured: there is no .venv-$venv (tools/install_ros${venv:3:1}.sh)"
  fi
done
