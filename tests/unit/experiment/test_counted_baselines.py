"""The files of baselines that the experiment counts, and the chart of both sides."""

from pathlib import Path

import py_trees
import pytest

from counting import Group, MetricsError, ProgramMetrics, measure, measure_beside

BASELINE = {
    "patrol.py": "import rclpy\nimport steps\nfrom py_trees.common import Status\n\nmain = 1\n",
    "steps.py": "from .inner import deep\n",
    "inner/__init__.py": "from ..far import x\n",
    "inner/deep.py": "y = 1\n",
    "far.py": "z = 1\n",
    "other.py": "w = 1\n",
}


@pytest.fixture
def agent(tmp_path: Path) -> Path:
    """A folder with an agent, and beside it the folder of its baseline."""
    for name, text in {"agent/a.asl": "!go.\n+!go.\n", **BASELINE}.items():
        path = tmp_path / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text)
    return tmp_path / "agent"


def files(program: ProgramMetrics, group: Group, root: Path) -> list[str]:
    return [file.path.resolve().relative_to(root).as_posix() for file in program.files[group]]


def test_a_baseline_is_a_file_with_what_it_imports(agent: Path) -> None:
    (program,) = measure_beside([agent], [[agent.parent / "patrol.py"]])
    imported = ["far.py", "inner/__init__.py", "inner/deep.py", "patrol.py", "steps.py"]
    assert files(program, Group.BASELINE, agent.parent) == imported
    (alone,) = measure([agent])
    assert program.total == alone.total, "the total leaves the baseline out"
    assert program.counts(Group.AGENTS) == alone.counts("agents")


def test_libraries_of_a_baseline_are_counted_separately(agent: Path) -> None:
    (program,) = measure_beside([agent], [[agent.parent / "patrol.py"]])
    found = files(program, Group.BASELINE_LIBRARY, Path(py_trees.__file__).resolve().parent)
    assert {"__init__.py", "common.py", "composites.py"} <= set(found)


def test_wrong_and_missing_baselines_are_reported_in_one_pass(agent: Path) -> None:
    (agent.parent / "wrong.py").write_text("x = \n")
    with pytest.raises(MetricsError) as wrong:
        measure_beside([agent], [[agent.parent / "wrong.py"], [agent.parent / "none.py"]])
    assert [each.message for each in wrong.value.diagnostics] == [
        "not Python: invalid syntax",
        f"file not found: {agent.parent}/none.py",
    ]
    with pytest.raises(ValueError, match="zip"):
        measure_beside([agent, agent], [[agent.parent / "other.py"]])
