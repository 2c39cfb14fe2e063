"""The engines that are measured: each runs a workload in a separate process and reports its figures."""

import json
import os
import re
import signal
import subprocess
import sys
import tempfile
import time
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from mind.workloads import TIMES, Workload

HERE = Path(__file__).parent
PEER = HERE.parent.parent / ".venv-bench" / "bin" / "python"
OURS, AGENTSPEAK, JASON = "jacaros", "agentspeak", "jason"
NAMES = {OURS: "JaCaROS", AGENTSPEAK: "python-agentspeak", JASON: "Jason"}
PATIENCE = {OURS: 120.0, AGENTSPEAK: 30.0, JASON: 120.0}
"""Processor seconds after which an engine is stopped."""

WAITING = 4
"""Limit on wall time, as a multiple of the limit on processor time, for a process that waits."""

MOST_TIMES = 10


def available() -> list[str]:
    """Return the engines of this machine, including Jason if the variable JASON names its command."""
    return [OURS, *([AGENTSPEAK] if PEER.exists() else []), *([JASON] if os.environ.get("JASON") else [])]


def run(engine: str, workload: Workload, n: int) -> dict[str, Any]:
    """Run a workload at a size; return its figures (see `marks.Marks.report`), or a ``note`` why there are not any."""
    times = _times(engine, workload, n)
    with tempfile.TemporaryDirectory() as scratch:
        folder = Path(scratch)
        project = workload.write(folder, n, times)
        return _measured(_command(engine, workload, project), PATIENCE[engine])


def _times(engine: str, workload: Workload, n: int) -> int:
    """Return how often the process repeats the work: short work of ours more often; that of the peer takes long enough."""
    if engine == AGENTSPEAK:
        return 1
    return min(MOST_TIMES, max(TIMES, workload.n // n)) if engine == OURS else 3


def _command(engine: str, workload: Workload, project: Path) -> list[str]:
    if engine == AGENTSPEAK:
        agents = [
            f"{name}={project.parent / file}.asl{f'#{count}' if count > 1 else ''}"
            for name, file, count in workload.agents
        ]
        return [str(PEER), str(HERE / "on_agentspeak.py"), *agents]
    script = "on_jacaros.py" if engine == OURS else "on_jason.py"
    return [sys.executable, str(HERE / script), str(project)]


def _measured(command: Sequence[str], patience: float) -> dict[str, Any]:
    """Return the output of a measuring script, or its error."""
    began = time.monotonic()
    with subprocess.Popen(
        command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, start_new_session=True
    ) as process:
        output = None
        # A limit set for the process itself would make its clock tick in milliseconds.
        while output is None:
            try:
                output = process.communicate(timeout=0.5)
            except subprocess.TimeoutExpired:
                if _spent(process.pid) > patience or time.monotonic() - began > WAITING * patience:
                    os.killpg(process.pid, signal.SIGKILL)
                    return _late(patience, process.communicate()[1])
    if process.returncode != 0 or not output[0].strip():
        return {"note": "fails", "why": (output[1] or output[0])[-400:]}
    found: dict[str, Any] = json.loads(output[0].splitlines()[-1])
    return found


def _spent(process: int) -> float:
    """Return the processor seconds of a running process; zero where the system does not report them."""
    try:
        fields = Path(f"/proc/{process}/stat").read_text(encoding="utf-8").rpartition(")")[2].split()
    except OSError:
        return 0.0
    return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")


def _late(patience: float, told: str) -> dict[str, Any]:
    """Return the note for an engine that was stopped; ``at_least`` is the time spent on the work itself."""
    begun = re.findall(r"^begin ([\d.]+)$", told, re.MULTILINE)
    note = {"note": f"> {patience:g} s"}
    return note | ({"at_least": patience - float(begun[-1])} if begun else {})
