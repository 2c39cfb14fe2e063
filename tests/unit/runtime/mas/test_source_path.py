"""Where programs and included files are found."""

from pathlib import Path

import pytest

from jacaros.runtime.mas.agents.programs import SourcePath, source_folders
from jacaros.runtime.mas.launch import load_deployment


def write(folder: Path, *names: str, text: str = "p.") -> None:
    for name in names:
        (folder / name).parent.mkdir(parents=True, exist_ok=True)
        (folder / name).write_text(text, encoding="utf-8")


def test_a_program_is_found_with_and_without_its_suffix(tmp_path: Path) -> None:
    write(tmp_path, "agt/bob.asl")
    path = SourcePath((tmp_path, tmp_path / "agt"))
    found = {path.find(name) for name in ("bob", "bob.asl", "file:bob.asl")}
    assert found == {tmp_path / "agt" / "bob.asl"}


def test_a_missing_program_names_all_folders_that_were_searched(tmp_path: Path) -> None:
    path = SourcePath((tmp_path, tmp_path / "agt", tmp_path / "agt" / ".." / "agt"))
    with pytest.raises(FileNotFoundError, match=f"^expected in {tmp_path}, {tmp_path / 'agt'}$"):
        path.find("ann")


def test_an_included_file_beside_the_including_one_comes_first(tmp_path: Path) -> None:
    write(tmp_path, "x.asl", text="// outer")
    write(tmp_path, "inc/x.asl", text="// inner")
    path = SourcePath((tmp_path,))
    inner = (tmp_path / "inc" / "x.asl").as_posix()
    assert path.include("x.asl", str(tmp_path / "inc" / "a.asl")) == (inner, "// inner")
    assert path.include("x.asl", "elsewhere/a.asl")[0] == (tmp_path / "x.asl").as_posix()
    with pytest.raises(FileNotFoundError, match="inc, "):
        path.include("y.asl", str(tmp_path / "inc" / "a.asl"))


def test_files_of_the_library_are_found_by_their_path_and_the_projects_own_come_first(tmp_path: Path) -> None:
    path = SourcePath((tmp_path,))
    shipped = path.find("$jacaros/mock_agent.asl")
    assert shipped == path.find("mock_agent.asl") == path.find("$jasonJar/test/jason/inc/mock_agent.asl")
    write(tmp_path, "mock_agent.asl")
    assert path.find("mock_agent.asl") == tmp_path / "mock_agent.asl"
    with pytest.raises(FileNotFoundError, match=r"the library has artifacts\.asl, "):
        path.find("$jacaros/nothing.asl")


@pytest.mark.parametrize(
    ("project", "text"),
    [
        ("src/mas/house.mas2j", "MAS house { agents: ann; }"),
        ("src/mas/house.mas2j", 'MAS house { agents: ann; aslSourcePath: "src/agt"; }'),
        ("src/jcm/house.jcm", "mas house { agent ann }"),
        ("src/jcm/house.jcm", "mas house { agent ann asl-path: src/agt }"),
        ("src/jcm/house.jcm", "mas house { agent ann: ann.asl }"),
    ],
)
def test_a_project_below_the_working_folder_uses_the_folders_below_it(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, project: str, text: str
) -> None:
    write(tmp_path, "src/agt/ann.asl")
    write(tmp_path, project, text=text)
    monkeypatch.chdir(tmp_path)
    (ann,) = load_deployment(project).agents
    assert ann.source_path == Path("src/agt/ann.asl")


def test_a_file_in_a_folder_of_strategies_includes_files_of_the_source_folder(tmp_path, monkeypatch):
    write(tmp_path, "src/agt/tasks/x.asl", "src/agt/strategies/s.asl")
    monkeypatch.chdir(tmp_path)
    path = SourcePath(source_folders(Path("src/agt/strategies")))
    found, _ = path.include("tasks/x.asl", "src/agt/strategies/s.asl")
    assert found == "src/agt/tasks/x.asl"


def test_a_project_comes_before_the_working_folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    write(tmp_path, "here/agents/ann.asl", "there/agents/ann.asl")
    monkeypatch.chdir(tmp_path / "here")
    found = SourcePath(source_folders(tmp_path / "there")).find("ann")
    assert found == tmp_path / "there" / "agents" / "ann.asl"
