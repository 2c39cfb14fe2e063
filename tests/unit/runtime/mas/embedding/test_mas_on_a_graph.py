"""A system in a Python program and its ROS graph: options of `Mas`, as on the command line."""

from pathlib import Path
from typing import Any

import pytest
from embedding_lab import run

from jacaros import Mas
from jacaros.runtime.errors import UsageError
from jacaros.runtime.mas.deployment import ProjectError


async def test_a_virtual_clock_excludes_a_real_graph() -> None:
    with pytest.raises(UsageError, match="--clock fast excludes"):
        async with Mas(ros="ros1"):
            pytest.fail("it began")


def test_a_mapping_and_other_names_are_given_as_on_the_command_line(tmp_path: Path) -> None:
    mapping = tmp_path / "wheels.yaml"
    mapping.write_text(
        "properties:\n  odom: {topic: odom, type: nav_msgs/msg/Odometry, fields: [pose.pose.position.x]}\n"
    )
    lines: list[str] = []

    async def test(mas: Mas) -> None:
        bob = mas.add_agent("bob", "+!go <- .wait(odom(X)); .print(X).", focus=["wheels"])
        await bob.achieve("go")
        assert mas.ros.resolve("odom") == "/odom"
        assert mas.ros.resolve("scan") == "/other/scan"

    other = {"remap": {"/other/odom": "/odom"}, "namespace": "other"}
    run(test, lines, [], mappings=[mapping], world="empty", **other)
    assert lines == ["[bob] 0"]


@pytest.mark.parametrize(
    ("options", "text"),
    [
        ({"domain_id": 3}, "--domain-id needs --ros ros2"),
    ],
)
def test_options_of_the_graph_are_checked_immediately(options: dict[str, Any], text: str) -> None:
    with pytest.raises(UsageError, match=text):
        Mas(**options)


def test_a_missing_mapping_is_reported_immediately() -> None:
    with pytest.raises(ProjectError, match=r"mapping file not found: nowhere\.yaml"):
        Mas(mappings=["nowhere.yaml"])
