"""Values of messages as agents get them, and the way back."""

import math
from typing import Any

import pytest

from jacaros.artifacts.env.values import Atom, Structure
from jacaros.robots.mapping.decoding import MessageHandle, Unshowable, ValueRow, extractor
from jacaros.robots.mapping.encoding import WrongValue, builder
from jacaros.robots.mapping.fields import FieldPart
from jacaros.robots.mapping.file import read_mapping
from jacaros.robots.mapping.interfaces import stored_interfaces
from jacaros.robots.mapping.properties import TopicPart

SCAN, POSE = "sensor_msgs/msg/LaserScan", "geometry_msgs/msg/Pose"
BATTERY = "sensor_msgs/msg/BatteryState"
NAMED_SHARE = "{path: percentage, unit: percent, round: 0, names: {-1: unknown}}"
QUARTER = {"z": math.sin(math.pi / 4), "w": math.cos(math.pi / 4)}


def topic(fields: str, more: str = "") -> TopicPart:
    text = f"properties: {{a: {{topic: t, fields: {fields}, {more}}}}}"
    return read_mapping(text).artifacts["mapping"].properties[0]


def rows(part: TopicPart, type_name: str, message: Any = None, **fields: Any) -> list[ValueRow]:
    """What a part makes of a message."""
    problems: list[Any] = []
    extract = extractor(part, type_name, stored_interfaces(), problems)
    assert problems == []
    assert extract is not None
    return extract(message or stored_interfaces().message(type_name, **fields))


def taken(type_name: str, fields: str, **message: Any) -> tuple[object, ...]:
    """The values of some fields of a message."""
    [row] = rows(topic(fields), type_name, **message)
    return row.values


@pytest.mark.parametrize(
    ("type_name", "message", "fields", "values"),
    [
        ("geometry_msgs/msg/Point", {"x": 1.5}, "[x, z]", (1.5, 0.0)),
        ("std_msgs/msg/String", {"data": "on"}, "data", ("on",)),
        ("std_msgs/msg/String", {"data": "on"}, "{path: data, as: atom}", (Atom("on"),)),
        ("std_msgs/msg/Bool", {"data": True}, "data", (True,)),
        ("std_msgs/msg/Byte", {"data": 7}, "data", (7,)),
        ("std_msgs/msg/Header", {"stamp": 12.5}, "stamp", (12.5,)),
        ("std_msgs/msg/Header", {"stamp": 12.5}, "{path: stamp, unit: minutes, round: 2}", (0.21,)),
        (POSE, {"orientation": QUARTER}, "{path: orientation, as: yaw}", (math.pi / 2,)),
        (POSE, {"orientation": QUARTER}, "{path: orientation, as: yaw, unit: degrees}", (90.0,)),
        (POSE, {"orientation": QUARTER}, "{path: orientation, as: roll}", (0.0,)),
        (
            POSE,
            {"orientation": {"y": QUARTER["z"], "w": QUARTER["w"]}},
            "{path: orientation, as: pitch, unit: degrees, round: 0}",
            (90,),
        ),
        (BATTERY, {"percentage": 0.25}, "{path: percentage, unit: percent}", (25.0,)),
        (BATTERY, {"percentage": 0.997}, "{path: percentage, unit: percent, round: down}", (99,)),
        (BATTERY, {"percentage": 0.57}, "{path: percentage, unit: percent, round: down}", (57,)),
        (BATTERY, {"percentage": 1.0}, "{path: percentage, unit: percent, round: down}", (100,)),
        ("sensor_msgs/msg/Temperature", {"temperature": 20.0}, "{path: temperature, unit: kelvin}", (293.15,)),
        ("geometry_msgs/msg/Point", {"x": 1.5}, "{path: x, unit: centimetres}", (150.0,)),
        ("geometry_msgs/msg/Vector3", {"x": 10}, "{path: x, unit: kilometres_per_hour}", (36.0,)),
        ("geometry_msgs/msg/Point", {"x": 2}, "{path: x, scale: 3, offset: 1}", (7.0,)),
        (BATTERY, {"power_supply_status": 1}, "{path: power_supply_status, as: name}", (Atom("charging"),)),
        (BATTERY, {"power_supply_status": 99}, "{path: power_supply_status, as: name}", (99,)),
        ("std_msgs/msg/Int8", {"data": 1}, "{path: data, names: {0: off, 1: on}}", (Atom("on"),)),
        ("std_msgs/msg/Int8", {"data": 2}, "{path: data, names: {0: off, 1: on}}", (2,)),
        ("std_msgs/msg/String", {"data": "x"}, "{path: data, names: {x: exit}}", (Atom("exit"),)),
        (BATTERY, {"percentage": -1}, NAMED_SHARE, (Atom("unknown"),)),
        (BATTERY, {"percentage": 0.5}, NAMED_SHARE, (50,)),
        (SCAN, {"ranges": [1.0, 2.0, 3.0]}, "ranges", ([1.0, 2.0, 3.0],)),
        (SCAN, {"ranges": [1.0, 2.0, 3.0]}, "['ranges[0]', 'ranges[-1]']", (1.0, 3.0)),
        (SCAN, {"ranges": range(9)}, "{path: ranges, sample: 5}", (0.0, 2.0, 4.0, 6.0, 8.0)),
        (SCAN, {"ranges": range(9)}, "{path: ranges, sample: [0, 1]}", (0.0, 8.0)),
        (SCAN, {"ranges": [2.0, math.inf, 1.0, 3.0]}, "{path: ranges, as: min}", (1.0,)),
        (SCAN, {"ranges": [2.0, math.nan, 1.0, 3.0]}, "{path: ranges, as: max}", (3.0,)),
        (SCAN, {"ranges": [2.0, math.nan, 1.0, 3.0]}, "{path: ranges, as: mean}", (2.0,)),
        (SCAN, {"ranges": [2.0, 1.0]}, "{path: ranges, as: count}", (2,)),
        (
            SCAN,
            {"ranges": [math.inf, 1.0], "range_max": 8.0},
            "{path: ranges, sample: 2, otherwise: range_max}",
            (8.0, 1.0),
        ),
        (SCAN, {"ranges": [math.nan]}, "{path: ranges, as: min, otherwise: 9.5}", (9.5,)),
        (SCAN, {"ranges": [math.inf, 1.0]}, "{path: ranges, otherwise: -1}", ([-1, 1.0],)),
        (
            "tf2_msgs/msg/TFMessage",
            {"transforms": [{"child_frame_id": "a"}, {"child_frame_id": "b"}]},
            "'transforms[*].child_frame_id'",
            (["a", "b"],),
        ),
        (
            "tf2_msgs/msg/TFMessage",
            {"transforms": [{"transform": {"rotation": QUARTER}}]},
            "{path: 'transforms[*].transform.rotation', as: yaw, unit: degrees, round: 6}",
            ([90.0],),
        ),
        (
            POSE,
            {"position": {"x": 1}},
            "position",
            (Structure("point", (1.0, 0.0, 0.0)),),
        ),
        (
            "geometry_msgs/msg/PointStamped",
            {"header": {"stamp": 2.5, "frame_id": "map"}},
            ".",
            (
                Structure(
                    "pointStamped",
                    (Structure("header", (2.5, "map")), Structure("point", (0.0, 0.0, 0.0))),
                ),
            ),
        ),
        ("std_msgs/msg/Empty", {}, ".", (Atom("empty"),)),
        (
            "geometry_msgs/msg/Polygon",
            {"points": [{"x": 1}, {"y": 2}]},
            "points",
            ([Structure("point32", (1.0, 0.0, 0.0)), Structure("point32", (0.0, 2.0, 0.0))],),
        ),
        ("sensor_msgs/msg/Image", {"data": [1, 2]}, "data", ([1, 2],)),
    ],
)  # fmt: skip
def test_values_of_fields(
    type_name: str, message: dict[str, Any], fields: str, values: tuple[object, ...]
) -> None:
    found = taken(type_name, fields, **message)
    assert found == pytest.approx(values) if all(isinstance(v, float) for v in values) else found == values
    assert [type(a) for a in found] == [type(b) for b in values]


def test_without_fields_all_of_the_message_is_shown() -> None:
    [row] = rows(TopicPart("a", topic("x").place, None), "geometry_msgs/msg/Point", z=2)
    assert row.values == (0.0, 0.0, 2.0)


@pytest.mark.parametrize(
    ("fields", "x"), [("x", math.nan), ("x", -math.inf), ("{path: x, unit: centimetres}", math.inf)]
)
def test_a_number_that_is_not_finite_is_not_shown(fields: str, x: float) -> None:
    with pytest.raises(Unshowable) as caught:
        taken("geometry_msgs/msg/Point", fields, x=x)
    assert (caught.value.path, caught.value.functor) == ("x", "not_finite")
    assert "otherwise: 0" in caught.value.help


def test_a_nested_number_that_is_not_finite_is_not_shown() -> None:
    with pytest.raises(Unshowable, match=r"`position\.x` is nan"):
        taken(POSE, "position", position={"x": math.nan})


@pytest.mark.parametrize("fields", ["'ranges[3]'", "{path: ranges, sample: 2}"])
def test_a_missing_element_is_not_shown(fields: str) -> None:
    with pytest.raises(Unshowable) as caught:
        taken(SCAN, fields)
    assert caught.value.functor == "no_element"


def test_big_things_go_by_handle() -> None:
    message = stored_interfaces().message("sensor_msgs/msg/Image", data=[1, 2, 3])
    part = topic("[{path: ., as: object}, {path: data, as: object}]")
    whole, data = rows(part, "sensor_msgs/msg/Image", message)[0].values
    assert isinstance(whole, MessageHandle)
    assert isinstance(data, MessageHandle)
    assert whole.value is message
    assert data.value is message.data
    assert (repr(whole), repr(data)) == ("<sensor_msgs/msg/Image>", "<uint8[]>")


def test_one_row_for_each_element_with_parallel_arrays() -> None:
    part = topic("[., '/position[i]', /header.frame_id]", "each: name")
    message = {"name": ["left", "right"], "position": [1.0, 2.0], "header": {"frame_id": "base"}}
    found = [row.values for row in rows(part, "sensor_msgs/msg/JointState", **message)]
    assert found == [("left", 1.0, "base"), ("right", 2.0, "base")]


def test_a_list_may_identify_elements() -> None:
    part = topic("[points]", "each: markers")
    markers = [{"points": [{"x": 1}]}, {"points": [{"x": 2}]}]
    assert len({row.key for row in rows(part, "visualization_msgs/msg/MarkerArray", markers=markers)}) == 2


def test_field_parts_know_how_many_values_they_give() -> None:
    fields = topic("[x, {path: y, sample: 3}]").fields
    assert fields is not None
    assert [FieldPart.count.fget(field) for field in fields] == [1, 3]  # type: ignore[attr-defined]


# ---- the way back


def filled(type_name: str, fields: str, *arguments: object, parameters: str = "[a, b]") -> Any:
    text = f"operations: {{go: {{publish: t, parameters: {parameters}, fields: {fields}}}}}"
    part = read_mapping(text).artifacts["mapping"].operations[0]
    problems: list[Any] = []
    fill = builder(part.values, type_name, stored_interfaces(), problems)
    assert problems == []
    assert fill is not None
    return stored_interfaces().message(type_name, **fill(arguments, 100.5))


def test_parameters_constants_and_the_time() -> None:
    made = filled(
        "geometry_msgs/msg/PoseStamped",
        "{header.stamp: now, header.frame_id: map, pose.position.x: $b, pose.position.y: $a}",
        1,
        2.5,
    )
    assert (made.header.stamp.sec, made.header.stamp.nanosec) == (100, 500_000_000)
    assert (made.header.frame_id, made.pose.position.x, made.pose.position.y) == ("map", 2.5, 1.0)
    assert made.pose.orientation.w == 1.0


def test_units_and_quaternions_backwards() -> None:
    made = filled(POSE, "{orientation: {value: $a, as: yaw, unit: degrees}}", 90)
    assert (made.orientation.z, made.orientation.w) == pytest.approx((QUARTER["z"], QUARTER["w"]))
    twist = filled("geometry_msgs/msg/Twist", "{angular.z: {value: $a, unit: degrees}}", 180)
    assert twist.angular.z == pytest.approx(math.pi)
    point = filled("geometry_msgs/msg/Point", "{x: {value: $a, scale: 2, offset: 1}}", 7)
    assert point.x == 3.0


def test_constants_of_the_type_by_name() -> None:
    fields = "{power_supply_status: POWER_SUPPLY_STATUS_FULL, power_supply_health: {value: $a, as: name}}"
    made = filled(BATTERY, fields, Atom("overheat"))
    assert (made.power_supply_status, made.power_supply_health) == (4, 2)


def test_words_for_values_backwards() -> None:
    assert filled("std_msgs/msg/Int8", "{data: {value: $a, names: {0: off, 1: on}}}", Atom("on")).data == 1
    fields = "{x: {value: $a, unit: centimetres, names: {-1: nowhere}}}"
    assert filled("geometry_msgs/msg/Point", fields, Atom("nowhere")).x == -1
    assert filled("geometry_msgs/msg/Point", fields, 50).x == 0.5


def test_structures_lists_and_handles_stand_for_messages() -> None:
    point = filled(POSE, "{position: $a}", Structure("at", (1, 2, 3)))
    assert (point.position.x, point.position.z) == (1.0, 3.0)
    polygon = filled("geometry_msgs/msg/Polygon", "{points: $a}", [[1, 2, 3], Structure("p", (4, 5, 6))])
    assert [each.x for each in polygon.points] == [1.0, 4.0]
    header = stored_interfaces().message("std_msgs/msg/Header", frame_id="x")
    assert filled("geometry_msgs/msg/PoseStamped", "{header: $a}", MessageHandle(header, "")).header is header


def test_a_list_of_messages_from_the_parts_of_elements() -> None:
    made = filled(
        "nav_msgs/msg/Path",
        "{poses: {each: $a, fields: {header.frame_id: map, pose.position.x: $1, pose.position.y: $2}}}",
        [Structure("at", (1, 2)), [3, 4]],
    )
    found = [(each.header.frame_id, each.pose.position.x, each.pose.position.y) for each in made.poses]
    assert found == [("map", 1.0, 2.0), ("map", 3.0, 4.0)]


def test_elements_by_number() -> None:
    made = filled("sensor_msgs/msg/Joy", "{'axes': $a, 'buttons[0]': 1, 'buttons[1]': $b}", [0.5, 1], 3)
    assert (made.axes.tolist(), made.buttons.tolist()) == ([0.5, 1.0], [1, 3])


@pytest.mark.parametrize(
    ("fields", "argument", "message"),
    [
        ("{angular.z: {value: $a, unit: degrees}}", "left", 'cannot be "left": expected a number'),
        ("{linear: $a}", [1, 2], "has 3 fields: x, y, z"),
    ],
)
def test_a_wrong_argument_is_reported(fields: str, argument: object, message: str) -> None:
    with pytest.raises(WrongValue, match=message):
        filled("geometry_msgs/msg/Twist", fields, argument)
