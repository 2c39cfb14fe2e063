"""Mapping files written by `jacaros ros map` for topics, services and actions of many types; none needs editing."""

from pathlib import Path

import pytest

from jacaros.robots.mapping.checking import check_mapping
from jacaros.robots.mapping.fields import FieldPart, FilePosition, read_path
from jacaros.robots.mapping.file import read_mapping
from jacaros.robots.mapping.interfaces import StoredInterfaces, stored_interfaces
from jacaros.robots.mapping.manual import word_for_field
from jacaros.robots.ros.backend import Endpoint, GraphContents, TopicInfo
from jacaros.robots.ros.fields import FieldType
from jacaros.robots.ros.qos import QoS
from jacaros.runtime.cli.graph.standard_topics import robots
from jacaros.runtime.cli.graph.suggestions import (
    MappingEntry,
    acting,
    calling,
    looking,
    plain_name,
    property_of,
    publishing,
)
from jacaros.runtime.cli.graph.values import values_of

DEFINITIONS = {
    "msg/Part": "uint8 IDLE=0\nuint8 BUSY=1\nstring name\nuint8 state\nfloat64[] weights\ngeometry_msgs/Point position\n",
    "msg/Modes": "int32 MODE_AUTO=1\nint32 MODE_MANUAL=2\nint32 LIMIT=9\nint32 mode\nint32 other\nbool on\n",
    "msg/Alike": "uint8 A=1\nuint8 B=1\nuint8 kind\n",
    "msg/Parts": "std_msgs/Header header\nPart[] parts\n",
    "msg/Moves": "geometry_msgs/Pose start\ngeometry_msgs/Pose end\ngeometry_msgs/Twist twist\n",
    "msg/Deep": "Moves one\nMoves two\n",
    "srv/Weigh": "string[] names\nfloat64[3] offsets\nuint8[] picture\n---\nfloat64 weight\nbool success\n",
    "action/Follow": "trajectory_msgs/JointTrajectory trajectory\n---\nint32 SUCCESSFUL=0\nint32 INVALID_GOAL=-1\n"
    "int32 error_code\nstring error_string\n---\nstd_msgs/Header header\n",
    "action/Sort": "uint8 BY_NAME=0\nuint8 BY_WEIGHT=1\nuint8 order\n---\nfloat32 weight\n---\nfloat32 progress\n",
}


@pytest.fixture
def types(tmp_path: Path) -> StoredInterfaces:
    for name, text in DEFINITIONS.items():
        kind, word = name.split("/")
        file = tmp_path / "odd_msgs" / kind / f"{word}.{kind}"
        file.parent.mkdir(parents=True, exist_ok=True)
        file.write_text(text, encoding="utf-8")
    return StoredInterfaces((tmp_path,))


def info(type_name: str) -> TopicInfo:
    return TopicInfo("/t", (type_name,), (Endpoint("/n"),), (Endpoint("/m"),))


def checked(types: StoredInterfaces, *entries: MappingEntry) -> str:
    """Return the text of the entries, which must be valid."""
    lines = []
    for section in dict.fromkeys(entry.section for entry in entries):
        lines.append(f"{section}:")
        for entry in (each for each in entries if each.section == section):
            lines += [f"  {entry.name}:  # {entry.comment}", *(f"    {line}" for line in entry.lines)]
    text = "\n".join(lines) + "\n"
    check_mapping(read_mapping(text), types)
    return text


def shown(types: StoredInterfaces, type_name: str) -> str:
    entry = property_of(types, "t", "t", info(type_name))
    look = looking(entry)
    return checked(types, entry, *([look] if look is not None else []))


@pytest.mark.parametrize(
    ("type_name", "parts"),
    [
        (
            "nav_msgs/msg/Odometry",
            ["{path: pose.pose.position.x, round: 2}", "as: yaw, unit: degrees, round: 1}", "rate: 5"],
        ),
        ("sensor_msgs/msg/BatteryState", ["unit: percent, round: down}", "power_supply_status, as: name}"]),
        (
            "sensor_msgs/msg/Range",
            ["# t(Range): metres", "fields:\n      - {path: range, round: 2}\n    rate: 5"],
        ),
        (
            "sensor_msgs/msg/NavSatFix",
            [
                "t(Latitude, Longitude, Altitude)",
                "{path: latitude, round: 7}",
                "dead_band: [0.00001, 0.00001, 0.02]",
            ],
        ),
        ("sensor_msgs/msg/Imu", ["t(Yaw, Turn): degrees, degrees per second"]),
        ("sensor_msgs/msg/Temperature", ["# t(Temperature): degrees Celsius", "round: 1"]),
        ("sensor_msgs/msg/Joy", ["fields: [{path: axes, round: 3}]"]),
        ("std_msgs/msg/Float32MultiArray", ["fields: [{path: data, round: 3}]"]),
        ("std_msgs/msg/Float32", ["{path: data, round: 3}"]),
        ("std_msgs/msg/UInt64", ["- data\n"]),
        ("std_msgs/msg/String", ["signals:\n  t:  # t(Data)"]),
        ("std_msgs/msg/Empty", ["signals:\n", "# t, for each message"]),
        ("builtin_interfaces/msg/Time", ["# t(Seconds): seconds", "{path: ., round: 2, name: seconds}"]),
        ("geometry_msgs/msg/WrenchStamped", ["t(ForceX, ForceY, ForceZ, TorqueX, TorqueY, TorqueZ)"]),
        ("geometry_msgs/msg/PoseArray", ["# t(N): number of poses"]),
        (
            "tf2_msgs/msg/TFMessage",
            [
                "each: transforms",
                "t(ChildFrameId, X, Y, Z, Yaw): child_frame_id, metres, metres, metres, degrees",
            ],
        ),
        (
            "kobuki_msgs/msg/BumperEvent",
            ["signals:\n", "t(left, pressed)", "names: {0: released, 1: pressed}"],
        ),
        ("kobuki_msgs/msg/CliffEvent", ["signals:\n", "t(left, cliff)"]),
        ("sensor_msgs/msg/JointState", ['{path: "/position[i]", round: 3}']),
        ("sensor_msgs/msg/CompressedImage", ["as: object", "mode: on_demand", "refresh: t"]),
        ("irobot_create_msgs/msg/HazardDetectionVector", ["signals:\n", "when_changed: true"]),
        (
            "odd_msgs/msg/Part",
            [
                "- name\n      - {path: state, as: name}  # idle, busy\n",
                "# further fields: weights",
                "dead_band: [0, 0, 0.02, 0.02]",
            ],
        ),
        ("odd_msgs/msg/Modes", ["- {path: mode, as: name}  # auto, manual\n      - other\n      - on\n"]),
        ("odd_msgs/msg/Alike", ["- kind\n"]),
        ("type_description_interfaces/msg/FieldType", ["- nested_type_name  # at most 255 characters\n"]),
        (
            "odd_msgs/msg/Parts",
            ["t(Name, State, X, Y): name, state, metres, metres, one for each element of parts"],
        ),
        (
            "odd_msgs/msg/Moves",
            ["t(StartX, StartY, StartYaw, EndX, EndY, EndYaw)", "twist.linear.x, twist.angular.z"],
        ),
        ("odd_msgs/msg/Deep", ["OneStartX", "OneStartYaw", "OneEndX"]),
    ],
)
def test_properties_have_the_essential_fields_rounded(
    types: StoredInterfaces, type_name: str, parts: list[str]
) -> None:
    text = shown(types, type_name)
    for part in parts:
        assert part in text


def test_a_latched_text_is_a_property(types: StoredInterfaces) -> None:
    latched = Endpoint("/n", QoS(durability="transient_local"))
    entry = property_of(types, "t", "t", TopicInfo("/t", ("std_msgs/msg/String",), (latched,)))
    assert "properties:\n" in checked(types, entry)


def test_lists_become_parameters_and_poses_get_a_frame(types: StoredInterfaces) -> None:
    text = checked(types, *publishing(types, "t", "t", info("sensor_msgs/msg/JointState")))
    assert "parameters: [name, position, velocity, effort]" in text
    assert "header.stamp: now" in text
    assert "frame_id" not in text
    text = checked(types, *publishing(types, "t", "t", info("geometry_msgs/msg/PoseStamped")))
    assert "header.frame_id: map" in text


def test_constants_are_passed_by_name_and_results_are_rounded(types: StoredInterfaces) -> None:
    text = checked(types, acting(types, "t", "t", "odd_msgs/action/Sort"))
    assert "order: {value: $order, as: name}  # by_name, by_weight\n" in text
    assert "outputs: [{path: weight, round: 3}]" in text
    assert "t_feedback: {fields: [{path: progress, round: 3}], rate: 2}" in text
    text = checked(types, calling(types, "t", "t", "odd_msgs/srv/Weigh"))
    assert "parameters: [names]" in text
    assert "# unchanged: offsets, picture" in text


@pytest.mark.parametrize(
    ("topics", "spaces"),
    [
        ({"/odom": "nav_msgs/msg/Odometry", "/cmd_vel_mux/input/navi": "geometry_msgs/msg/Twist"}, []),
        ({"/odom": "nav_msgs/msg/Odometry", "/front/scan": "sensor_msgs/msg/LaserScan"}, []),
        ({"/r1/cmd_vel": "geometry_msgs/msg/TwistStamped", "/r1/pose": "geometry_msgs/msg/Pose"}, ["r1"]),
        (
            {
                "/scan": "sensor_msgs/msg/LaserScan",
                "/a/b/odom": "nav_msgs/msg/Odometry",
                "/a/b/cmd_vel": "geometry_msgs/msg/Twist",
            },
            ["a/b"],
        ),
        ({"/r1/odom": "nav_msgs/msg/Odometry", "/r2/scan": "sensor_msgs/msg/LaserScan"}, ["r1", "r2"]),
    ],
)
def test_robots_are_distinguished_from_parts_of_a_robot(topics: dict[str, str], spaces: list[str]) -> None:
    assert robots(GraphContents({name: TopicInfo(name, (kind,)) for name, kind in topics.items()})) == spaces


@pytest.mark.parametrize(
    ("ros_name", "name"),
    [
        ("CamelCase", "camel_case"),
        ("/a/b", "a_b"),
        ("2nd", "the_2nd"),
        ("if", "the_if"),
        ("true", "the_true"),
    ],
)
def test_names_are_valid_functors(ros_name: str, name: str) -> None:
    assert plain_name(ros_name) == name


@pytest.mark.parametrize(
    ("type_name", "field"),
    [
        ("geometry_msgs/msg/Accel", "linear.x"),
        ("geometry_msgs/msg/Wrench", "force.x"),
        ("sensor_msgs/msg/MagneticField", "magnetic_field.x"),
        ("sensor_msgs/msg/BatteryState", "charge"),
        ("sensor_msgs/msg/BatteryState", "voltage"),
        ("sensor_msgs/msg/Range", "range"),
        ("sensor_msgs/msg/Illuminance", "illuminance"),
    ],
)
def test_a_first_mapping_names_units_as_describe_does(type_name: str, field: str) -> None:
    interfaces = stored_interfaces(())
    value = next(each for each in values_of(interfaces, type_name) if each.path == field)
    part = FieldPart(read_path(field), FilePosition(1, 1), name="v")
    assert word_for_field(part, FieldType(type_name), None, interfaces) == f"number in {value.unit.word}"
