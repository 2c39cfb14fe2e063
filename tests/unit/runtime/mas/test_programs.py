"""Agent programs of a run."""

from pathlib import Path

import pytest

from jacaros.agents.language.diagnostics import AslError
from jacaros.agents.language.nodes import Literal
from jacaros.runtime.files.python_modules import ProjectModules
from jacaros.runtime.mas.agents.programs import Programs
from jacaros.runtime.mas.agents.python_code import PythonCode
from jacaros.runtime.mas.deployment import AgentSpec


def programs(*folders: Path) -> Programs:
    return Programs(folders, lambda text: None, PythonCode(ProjectModules(*folders)))


def names(literals: object) -> list[str]:
    return [each.functor for each in literals if isinstance(each, Literal)]  # type: ignore[attr-defined]


def test_a_program_is_read_once(tmp_path: Path) -> None:
    file = tmp_path / "a.asl"
    file.write_text("p(1). !g.", encoding="utf-8")
    read = programs(tmp_path)
    assert read.load(AgentSpec("a1", file)) is read.load(AgentSpec("a2", file))


def test_beliefs_and_goals_of_the_project_are_added(tmp_path: Path) -> None:
    file = tmp_path / "a.asl"
    file.write_text("p(1). !g.", encoding="utf-8")
    program = programs(tmp_path).load(AgentSpec("a", file, beliefs="q(2), r", goals="first, second(3)"))
    assert names(program.beliefs) == ["p", "q", "r"]
    assert names(program.goals) == ["first", "second", "g"]


def test_the_errors_of_all_programs_are_reported_together(tmp_path: Path) -> None:
    specs = []
    for name in ("a", "b"):
        (tmp_path / f"{name}.asl").write_text("+!g <- .", encoding="utf-8")
        (tmp_path / f"{name}.asl").write_text("p(.", encoding="utf-8")
        specs.append(AgentSpec(name, tmp_path / f"{name}.asl"))
    with pytest.raises(AslError) as wrong:
        programs(tmp_path).load_all([*specs, AgentSpec("c", tmp_path / "missing.asl")])
    assert "a.asl:1" in str(wrong.value)
    assert "b.asl:1" in str(wrong.value)
    assert f"file not found: {tmp_path / 'missing.asl'}" in str(wrong.value)


def test_warnings_are_passed_on(tmp_path: Path) -> None:
    (tmp_path / "a.asl").write_text("+!g : p(X) <- .print(Y).", encoding="utf-8")
    told: list[str] = []
    Programs([tmp_path], told.append, PythonCode(ProjectModules(tmp_path))).read(tmp_path / "a.asl")
    assert all("warning" in line for line in told)
