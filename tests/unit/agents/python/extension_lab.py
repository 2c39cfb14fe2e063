"""Projects with Python code of their own, run on the virtual clock."""

from pathlib import Path
from textwrap import dedent

from jacaros.testing import RunResult, run_project

HEAD = "from collections.abc import Iterator\nfrom jacaros import *\n"
"""The first two lines of each module ``my.py``."""


def write(folder: Path, **files: str) -> Path:
    """Write files into a folder: ``my="..."`` is ``my.py``, ``t_asl="..."`` is ``t.asl``, ``my__a`` is ``my/a.py``."""
    for key, text in files.items():
        name = key
        for suffix in ("asl", "mas2j", "jcm"):
            if key.endswith(f"_{suffix}"):
                name = f"{key.removesuffix(f'_{suffix}')}.{suffix}"
        path = folder / (name if "." in name else f"{name.replace('__', '/', 1)}.py")
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(dedent(text), encoding="utf-8")
    return folder


def run(folder: Path, program: str, python: str = "", seconds: float | None = None) -> RunResult:
    """Run a program ``t.asl`` beside a module ``my.py``, whose first two lines are `HEAD`."""
    write(folder, t_asl=program)
    if python:
        write(folder, my=HEAD + dedent(python))
    return run_project(folder / "t.asl", until_idle=True, seconds=seconds)


def said(folder: Path, program: str, python: str = "") -> list[str]:
    """Return the output of a program's agent; nothing may be logged."""
    result = run(folder, program, python)
    assert result.errors == []
    return result.of("t")


def assert_output(folder: Path, case: str, output: list[str]) -> None:
    """Compare a run of Python code and, after ``---``, a program with what an agent prints.

    What begins with ``! `` is part of an error; ``FOLDER`` is the folder. The agent is of the class ``Mine``, if there is
    one.
    """
    python, program = case.replace("FOLDER", str(folder)).split("---\n")
    write(folder, t_asl=program, my=HEAD + python)
    agent = "t agentClass my.Mine" if "class Mine" in python else "t"
    (folder / "sys.mas2j").write_text(f"MAS sys {{ agents: {agent}; }}")
    result = run_project(folder / "sys.mas2j", until_idle=True)
    wanted = [line.replace("FOLDER", str(folder)) for line in output]
    errors = [line.removeprefix("! ") for line in wanted if line.startswith("! ")]
    assert result.of("t") == [line for line in wanted if not line.startswith("! ")]
    assert [part in error for part, error in zip(errors, result.errors, strict=True)] == [True] * len(
        errors
    ), result.errors
