"""Types of one's own: folders with definitions that a mapping file names."""

from pathlib import Path
from typing import Any

import pytest
from mapped_lab import settle
from robot_lab import Lab

from jacaros.artifacts import Out
from jacaros.robots.mapping.artifact import mapped_type
from jacaros.robots.mapping.file import MappingError, load_mapping
from jacaros.runtime.cli.main import call

pytestmark = pytest.mark.world("empty")

SHELF = """
interfaces: types
properties:
  shelf: {topic: shelf, type: my_store_msgs/msg/Shelf, fields: [label, {path: state, as: name}, "sizes[*].x"]}
operations:
  clear: {parameters: [label], service: clear, type: my_store_msgs/srv/Clear, request: {label: $label}, outputs: [left]}
"""


@pytest.fixture
def store(tmp_path: Path) -> Path:
    """A mapping file and the definitions that it needs."""
    package = tmp_path / "types" / "my_store_msgs"
    (package / "msg").mkdir(parents=True)
    (package / "srv").mkdir()
    shelf = (
        "uint8 STATE_FULL=1\nuint8 STATE_EMPTY=2\nstring label\nuint8 state\ngeometry_msgs/Vector3[] sizes\n"
    )
    (package / "msg" / "Shelf.msg").write_text(shelf)
    (package / "srv" / "Clear.srv").write_text("string label\n---\nint32 left\n")
    (tmp_path / "store.yaml").write_text(SHELF)
    return tmp_path / "store.yaml"


async def test_types_of_ones_own_are_shown_and_called(lab: Lab, store: Path) -> None:
    artifact = await lab.make(mapped_type(load_mapping(store), "store"))
    seen = lab.watch(artifact)
    shelves = lab.backend.publisher("shelf", "my_store_msgs/msg/Shelf")
    shelves.publish({"label": "top", "state": 2, "sizes": [{"x": 1.0}, {"x": 2.5}]})
    await settle()
    assert [tuple(map(str, values)) for values in seen.holds("shelf")] == [("top", "empty", "[1.0, 2.5]")]

    asked: list[Any] = []
    lab.backend.service("clear", "my_store_msgs/srv/Clear", lambda request: asked.append(request.label))
    await lab.do(artifact, "clear", "top", Out())
    assert asked == ["top"]


def test_the_check_knows_them(store: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert call(["check", "--strict", str(store)]) == 0
    store.write_text(SHELF.replace("[label,", "[lable,"))
    assert call(["check", str(store)]) == 1
    assert "did you mean `label`" in capsys.readouterr().out


def test_they_count_for_all_artifacts_of_a_file(store: Path) -> None:
    shelf = "{topic: s, type: my_store_msgs/msg/Shelf}"
    store.write_text(f"interfaces: [types]\nartifacts:\n  a: {{properties: {{p: {shelf}}}}}\n  b: {{}}\n")
    parts = load_mapping(store).artifacts
    assert [len(part.interfaces) for part in parts.values()] == [1, 1]


def test_a_folder_that_is_not_there(store: Path) -> None:
    store.write_text("interfaces: [types, typos, 5]\nproperties: {}\n")
    with pytest.raises(MappingError) as caught:
        load_mapping(store)
    assert [(each.line, each.message) for each in caught.value.problems] == [
        (1, "folder not found: `typos`"),
        (1, "item 3 of 'interfaces' must be a text, not 5"),
    ]
