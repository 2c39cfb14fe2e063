"""On ROS 2 without ``nav2_msgs``, the baselines import what they need of it from the stand-ins."""

import ast
from collections.abc import Iterator
from pathlib import Path

import pytest

from jacaros.robots.ros.interfaces import origin

EXPERIMENT = Path(__file__).parents[3] / "experiment"


def imported(path: Path) -> Iterator[tuple[str, str]]:
    """Yield what a file imports by ``from MODULE import NAME``."""
    for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
        if isinstance(node, ast.ImportFrom):
            yield from ((node.module or "", alias.name) for alias in node.names)


@pytest.mark.parametrize("kind", ["action", "srv"])
def test_stand_ins_have_all_that_baselines_import_of_nav2(kind: str) -> None:
    baselines = sorted((EXPERIMENT / "baseline").glob("*.py"))
    wanted = {name for path in baselines for module, name in imported(path) if module == f"nav2_msgs.{kind}"}
    stand_in = EXPERIMENT / "stand_ins" / "nav2_msgs" / f"{kind}.py"
    offered = {name for module, name in imported(stand_in) if module == f"jacaros_interfaces.{kind}"}
    assert wanted == offered
    assert {origin(kind, name) for name in offered} == {"nav2_msgs"}, "the package has substitutes for them"
