"""The workflows of the public CI: every command in them exists here."""

import importlib.util
import re
import shlex
import tomllib
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
from ruamel.yaml import YAML

ROOT = Path(__file__).parents[2]
WORKFLOWS = sorted((ROOT / ".github" / "workflows").glob("*.yml"))
PROJECT: dict[str, Any] = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))
SYSTEM = {"apt-get"}
"""Programs that a runner has."""


def read(path: Path) -> dict[str, Any]:
    workflow: dict[str, Any] = YAML(typ="safe").load(path.read_text(encoding="utf-8"))
    return workflow


def steps(path: Path) -> Iterator[dict[str, Any]]:
    for job in read(path)["jobs"].values():
        yield from job["steps"]


def commands() -> list[list[str]]:
    return [
        shlex.split(command)
        for path in WORKFLOWS
        for step in steps(path)
        if "run" in step
        for line in step["run"].splitlines()
        for command in line.split("&&")
    ]


def test_every_system_runs_with_every_python() -> None:
    job = read(ROOT / ".github" / "workflows" / "ci.yml")["jobs"]["systems"]
    matrix = job["strategy"]["matrix"]
    assert matrix["os"] == ["ubuntu-latest", "windows-latest", "macos-latest"]
    assert matrix["python"] == ["3.11", "3.12", "3.13", "3.14"]
    assert PROJECT["project"]["requires-python"] == f">={matrix['python'][0]}"


@pytest.mark.parametrize("path", WORKFLOWS, ids=lambda path: path.name)
def test_actions_are_pinned_to_a_major_version_and_nothing_can_write(path: Path) -> None:
    used = [step["uses"] for step in steps(path) if "uses" in step]
    assert used
    assert [each for each in used if not re.fullmatch(r"actions/[a-z-]+@v\d+", each)] == []
    assert read(path)["permissions"] == {"contents": "read"}


@pytest.mark.parametrize("path", WORKFLOWS, ids=lambda path: path.name)
def test_jobs_need_jobs_that_exist(path: Path) -> None:
    jobs = read(path)["jobs"]
    assert {need for job in jobs.values() for need in [job.get("needs")] if need} <= set(jobs)


@pytest.mark.parametrize("command", commands(), ids=" ".join)
def test_a_command_exists(command: list[str]) -> None:
    if command[:2] == ["python", "-m"]:
        check_module(*command[2:])
    elif command[0].startswith("."):
        assert (ROOT / command[0]).stat().st_mode & 0o111
    else:
        assert command[0] in SYSTEM


def check_module(module: str, *arguments: str) -> None:
    assert importlib.util.find_spec(module) is not None
    if module == "pip":
        extras = re.findall(r"\[([\w,-]+)\]$", arguments[-1])
        known = PROJECT["project"]["optional-dependencies"]
        assert [each for extra in extras for each in extra.split(",") if each not in known] == []
    if module == "pytest":
        known = {each.partition(":")[0] for each in PROJECT["tool"]["pytest"]["ini_options"]["markers"]}
        markers = set(re.findall(r"\w+", arguments[arguments.index("-m") + 1])) - {"not", "and", "or"}
        assert markers <= known
    for argument in arguments:
        if argument.startswith(("tests/", "examples")):
            assert (ROOT / argument).is_dir()


def test_the_workflow_runs_the_programs_of_the_suite() -> None:
    """What the parts of tools/test_all.py run on any system runs on every system."""
    suite = (ROOT / "tools" / "test_all.py").read_text(encoding="utf-8")
    for command in commands():
        if command[:3] == ["python", "-m", "pytest"]:
            assert f'"{command[4]}"' in suite, command
            assert command[6] in suite, command
    assert [".ci/run"] in commands()
    assert "make test" in (ROOT / ".ci" / "run").read_text(encoding="utf-8")
