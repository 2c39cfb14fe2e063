"""Definitions of messages, services and actions from files."""

from pathlib import Path

import pytest

from jacaros.robots.ros.errors import MessageMismatch, UnknownInterface
from jacaros.robots.ros.interfaces import split
from jacaros.robots.ros.message import constant, plain
from jacaros.robots.ros.typestore import DefinitionSchema


def write(folder: Path, name: str, text: str) -> None:
    path = folder / name
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(text, encoding="utf-8")


def test_an_action_has_three_parts_with_constants_and_other_types_of_ours(tmp_path: Path) -> None:
    write(tmp_path, "kitchen_msgs/msg/Dish.msg", "string name\nuint8 SOUP=1\nuint8 kind\n")
    write(
        tmp_path,
        "kitchen_msgs/action/Cook.action",
        "# what to cook\nDish dish\nkitchen_msgs/Dish[] more\n---\nuint16 NONE=0\nuint16 BURNT=7\nuint16 error_code\n"
        "wstring error_msg\n---\nfloat32 done 0.5\ngeometry_msgs/Pose pose\n",
    )
    schema = DefinitionSchema([tmp_path])
    factory = schema
    schema.load("kitchen_msgs/action/Cook")
    fields = schema.fields("kitchen_msgs/action/Cook_Goal")
    assert {name: str(kind) for name, kind in fields.items()} == {
        "dish": "kitchen_msgs/msg/Dish",
        "more": "kitchen_msgs/msg/Dish[]",
    }
    goal = factory.make("kitchen_msgs/action/Cook_Goal", {"dish": {"name": "stew"}, "more": [{"kind": 1}]})
    assert plain(goal)["dish"] == {"name": "stew", "kind": 0}
    result = factory.make("kitchen_msgs/action/Cook_Result", {"error_msg": "schön"})
    assert (constant(result, "BURNT"), result.error_msg, result.error_code) == (7, "schön", 0)
    assert constant(goal.dish, "SOUP") == 1
    assert plain(factory.make("kitchen_msgs/action/Cook_Feedback"))["pose"]["orientation"]["w"] == 1.0


def test_parts_are_known_without_asking_for_the_whole(tmp_path: Path) -> None:
    write(tmp_path, "kitchen_msgs/action/Wash.action", "int32 plates\n---\n---\nint32 left\n")
    write(tmp_path, "kitchen_msgs/srv/Open.srv", "string door\n---\nbool open\n")
    schema = DefinitionSchema([tmp_path])
    assert list(schema.fields("kitchen_msgs/action/Wash_Feedback")) == ["left"]
    assert list(schema.fields("kitchen_msgs/action/Wash_Result")) == []
    assert plain(schema.new("kitchen_msgs/action/Wash_Result")) == {}
    assert list(schema.fields("kitchen_msgs/srv/Open_Request")) == ["door"]
    assert list(schema.fields("kitchen_msgs/srv/Open_Response")) == ["open"]


def test_a_bounded_array_of_ours_is_checked(tmp_path: Path) -> None:
    write(tmp_path, "kitchen_msgs/msg/Order.msg", "geometry_msgs/Point where\nint32[<=3] items\n")
    schema = DefinitionSchema([tmp_path])
    made = schema.make("kitchen_msgs/msg/Order", {"where": {"x": 2}, "items": [1, 2]})
    assert (made.where.x, made.items.tolist()) == (2.0, [1, 2])
    with pytest.raises(MessageMismatch, match="4 elements"):
        schema.make("kitchen_msgs/msg/Order", {"items": [1, 2, 3, 4]})


@pytest.mark.parametrize(
    ("name", "message"),
    [
        ("no_msgs/action/Nothing", "action type no_msgs/action/Nothing is not known"),
        ("no_msgs/action/Nothing_Goal", "action type no_msgs/action/Nothing is not known"),
        ("no_msgs/srv/Nothing_Request", "service type no_msgs/srv/Nothing is not known"),
        (
            "no_msgs/msg/Nothing",
            r"message type no_msgs/msg/Nothing is not known.*interface_paths .*: no_msgs/msg/Nothing\.msg",
        ),
    ],
)
def test_unknown_types_are_reported(name: str, message: str) -> None:
    schema = DefinitionSchema()
    with pytest.raises(UnknownInterface, match=message):
        schema.load(name) if name.endswith("action/Nothing") else schema.fields(name)


def test_a_definition_that_refers_to_an_unknown_type_is_reported(tmp_path: Path) -> None:
    write(tmp_path, "kitchen_msgs/action/Serve.action", "no_msgs/Table table\n---\n---\n")
    with pytest.raises(UnknownInterface, match="no_msgs/msg/Table"):
        DefinitionSchema([tmp_path]).load("kitchen_msgs/action/Serve")


def test_a_definition_without_its_lines_is_reported(tmp_path: Path) -> None:
    write(tmp_path, "kitchen_msgs/action/Half.action", "int32 a\n---\nint32 b\n")
    with pytest.raises(
        UnknownInterface, match=r"definition of kitchen_msgs/action/Half is wrong.*two lines ---"
    ):
        DefinitionSchema([tmp_path]).load("kitchen_msgs/action/Half")
    with pytest.raises(ValueError, match="a line ---"):
        split("x/srv/X", "int32 a\n")
    assert list(split("x/action/X", "int32 a\n---\n---\n").values()) == ["int32 a\n", "\n", "\n"]
