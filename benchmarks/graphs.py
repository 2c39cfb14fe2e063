"""Latencies on the ROS graphs of this machine: runs ``latency.py`` in each existing environment."""

import re
import subprocess
from collections.abc import Callable
from pathlib import Path
from typing import Any

HERE = Path(__file__).resolve().parent
ENVIRONMENTS = {"ros1": "1", "ros2-jazzy": "2", "ros2-kilted": "2"}
"""Suffixes of the virtual environments for real ROS (after ``.venv-``), and their ROS versions."""

_LINE = re.compile(
    r"(\w+) +(agent|bare) +median +([\d.]+) ms +90 % +([\d.]+) ms +99 % +([\d.]+) ms +\((\d+) messages\)"
)
_RATE = re.compile(r"(\w+) +(agent|bare) +flat out +([\d.]+) a second")


def latencies(kinds: list[str], tell: Callable[[str], None]) -> dict[str, Any]:
    """Return the seconds from a message to its command in the environments of *kinds*; ``notes`` name the rest."""
    figures: list[dict[str, Any]] = []
    notes: list[str] = []
    for kind in kinds:
        python = python_of(kind)
        if not python.exists():
            notes.append(missing(kind))
            continue
        tell(f"latency: {kind}")
        done = subprocess.run(
            [python, HERE / "latency.py", kind.partition("-")[0]], capture_output=True, text=True, check=False
        )
        found = figures_in(done.stdout, kind)
        figures += found
        if not found:
            why = (done.stderr.strip() or "nothing came back").splitlines()[-1]
            notes.append(f"{kind}: not measured; {why}")
    return {"figures": figures, "notes": notes}


def python_of(kind: str) -> Path:
    """Return the Python of an environment, which may not exist."""
    return HERE.parent / f".venv-{kind}" / "bin" / "python"


def missing(kind: str) -> str:
    """Return a note about an environment that does not exist."""
    script = f"tools/install_ros{ENVIRONMENTS[kind]}.sh"
    return f"{kind}: not measured: `.venv-{kind}` does not exist (`{script}` creates it)."


def figures_in(text: str, graph: str) -> list[dict[str, Any]]:
    """Return the figures printed by ``latency.py``, in seconds and messages per second."""
    rates = {match[2]: float(match[3]) for match in _RATE.finditer(text)}
    return [
        {
            "graph": graph,
            "way": match[2],
            "median": float(match[3]) / 1000,
            "most": float(match[4]) / 1000,
            "nearly_all": float(match[5]) / 1000,
            "messages": int(match[6]),
            "rate": rates.get(match[2]),
        }
        for match in _LINE.finditer(text)
    ]
