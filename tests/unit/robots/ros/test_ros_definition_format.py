"""Message definitions: the format, and those of ROS 2 Jazzy that the package brings along."""

import runpy
from pathlib import Path

import pytest
from rosbags.typesys import Stores, get_types_from_msg, get_typestore

from jacaros.robots.ros.fields import parse_definition
from jacaros.robots.ros.typestore import DefinitionSchema, stored_types

ROOT = Path(__file__).parents[4]
TOOL = runpy.run_path(str(ROOT / "tools" / "make_message_definitions.py"))
REFERENCE = get_typestore(Stores.ROS2_JAZZY)


def as_written(described: list[tuple[str, object]]) -> dict[str, str]:
    """Types of rosbags as `FieldType` writes them."""
    types = {name: TOOL["_type"](kind) for name, kind in described if name != TOOL["FILLER"]}
    return {name: kind.replace("/", "/msg/") if "/msg/" not in kind else kind for name, kind in types.items()}


def test_the_file_is_the_one_that_its_tool_writes() -> None:
    assert TOOL["FILE"].read_text(encoding="utf-8") == TOOL["written"]()


@pytest.mark.parametrize("type_name", sorted(REFERENCE.types))
def test_a_type_equals_that_of_rosbags(type_name: str) -> None:
    schema = DefinitionSchema()
    message = schema.make(type_name)
    constants, fields = REFERENCE.fielddefs[type_name]
    assert {name: str(kind) for name, kind in schema.fields(type_name).items()} == as_written(fields)
    kind = type(message)
    assert {name: getattr(kind, name) for name, _, _ in constants} == {name: v for name, _, v in constants}
    assert kind.__msgtype__ == type_name
    assert message == schema.make(type_name)


def test_no_type_of_rosbags_is_missing() -> None:
    assert REFERENCE.types.keys() - stored_types() == set()


ODD = """\
# a comment, and an empty line

uint8 MOST=0x1F  # in hexadecimal
int32 LEAST = -7
int8 OCTAL=017
float64 HALF=.5
bool YES=true
string MOTTO="go # on"
string PLAIN=go # on
byte OCTET=3
@optional float32[3] three [1.0, 2.0, 3.0]
string<=5[<=4] names  # at most four
wstring wide "x"
wstring<=9 bounded
int16[] many
Thing near
Thing[2] two
geometry_msgs/Point there
geometry_msgs/msg/Point[<=2] points
time when
duration[] waits
Header header
char letter 'a'
"""


def test_every_form_of_a_line() -> None:
    found = parse_definition(ODD, "shop_msgs")
    assert found.constants == {
        "MOST": 31,
        "LEAST": -7,
        "OCTAL": 15,
        "HALF": 0.5,
        "YES": True,
        "MOTTO": "go # on",
        "PLAIN": "go # on",
        "OCTET": 3,
    }
    assert {name: str(kind) for name, kind in found.fields.items()} == {
        "three": "float32[3]",
        "names": "string<=5[<=4]",
        "wide": "string",
        "bounded": "string<=9",
        "many": "int16[]",
        "near": "shop_msgs/msg/Thing",
        "two": "shop_msgs/msg/Thing[2]",
        "there": "geometry_msgs/msg/Point",
        "points": "geometry_msgs/msg/Point[<=2]",
        "when": "builtin_interfaces/msg/Time",
        "waits": "builtin_interfaces/msg/Duration[]",
        "header": "std_msgs/msg/Header",
        "letter": "char",
    }


def test_rosbags_reads_the_same_from_every_file_of_ours() -> None:
    for file in sorted((ROOT / "src" / "jacaros" / "robots" / "ros" / "interfaces").glob("*/msg/*.msg")):
        package, text = file.parent.parent.name, file.read_text(encoding="utf-8")
        [(constants, fields)] = get_types_from_msg(text, f"{package}/msg/{file.stem}").values()
        found = parse_definition(text, package)
        assert {name: str(kind) for name, kind in found.fields.items()} == as_written(fields), file
        assert found.constants == {name: value for name, _, value in constants}, file


@pytest.mark.parametrize(
    ("text", "problem"),
    [
        ("int32\n", "line 1: expected a field or a constant, found `int32`"),
        ("int32 a\n\nint32 9b\n", "line 3: expected a field or a constant, found `int32 9b`"),
        ("int32[<=] a\n", "line 1: expected a field or a constant"),
        ("int32 a\nint32 a\n", "line 2: the name `a` occurs twice"),
        ("uint8 A=many\n", "line 1: .*many"),
        ("geometry_msgs/Point ORIGIN=0\n", "line 1: `0` is not a value of geometry_msgs/Point"),
    ],
)
def test_a_wrong_line_is_reported_with_its_number(text: str, problem: str) -> None:
    with pytest.raises(ValueError, match=problem):
        parse_definition(text, "shop_msgs")
