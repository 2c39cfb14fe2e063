"""Field types in the notations of rospy, rclpy and rosbags."""

import pytest

from jacaros.robots.ros.fields import FieldType, from_ros1, from_ros2


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("float64", FieldType("float64")),
        ("float64[36]", FieldType("float64", True, 36, True)),
        ("uint8[]", FieldType("uint8", True)),
        ("geometry_msgs/Pose", FieldType("geometry_msgs/msg/Pose")),
        ("geometry_msgs/Pose[]", FieldType("geometry_msgs/msg/Pose", True)),
        ("time", FieldType("builtin_interfaces/msg/Time")),
        ("duration[]", FieldType("builtin_interfaces/msg/Duration", True)),
        ("char", FieldType("uint8")),
        ("byte", FieldType("int8")),
        ("Header", FieldType("std_msgs/msg/Header")),
    ],
)
def test_ros1_notation_is_understood(text: str, expected: FieldType) -> None:
    assert from_ros1(text) == expected


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("double", FieldType("float64")),
        ("float", FieldType("float32")),
        ("boolean", FieldType("bool")),
        ("octet", FieldType("byte")),
        ("string", FieldType("string")),
        ("string<10>", FieldType("string", bound=10)),
        ("wstring", FieldType("string")),
        ("wstring<7>", FieldType("string", bound=7)),
        ("double[36]", FieldType("float64", True, 36, True)),
        ("sequence<float>", FieldType("float32", True)),
        ("sequence<double, 3>", FieldType("float64", True, 3)),
        ("sequence<geometry_msgs/Pose>", FieldType("geometry_msgs/msg/Pose", True)),
        ("sequence<string<5>>", FieldType("string", True, bound=5)),
        ("sequence<string<5>, 2>", FieldType("string", True, 2, bound=5)),
        ("geometry_msgs/Pose[4]", FieldType("geometry_msgs/msg/Pose", True, 4, True)),
        ("string<10>[2]", FieldType("string", True, 2, True, 10)),
    ],
)
def test_ros2_notation_is_understood(text: str, expected: FieldType) -> None:
    assert from_ros2(text) == expected


def test_field_types_are_written_as_people_write_them() -> None:
    assert [
        str(from_ros2(t)) for t in ("double", "double[3]", "sequence<double, 3>", "sequence<double>")
    ] == ["float64", "float64[3]", "float64[<=3]", "float64[]"]
