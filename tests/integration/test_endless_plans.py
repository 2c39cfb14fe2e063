"""A plan that never ends does not block the other agents, the timers or the world."""

import subprocess
import sys
from pathlib import Path

import pytest

from jacaros.testing import run_project

ENDLESS = {
    "while": "!g. +!g <- while (true) { }.",
    "work": "n(0). !g. +!g <- while (n(X)) { -+n(X + 1) }.",
    "tail_call": "!g. +!g <- !g.",
    "new_intentions": "!g. +!g <- !!g.",
    "events": "n(0). +n(X) <- -+n(X + 1).",
    "failures": "!g. +!g <- .fail. -!g <- !g.",
    "tests": "!g. +!g <- ?h; !g. +?h.",
    "atomic": "!g. @a[atomic] +!g <- while (true) { }.",
    "messages": "!g. +!g <- .my_name(Me); .send(Me, achieve, g).",
    "thousand": "!g. +!g <- for (.range(I, 1, 1000)) { !!h }. +!h <- while (true) { }.",
}
"""Programs that always have something to do."""

PROJECT = """
MAS shared {
    environment: jacaros.Environment
    agents: mad #3; clerk; driver;
}
"""
CLERK = """
!wait(4).
+!wait(0) <- .send(driver, askOne, moving(_), _); .print(waited); .stopMAS.
+!wait(N) <- .wait(25); !wait(N - 1).
"""
DRIVER = """
!go.
+!go <- makeArtifact("motion", "ArtCmdVelAndOdometry", [], M); focus(M); +moving(yes); moveForward(1000).
"""


@pytest.mark.slow
@pytest.mark.parametrize(
    ("kind", "fast"),
    [*((kind, False) for kind in ENDLESS), *((kind, True) for kind in ("while", "tail_call", "events"))],
)
def test_an_endless_plan_does_not_block_other_agents(tmp_path: Path, kind: str, fast: bool) -> None:
    for name, text in {"mad": ENDLESS[kind], "clerk": CLERK, "driver": DRIVER}.items():
        (tmp_path / f"{name}.asl").write_text(text, encoding="utf-8")
    (tmp_path / "shared.mas2j").write_text(PROJECT, encoding="utf-8")
    result = run_project(tmp_path / "shared.mas2j", fast=fast, seconds=600)
    assert result.of("clerk") == ["waited"]
    assert result.ground_truth.latest().x > 0


def test_a_busy_run_leaves_the_interpreter_to_other_threads_within_a_millisecond(tmp_path: Path) -> None:
    (tmp_path / "bob.asl").write_text("!g. +!g <- .stopMAS.", encoding="utf-8")
    command = (
        "import sys; from jacaros.runtime.mas.console import StandardConsole; "
        "from jacaros.runtime.mas.launch import launch; "
        "from jacaros.runtime.mas.options import RunOptions; "
        "launch('bob.asl', RunOptions(), StandardConsole(), lambda mas: print(sys.getswitchinterval()))"
    )
    done = subprocess.run(
        [sys.executable, "-c", command], cwd=tmp_path, capture_output=True, text=True, check=True
    )
    assert float(done.stdout) <= 0.001


def test_a_run_inside_a_program_leaves_its_switch_interval_alone(tmp_path: Path) -> None:
    (tmp_path / "bob.asl").write_text("!g. +!g <- .stopMAS.", encoding="utf-8")
    (tmp_path / "host.py").write_text(
        "import sys\nimport jacaros\nfrom jacaros.testing import run_project\n\n"
        "async def main():\n"
        "    async with jacaros.Mas() as mas:\n"
        "        await mas.add_agent('bob', '+!g.').achieve('g')\n\n"
        "sys.setswitchinterval(0.25)\n"
        "run_project('bob.asl')\n"
        "jacaros.run(main())\n"
        "print(sys.getswitchinterval())\n",
        encoding="utf-8",
    )
    done = subprocess.run(
        [sys.executable, "host.py"], cwd=tmp_path, capture_output=True, text=True, check=True
    )
    assert done.stdout == "0.25\n"
