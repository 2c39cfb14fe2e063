"""Says once, and loudly, which real graphs the contract suite does not run on; and what the reference says of them."""

import itertools
import re
from pathlib import Path

import pytest
from expected import CAPABILITIES
from presence import need

PAGE = Path(__file__).parents[2] / "docs" / "reference" / "middleware.md"


@pytest.mark.parametrize("kind", ["ros1", "ros2", "rosbridge", "mqtt"])
def test_the_real_graph_is_there(kind: str, request: pytest.FixtureRequest) -> None:
    need(kind, request.config)


def test_the_reference_has_the_same_table_of_capabilities() -> None:
    rows = [
        [cell.strip() for cell in line.strip("|").split("|")]
        for line in PAGE.read_text(encoding="utf-8").splitlines()
        if line.startswith("|")
    ]
    [head] = [row for row in rows if row[0] == "capability"]
    rows = rows[rows.index(head) + 2 :]
    one_for_all = {
        kind: able for kind, able in CAPABILITIES.items() if not kind.startswith(("rosbridge-", "mqtt"))
    }
    # Both flavours of the bridge, whichever side the peers are on, except the side that is not a bridge.
    for flavour, words in (("rosbridge-ros1", {"yes"}), ("rosbridge-ros2", {"yes", "of ROS 2"})):
        told: dict[str, set[str]] = {kind.strip("`"): set() for kind in head[1:-1]}
        for row in itertools.takewhile(lambda row: len(row) == len(head), rows):
            for kind, cell in zip(told, row[1:-1], strict=True):
                assert cell in ("yes", "") or (kind == "rosbridge" and cell == "of ROS 2")
                if cell in words:
                    told[kind] |= set(re.findall(r"`([^`]+)`", row[0]))
        assert told == {**one_for_all, "rosbridge": CAPABILITIES[flavour]}
