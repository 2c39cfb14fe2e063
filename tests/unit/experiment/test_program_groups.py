"""The files of a folder that are counted, and their groups."""

from collections.abc import Mapping
from pathlib import Path

import pytest

import jacaros
from counting import Group, MetricsError, ProgramMetrics, measure

PACKAGE = Path(jacaros.__file__).parent


def write(folder: Path, files: Mapping[str, str]) -> None:
    for name, text in files.items():
        path = folder / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text)


def measured(folder: Path, files: Mapping[str, str]) -> ProgramMetrics:
    write(folder, files)
    return measure([folder])[0]


def grouped(program: ProgramMetrics, root: Path) -> dict[str, list[str]]:
    """Names of files by group, without library code."""
    return {
        str(group): [file.path.resolve().relative_to(root).as_posix() for file in files]
        for group, files in program.files.items()
        if files and group != Group.LIBRARY
    }


PROGRAM = {
    "garden.jcm": 'mas garden { agent ann : ann.asl agent bob : bob.py world: "../beds.yaml"\n'
    "  asl-path: ., shared }\n",
    "ann.asl": '{ include("watering.asl") }\n!go.\n+!go <- !water; tools.beep.\n',
    "shared/watering.asl": "+!water.\n",
    "bob.py": "from jacaros.agents.python import PythonAgent as Agent\n\nclass bob(Agent): pass\n",
    "carl.py": "import jacaros\n\nclass Carl(jacaros.PythonAgent): pass\n",
    "dora.asl": "!go.\n+!go.\n",
    "artifacts.py": "LIMIT = 1\n",
    "tools.py": "def beep(): pass\n",
    "valves.yaml": "operations:\n  open: {publish: valve, type: std_msgs/msg/Empty}\n",
    "slippery.yaml": "faults:\n  slippery: {kind: wheel_slip, share: 0.3, at: 0.5, for: 3}\n",
    "garden_launch.py": "from launch import LaunchDescription\n\ndef generate_launch_description(): ...\n",
    "parameters.yaml": "node:\n  ros__parameters: {rate: 10}\n",
    "README.md": "# A garden\n",
    "check.py": "from jacaros.testing import judge\n",
    "test_tools.py": "import pytest\n",
    "ann_test.asl": '{ include("$jacaros/tester_agent.asl") }\n{ include("ann.asl") }\n@t[test] +!test_go.\n',
    "try.jcm": "mas try { agent ann_test : ann_test.asl }\n",
    "tests/fakes.asl": "+!fake.\n",
    "deep/tests/fakes.py": "x = 1\n",
    ".hidden/notes.asl": "!go.\n",
    "build/copy.asl": "!go.\n",
}
GROUPS = {
    "agents": [
        *("garden/ann.asl", "garden/bob.py", "garden/carl.py", "garden/dora.asl"),
        "garden/shared/watering.asl",
    ],
    "artifacts": ["garden/artifacts.py", "garden/tools.py", "garden/valves.yaml"],
    "projects": ["garden/garden.jcm", "garden/garden_launch.py"],
    "worlds": ["beds.yaml", "garden/slippery.yaml"],
}


def test_files_are_grouped_by_role(tmp_path: Path) -> None:
    write(tmp_path, {"beds.yaml": "robots: [{name: mower}]\n"})
    program = measured(tmp_path / "garden", PROGRAM)
    assert grouped(program, tmp_path) == GROUPS
    assert program.name == "garden"


AGENT = "!go.\n+!go.\n"


def library(program: ProgramMetrics) -> set[str]:
    return {file.path.resolve().relative_to(PACKAGE).as_posix() for file in program.files[Group.LIBRARY]}


def test_plans_of_the_package_are_library_code(tmp_path: Path) -> None:
    program = measured(tmp_path, {"a.asl": f'{{ include("$jacaros/navigation.asl") }}\n{AGENT}'})
    assert library(program) == {f"agents/language/library/{name}.asl" for name in ("help", "navigation")}
    assert program.counts(Group.AGENTS).lines == 3


@pytest.mark.parametrize(
    "files",
    [
        {"a.asl": '!go.\n+!go <- makeArtifact("b", "ArtSimBattery", [], Id).\n'},
        {"a.asl": AGENT, "a.jcm": "mas a { agent a workspace w { artifact b : ArtSimBattery } }\n"},
        {"a.asl": AGENT, "artifacts.py": "from jacaros.robots.artifacts.battery import ArtSimBattery\n"},
    ],
)
def test_artifacts_of_the_package_are_library_code_with_what_they_import(tmp_path: Path, files) -> None:
    found = library(measured(tmp_path, files))
    assert {
        "robots/artifacts/battery.py",
        "robots/kit/ros_artifact.py",
        "robots/kit/__init__.py",
    } <= found
    assert not {"robots/artifacts/velocity.py", "robots/registry.py"} & found
    assert all(name.startswith(("robots/", "artifacts/")) for name in found), "the platform does not count"


def test_a_shipped_mapping_is_library_code_with_its_reader(tmp_path: Path) -> None:
    project = 'mas a { agent a mapping: "turtlebot4.yaml" world: "house" }\n'
    found = library(measured(tmp_path, {"a.asl": AGENT, "a.jcm": project}))
    assert {"robots/mappings/turtlebot4.yaml", "robots/mapping/artifact.py"} <= found
    assert not any(name.endswith("nav2.yaml") or name.startswith("robots/world/") for name in found)


def test_a_library_that_is_not_installed_is_reported(tmp_path: Path) -> None:
    write(tmp_path, {"a.asl": AGENT, "artifacts.py": "import no_such_library.trees\n"})
    with pytest.raises(MetricsError, match="cannot be counted: `no_such_library`"):
        measure([tmp_path], libraries=["no_such_library"])


def test_programs_in_folders_with_equal_names_are_named_by_path(tmp_path: Path) -> None:
    folders = [tmp_path / "a" / "robot", tmp_path / "b" / "robot", tmp_path / "c"]
    for folder in folders:
        write(folder, {"robot.asl": AGENT})
    assert [each.name for each in measure(folders)] == [str(folders[0]), str(folders[1]), "c"]


def test_an_included_file_is_read_in_the_context_of_its_program(tmp_path: Path) -> None:
    """Alone, the program has an error: only the project knows the folder of its included file."""
    files = {
        "a.jcm": "mas a { agent a asl-path: shared, parts }\n",
        "shared/a.asl": '{ include("b.asl") }\n!go.\n+!go.\n',
        "parts/b.asl": '{ include("c.asl") }\n',
        "shared/c.asl": "+!c.\n",
    }
    program = measured(tmp_path, files)
    assert grouped(program, tmp_path)["agents"] == ["parts/b.asl", "shared/a.asl", "shared/c.asl"]


def test_files_that_include_each_other_are_reported(tmp_path: Path) -> None:
    write(tmp_path, {"a.asl": '{ include("b.asl") }\n', "b.asl": '{ include("a.asl") }\n'})
    with pytest.raises(MetricsError) as wrong:
        measure([tmp_path])
    assert [each.code for each in wrong.value.diagnostics] == ["include-circle"] * 2


def test_imports_for_type_checkers_do_not_count_as_library_code(tmp_path: Path) -> None:
    checked = "if TYPE_CHECKING:\n    import py_trees\nelse:\n    import json\n"
    text = f"from typing import TYPE_CHECKING\n{checked}"
    program = measured(tmp_path, {"a.asl": AGENT, "artifacts.py": text})
    assert program.files[Group.LIBRARY] == ()
    late = "def late():\n    import jacaros.artifacts.behaviour_trees.act\n"
    program = measured(tmp_path, {"artifacts.py": late})
    found = {file.path.name for file in program.files[Group.LIBRARY]}
    assert {"act.py", "behaviour.py"} <= found, "those of jacaros and of py_trees"
