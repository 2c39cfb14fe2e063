"""From type names to classes: paths, a project's own files, built-in names and the thesis's."""

import sys
from pathlib import Path

import pytest

from jacaros.artifacts import Artifact, Environment, InvalidArtifact, UnknownArtifactType
from jacaros.robots.artifacts.odometry import ArtOdometry, ArtOdometryOnDemand
from jacaros.robots.registry import BUILT_IN, find_type, type_finder
from jacaros.robots.ros.open import open_backend
from jacaros.runtime.clock import VirtualClock, run
from jacaros.runtime.files.python_modules import ModuleUnreadable

COUNTER = """
from jacaros.artifacts import Artifact, operation

class Counter(Artifact):
    SIZE = {size}

    def init(self) -> None:
        self.define_property("count", self.SIZE)
"""


def write(folder: Path, name: str, text: str) -> Path:
    file = folder / name
    file.parent.mkdir(parents=True, exist_ok=True)
    file.write_text(text, encoding="utf-8")
    return folder


def test_built_in_artifacts_are_found_by_bare_name_and_by_the_thesis_names() -> None:
    for name in ("ArtOdometry", "jason.architecture.ArtOdometry", "jacaros.ArtOdometry"):
        assert find_type(name) is ArtOdometry
    for name, cls in BUILT_IN.items():
        assert find_type(f"jason.architecture.{name}") is cls


def test_all_artifacts_that_the_thesis_names_are_there() -> None:
    named = (
        "ArtOdometry ArtOdometryOnDemand ArtCmdVel ArtCmdVelAndOdometry ArtCmdVelMuxAndOdometry ArtTutorial"
    )
    named += " ArtSimBattery ArtCleaning ArtBaseScan ArtSlamData ArtCmdVelMux"
    assert set(named.split()) <= set(BUILT_IN)


def test_a_dotted_python_path_is_imported() -> None:
    assert find_type("jacaros.robots.artifacts.odometry.ArtOdometryOnDemand") is ArtOdometryOnDemand


@pytest.mark.parametrize(
    "name", ["os.path", "json.JSONDecoder", "jacaros.artifacts.Artifact", "nowhere.Thing", "a b.C", ""]
)
def test_other_names_are_unknown_artifact_types(name: str) -> None:
    with pytest.raises(UnknownArtifactType):
        find_type(name)


def test_an_unknown_type_gets_a_suggestion() -> None:
    with pytest.raises(UnknownArtifactType, match="did you mean `ArtOdometry`"):
        find_type("ArtOdometri")
    with pytest.raises(UnknownArtifactType, match=r"jason\.architecture\.ArtSimBattery"):
        find_type("jason.architecture.ArtSimBatery")


def test_the_artifacts_file_of_a_project_is_searched_before_the_built_in_ones(tmp_path: Path) -> None:
    text = COUNTER.format(size=1) + "\nclass ArtOdometry(Counter):\n    pass\n"
    find = type_finder(write(tmp_path, "artifacts.py", text))
    assert find("Counter").SIZE == 1  # type: ignore[attr-defined]
    assert find("tools.Counter") is find("Counter")
    assert find("ArtOdometry") is not ArtOdometry
    assert find("jacaros.robots.artifacts.odometry.ArtOdometry") is ArtOdometry
    with pytest.raises(UnknownArtifactType, match="did you mean `Counter`"):
        find("Countre")


def test_a_class_that_is_not_an_artifact_is_reported(tmp_path: Path) -> None:
    find = type_finder(write(tmp_path, "artifacts.py", "class Counter:\n    pass\n"))
    with pytest.raises(
        UnknownArtifactType, match=r"`Counter` in artifacts\.py is not an artifact type; derive it"
    ):
        find("Counter")


def test_several_projects_with_files_of_the_same_names_live_in_one_process(tmp_path: Path) -> None:
    finders = []
    for number in (1, 2):
        folder = write(tmp_path / str(number), "magnitudes.py", f"SIZE = {number}\n")
        text = COUNTER.format(size=0) + "\nimport magnitudes\nCounter.SIZE = magnitudes.SIZE\n"
        finders.append(type_finder(write(folder, "artifacts.py", text)))
    path = list(sys.path)
    assert [find("Counter").SIZE for find in finders] == [1, 2]  # type: ignore[attr-defined]
    assert "artifacts" not in sys.modules
    assert "magnitudes" not in sys.modules
    assert sys.path == path


@pytest.mark.parametrize("entry", [None, "", "from .counter import Counter\n"])
def test_a_package_of_artifacts_is_searched_file_by_file(tmp_path: Path, entry: str | None) -> None:
    write(tmp_path, "artifacts/counter.py", "from .sizes import SIZE\n" + COUNTER.format(size="SIZE"))
    write(tmp_path, "artifacts/sizes.py", "SIZE = 7\n")
    if entry is not None:
        write(tmp_path, "artifacts/__init__.py", entry)
    found = type_finder(tmp_path)("Counter")
    assert issubclass(found, Artifact)
    assert found.SIZE == 7  # type: ignore[attr-defined]


def test_a_dotted_name_leads_to_a_module_beside_the_project(tmp_path: Path) -> None:
    (tmp_path / "board.py").write_text("from jacaros.artifacts import Artifact\nclass Board(Artifact): ...\n")
    (tmp_path / "broken.py").write_text("from jacaros.artifacts import Artifact\nclass Broken(Artifact:\n")
    find = type_finder(tmp_path)
    assert find("board.Board").__name__ == "Board"
    with pytest.raises(UnknownArtifactType):
        find("board.Table")
    with pytest.raises(InvalidArtifact, match=r"broken\.py"):
        find("broken.Broken")


def test_a_folder_without_artifacts_brings_none(tmp_path: Path) -> None:
    with pytest.raises(UnknownArtifactType):
        type_finder(tmp_path)("Counter")
    assert type_finder(None)("ArtOdometry") is ArtOdometry


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("x = 1\nclass Counter(\n", "artifacts.py:2: "),
        ("x = 1\n\ny = 1 / 0\n", "artifacts.py:3: ZeroDivisionError"),
        ("import nowhere_at_all\n", "artifacts.py:1: ModuleNotFoundError"),
        ("import helping\n", "helping.py:2: NameError"),
    ],
)
def test_a_mistake_in_the_file_is_reported_with_its_line(tmp_path: Path, text: str, message: str) -> None:
    write(tmp_path, "helping.py", "\nundefined_name\n")
    write(tmp_path, "artifacts.py", text)
    before = set(sys.modules)
    with pytest.raises(ModuleUnreadable) as wrong:
        type_finder(tmp_path)
    assert message in str(wrong.value)
    assert set(sys.modules) == before


def test_an_environment_makes_artifacts_by_name(tmp_path: Path) -> None:
    find = type_finder(write(tmp_path, "artifacts.py", COUNTER.format(size=3)))

    async def main() -> None:
        backend = open_backend("memory", clock, "test")
        await backend.start()
        environment = Environment(clock, {"ros": backend}, find)
        workspace = environment.workspace("/main")
        counter = await workspace.make_artifact("c", "Counter")
        odometry = await workspace.make_artifact("o", "jason.architecture.ArtOdometry", ["robot_0"])
        assert workspace.properties(counter)[0].values == (3,)
        assert len(workspace.properties(odometry)) == 2
        await environment.close()
        await backend.close()

    clock = VirtualClock()
    run(main, clock)
