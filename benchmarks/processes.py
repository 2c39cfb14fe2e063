"""Figures of whole processes: start, memory, loading."""

import os
import re
import subprocess
import sys
import tempfile
import time
from pathlib import Path
from statistics import median
from typing import Any

from mind.engines import AGENTSPEAK, JASON, OURS, PEER
from mind.workloads import PROGRAMS

HELLO = '!hello.\n+!hello <- .print("begin"); .print("end"); .stopMAS.\n'
RECURSION = "!count({n}).\n+!count(0) <- .stopMAS.\n+!count(I) : I > 0 <- !count(I - 1).\n"
CYCLES = 1_000_000
PLANS = 300


def started(rounds: int, engines: list[str]) -> dict[str, dict[str, float]]:
    """Return processor seconds, wall seconds and megabytes of processes that do almost nothing; the minimum of each."""
    with tempfile.TemporaryDirectory() as scratch:
        hello = Path(scratch) / "hello.asl"
        hello.write_text(HELLO, encoding="utf-8")
        project = Path(scratch) / "hello.mas2j"
        project.write_text("MAS hello { agents: hello; }\n", encoding="utf-8")
        commands = {"python": [sys.executable, "-c", "pass"], OURS: [*_jacaros(), "run", str(hello)]}
        if AGENTSPEAK in engines:
            script = PROGRAMS.parent / "on_agentspeak.py"
            commands[AGENTSPEAK] = [str(PEER), str(script), f"hello={hello}"]
        if JASON in engines:
            commands[JASON] = [os.environ["JASON"], str(project), "--no-net"]
        runs: dict[str, list[dict[str, float]]] = {name: [] for name in commands}
        for _ in range(rounds):
            for name, command in commands.items():
                runs[name].append(spent(command))
        return {name: {key: min(run[key] for run in all_) for key in all_[0]} for name, all_ in runs.items()}


def spent(command: list[str]) -> dict[str, float]:
    """Return the resources used by a process and its children: ``processor``, ``wall`` (seconds) and ``megabytes``.

    Raises:
        RuntimeError: it failed.
    """
    # The compiled modules are kept between two runs, as they are for users.
    environment = {key: value for key, value in os.environ.items() if key != "PYTHONDONTWRITEBYTECODE"}
    began = time.monotonic()
    with subprocess.Popen(
        command, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, env=environment
    ) as process:
        _, status, usage = os.wait4(process.pid, 0)
        process.returncode = os.waitstatus_to_exitcode(status)
    if process.returncode:
        raise RuntimeError(f"{' '.join(command)}: exit code {process.returncode}")
    return {
        "processor": usage.ru_utime + usage.ru_stime,
        "wall": time.monotonic() - began,
        "megabytes": usage.ru_maxrss / 1024,
    }


def memory(rounds: int, cycles: int = CYCLES) -> dict[str, float]:
    """Return the megabytes of a tail recursion, and of one that ends immediately."""
    with tempfile.TemporaryDirectory() as scratch:
        program = Path(scratch) / "count.asl"
        found: dict[str, list[float]] = {"empty": [], "recursion": []}
        for _ in range(rounds):
            for name, n in (("empty", 0), ("recursion", cycles)):
                program.write_text(RECURSION.format(n=n), encoding="utf-8")
                found[name].append(spent([*_jacaros(), "run", str(program), "--clock", "fast"])["megabytes"])
        return {"cycles": cycles, **{name: median(values) for name, values in found.items()}}


def loading(rounds: int, plans: int = PLANS) -> dict[str, float]:
    """Seconds for parsing a plan, and for compiling it when it is first used: differences of whole processes."""
    with tempfile.TemporaryDirectory() as scratch:
        program = Path(scratch) / "plans.asl"
        bodies = "".join(
            f"+!do{i}(X) : X > {i} & not found(X, {i}) <- Y = X * 2 + {i}; +found(X, Y); !done(X).\n"
            for i in range(plans)
        )
        uses = "; ".join(f"!do{i}({i + 1})" for i in range(plans))
        found: dict[str, list[float]] = {"empty": [], "parsed": [], "used": []}
        for _ in range(rounds):
            for name, text in (
                ("empty", "+!go <- .stopMAS.\n"),
                ("parsed", f"+!go : true <- .stopMAS.\n+!never <- {uses}.\n+!done(_).\n{bodies}"),
                ("used", f"+!go : true <- !never; .stopMAS.\n+!never <- {uses}.\n+!done(_).\n{bodies}"),
            ):
                program.write_text("!go.\n" + text, encoding="utf-8")
                command = [*_jacaros(), "run", str(program), "--clock", "fast"]
                found[name].append(spent(command)["processor"])
        least = {name: min(values) for name, values in found.items()}
        return {
            "plans": plans,
            "parse": (least["parsed"] - least["empty"]) / plans,
            "compile": (least["used"] - least["parsed"]) / plans,
        }


def imports() -> dict[str, Any]:
    """What ``jacaros run hello.asl`` imports: how many modules, and the milliseconds of each package, largest first."""
    with tempfile.TemporaryDirectory() as scratch:
        hello = Path(scratch) / "hello.asl"
        hello.write_text(HELLO, encoding="utf-8")
        command = [sys.executable, "-X", "importtime", *_jacaros()[1:], "run", str(hello)]
        told = subprocess.run(command, capture_output=True, text=True, check=True).stderr
    packages: dict[str, float] = {}
    modules = re.findall(r"^import time: +(\d+) \| +\d+ \| +(\S+)$", told, re.MULTILINE)
    for microseconds, name in modules:
        top = name.partition(".")[0]
        kind = (
            top if top in ("jacaros", "click", "numpy", "rosbags", "rich", "ruamel") else "standard library"
        )
        packages[kind] = packages.get(kind, 0.0) + int(microseconds) / 1000
    ordered = dict(sorted(packages.items(), key=lambda item: -item[1]))
    return {"modules": len(modules), "milliseconds": ordered}


def _jacaros() -> list[str]:
    return [sys.executable, "-m", "jacaros"]
