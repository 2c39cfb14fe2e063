"""The server reports about open files exactly what ``jacaros check`` reports about their folder."""

from collections.abc import Callable
from pathlib import Path

import pytest

from jacaros.agents.language.diagnostics import Diagnostic
from jacaros.editors.lsp.projects import Projects
from jacaros.runtime.mas.checks.files import check_files

ROOT = Path(__file__).parents[4]
FOLDERS = sorted(
    each for folder in ("examples", "tests/mistakes") for each in (ROOT / folder).iterdir() if each.is_dir()
)
KINDS = {".asl", ".jcm", ".mas2j", ".yaml"}

Write = Callable[[str, str], Path]


@pytest.fixture
def write(tmp_path: Path) -> Write:
    def write(name: str, text: str) -> Path:
        path = tmp_path / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text, encoding="utf-8")
        return path

    return write


def messages(found: list[Diagnostic]) -> list[tuple[str, str]]:
    return sorted((each.code, each.message) for each in found)


def by_check(folder: Path, file: Path) -> list[tuple[str, str]]:
    found = check_files([folder]).diagnostics
    return messages([each for each in found if each.span and Path(each.span.file.name).resolve() == file])


@pytest.mark.parametrize("folder", FOLDERS, ids=lambda folder: folder.name)
def test_reports_what_check_reports(folder: Path) -> None:
    files = sorted(each for each in folder.rglob("*") if each.suffix in KINDS)
    expected = {file: by_check(folder, file) for file in files}
    texts = {file: file.read_text(encoding="utf-8") for file in files}
    projects = Projects([folder])
    projects.update(files, texts)
    for file in files:
        placed = [each for each in projects.diagnostics_of(file) if each.span is not None]
        assert messages(placed) == expected[file], file


def test_checks_the_text_of_the_editor(write: Write) -> None:
    path = write("robot.asl", "!start. +!start.")
    found = Projects([path.parent]).update([path], {path: "!start."})
    assert [each.code for each in found[path]] == ["unknown-goal"]


def test_a_file_that_is_not_saved_yet(write: Write) -> None:
    project = write("p.jcm", "mas p { agent a : robot.asl }")
    path = project.parent / "robot.asl"
    found = Projects([path.parent]).update([path], {path: "!start."})
    assert [each.code for each in found[path]] == ["unknown-goal"]
    assert not found.get(project)


def test_reports_to_the_file_that_an_edit_concerns(write: Write) -> None:
    """The included plan is missing: the warning is in the program that posts the goal."""
    program = write("robot.asl", '{ include("moves.asl") } !go.')
    included = write("moves.asl", "+!go.")
    projects = Projects([program.parent])
    assert not any(projects.update([included], {included: "+!go."}).values())
    found = projects.update([included], {included: "+!going."})
    assert [each.code for each in found[program]] == ["unknown-goal"]
    assert not any(projects.update([included], {included: "+!go."}).values())


def test_a_program_that_leaves_its_project_is_checked_alone(write: Write) -> None:
    project = write("p.jcm", "mas p { agent a : robot.asl }")
    program = write("robot.asl", "!start.")
    projects = Projects([program.parent])
    texts = {program: "!start.", project: project.read_text()}
    projects.update([program, project], texts)
    assert [each.path for each in projects.units_of(program)] == [project]
    texts[project] = "mas p { agent a : other.asl }"
    projects.update([project], texts)
    projects.update([program], texts)
    assert [each.path for each in projects.units_of(program)] == [program]


def test_closed_files_are_forgotten(write: Write) -> None:
    path = write("robot.asl", "!start.")
    projects = Projects([path.parent])
    assert projects.update([path], {path: "!start."})[path]
    assert projects.update([path], {}) == {path: []}
    assert projects.units_of(path) == []


def test_yaml_files_of_others_are_not_reported(write: Write) -> None:
    path = write("compose.yaml", "services: {a: {image: b}}")
    assert not any(Projects([path.parent]).update([path], {path: path.read_text()}).values())


def test_python_of_a_project_is_not_run(write: Write) -> None:
    code = """
from pathlib import Path
Path(__file__).with_name("ran").touch()
from jacaros.artifacts import Artifact, operation
class Lamp(Artifact):
    @operation
    def light(self, colour: str) -> None: ...
"""
    folder = write("artifacts.py", code).parent
    write("p.jcm", "mas p { agent a : a.asl { focus: w.lamp } workspace w { artifact lamp: Lamp() } }")
    path = write("a.asl", "!s. +!s <- lihgt(red).")
    projects = Projects([folder])
    found = projects.update([path], {path: path.read_text()})
    projects.index({})
    assert [each.help for each in found[path]] == ["did you mean `light`?"]
    assert not (folder / "ran").exists()
