"""Messages from keywords, checked against genuine definitions."""

import math
from array import array
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from jacaros.robots.ros.errors import MessageMismatch, NameInvalid, UnknownInterface
from jacaros.robots.ros.message import constant, field_names, plain, stamp, to_seconds
from jacaros.robots.ros.typestore import DefinitionSchema

factory = DefinitionSchema()


def make(type_name: str, **fields: Any) -> Any:
    return factory.make(type_name, fields)


def test_a_rotation_is_the_identity_by_default() -> None:
    assert make("nav_msgs/msg/Odometry").pose.pose.orientation.w == 1.0
    path = make("nav_msgs/msg/Path", poses=[{}, {"pose": {"orientation": {"w": 0.5}}}])
    assert [pose.pose.orientation.w for pose in path.poses] == [1.0, 0.5]


def test_nested_messages_may_be_mappings_or_messages() -> None:
    point = make("geometry_msgs/msg/Point", x=1, y=2.5)
    pose = make("geometry_msgs/msg/Pose", position=point, orientation={"z": 0.5})
    assert pose.position is point
    assert (pose.position.x, pose.orientation.z) == (1.0, 0.5)


def test_two_messages_share_nothing() -> None:
    one, two = make("nav_msgs/msg/Odometry"), make("nav_msgs/msg/Odometry")
    one.pose.pose.position.x = 7.0
    one.pose.covariance[0] = 7.0
    assert (two.pose.pose.position.x, two.pose.covariance[0]) == (0.0, 0.0)


@pytest.mark.parametrize(
    ("type_name", "fields", "where"),
    [
        ("std_msgs/msg/Int8", {"data": 128}, "data"),
        ("std_msgs/msg/UInt8", {"data": -1}, "data"),
        ("std_msgs/msg/Int8", {"data": 1.5}, "data"),
        ("std_msgs/msg/Int8", {"data": True}, "data"),
        ("std_msgs/msg/Bool", {"data": 1}, "data"),
        ("std_msgs/msg/String", {"data": 1}, "data"),
        ("std_msgs/msg/String", {"data": b"x"}, "data"),
        ("std_msgs/msg/Float64", {"data": "1"}, "data"),
        ("std_msgs/msg/Float64", {"data": None}, "data"),
        ("geometry_msgs/msg/Twist", {"linear": {"x": "a"}}, "linear.x"),
        ("geometry_msgs/msg/Twist", {"linear": 3}, "linear"),
        ("geometry_msgs/msg/Twist", {"lin": 3}, "lin"),
        ("nav_msgs/msg/Path", {"poses": [{}, {"pose": {"position": {"q": 1}}}]}, "poses[1].pose.position.q"),
        ("nav_msgs/msg/Path", {"poses": {}}, "poses"),
        ("nav_msgs/msg/Path", {"poses": 3}, "poses"),
        ("geometry_msgs/msg/PoseWithCovariance", {"covariance": [1.0]}, "covariance"),
        ("geometry_msgs/msg/PoseWithCovariance", {"covariance": "x" * 36}, "covariance"),
        ("sensor_msgs/msg/LaserScan", {"ranges": ["1"]}, "ranges"),
        ("sensor_msgs/msg/LaserScan", {"ranges": [[1.0]]}, "ranges"),
        ("sensor_msgs/msg/Image", {"data": [256]}, "data"),
        ("sensor_msgs/msg/Image", {"data": [0.5]}, "data"),
        ("sensor_msgs/msg/JointState", {"name": ["a", 1]}, "name"),
        ("std_msgs/msg/Header", {"stamp": "now"}, "stamp"),
        ("std_msgs/msg/Header", {"stamp": {"seconds": 1}}, "stamp"),
        ("std_msgs/msg/Empty", {"x": 1}, "x"),
    ],
)
def test_a_mismatch_names_field_and_type(type_name: str, fields: dict[str, Any], where: str) -> None:
    with pytest.raises(MessageMismatch) as caught:
        factory.make(type_name, fields)
    assert caught.value.field == where
    assert where in str(caught.value)


def test_an_unknown_field_lists_the_known_ones() -> None:
    with pytest.raises(MessageMismatch, match="did you mean `angular`") as caught:
        make("geometry_msgs/msg/Twist", anguler={})
    assert caught.value.known == ("linear", "angular")
    assert caught.value.type_name == "geometry_msgs/msg/Twist"


class Name(str):
    """A text of another kind, as the agents' atoms are."""

    __slots__ = ()


def test_numbers_and_texts_of_other_kinds_become_plain() -> None:
    assert type(make("std_msgs/msg/String", data=Name("go")).data) is str
    assert make("std_msgs/msg/Int32", data=3.0).data == 3
    assert type(make("std_msgs/msg/Float64", data=np.float32(0.5)).data) is float
    assert make("std_msgs/msg/Int64", data=np.int8(-3)).data == -3
    assert make("std_msgs/msg/Bool", data=np.bool_(True)).data is True


def test_arrays_may_be_lists_tuples_ranges_and_numpy_arrays() -> None:
    for values in ([1, 2, 3], (1, 2, 3), range(1, 4), np.array([1, 2, 3]), np.array([1.0, 2.0, 3.0])):
        ranges = make("sensor_msgs/msg/LaserScan", ranges=values).ranges
        assert (type(ranges), ranges.typecode) == (array, "f")
        assert ranges.tolist() == [1.0, 2.0, 3.0]
    for octets in (b"\x00\xff", bytearray(b"\x00\xff"), [0, 255]):
        assert make("sensor_msgs/msg/Image", data=octets).data.tolist() == [0, 255]


def test_infinite_ranges_are_kept_and_too_large_a_number_for_32_bits_is_infinite() -> None:
    ranges = make("sensor_msgs/msg/LaserScan", ranges=[math.inf, math.nan, 1e300]).ranges
    assert ranges[0] == ranges[2] == math.inf
    assert math.isnan(ranges[1])


@given(st.floats(min_value=0, max_value=4e9))
def test_seconds_survive_a_stamp(seconds: float) -> None:
    header = make("std_msgs/msg/Header", stamp=seconds)
    assert abs(to_seconds(header.stamp) - seconds) < 1e-6
    assert 0 <= header.stamp.nanosec < 1_000_000_000


def test_a_stamp_is_set_in_place_and_negative_durations_have_a_floor() -> None:
    header = make("std_msgs/msg/Header")
    stamp(header.stamp, 1.9999999999)
    assert (header.stamp.sec, header.stamp.nanosec) == (2, 0)
    duration = factory.make("builtin_interfaces/msg/Duration", {"sec": -1, "nanosec": 500_000_000})
    assert to_seconds(duration) == -0.5
    stamp(duration, -0.25)
    assert (duration.sec, duration.nanosec) == (-1, 750_000_000)


def test_constants_are_read_by_name() -> None:
    battery = make("sensor_msgs/msg/BatteryState")
    assert constant(battery, "POWER_SUPPLY_STATUS_CHARGING") == 1
    with pytest.raises(NameInvalid, match="POWER_SUPPLY_STATUS_BURNING"):
        constant(battery, "POWER_SUPPLY_STATUS_BURNING")


def test_field_names_leave_fillers_out() -> None:
    assert field_names(make("std_msgs/msg/Empty")) == []
    assert field_names(make("geometry_msgs/msg/Twist")) == ["linear", "angular"]
    assert field_names(3) is None


def defined(folder: Path, **definitions: str) -> DefinitionSchema:
    """A schema of a package of ours; a name such as Order_msg has its definition."""
    for name, text in definitions.items():
        stem, kind = name.split("_")
        path = folder / "shop_msgs" / kind / f"{stem}.{kind}"
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text)
    return DefinitionSchema([folder])


def test_arrays_of_booleans_are_lists_and_others_have_the_items_of_their_type(tmp_path: Path) -> None:
    schema = defined(tmp_path, Shelf_msg="bool[] full\nbool[2] pair\nbyte[] marks\nint64[] ids\n")
    shelf = schema.make("shop_msgs/msg/Shelf", {"full": [True], "marks": b"\x07", "ids": [2**40, -1.0]})
    assert (shelf.full, shelf.pair) == ([True], [False, False])
    assert (shelf.marks, shelf.ids) == (array("B", [7]), array("q", [2**40, -1]))
    assert plain(shelf) == {"full": [True], "pair": [False, False], "marks": [7], "ids": [2**40, -1]}


def test_a_wrong_definition_is_reported_with_its_line(tmp_path: Path) -> None:
    with pytest.raises(UnknownInterface, match="definition of shop_msgs/msg/Bad is wrong: line 2"):
        defined(tmp_path, Bad_msg="int32 a\nint32\n").fields("shop_msgs/msg/Bad")
