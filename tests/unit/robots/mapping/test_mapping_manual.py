"""What `jacaros describe` tells of a mapping: kinds, units and rounding of values, from the definitions of the types."""

from pathlib import Path

import pytest

from jacaros.artifacts.env.manual import Manual, describe
from jacaros.robots.mapping.artifact import MappedArtifact, mapped_type
from jacaros.robots.mapping.file import SHIPPED, load_mapping, read_mapping, shipped_mappings

BATTERY = "sensor_msgs/msg/BatteryState"


def manual(text: str) -> Manual:
    mapping = read_mapping(text, "robot.yaml")
    return describe(mapped_type(mapping, "robot"))


def told(text: str, name: str) -> str:
    shown = manual(text)
    return next(each.text for each in (*shown.properties, *shown.signals) if each.name == name)


def test_values_of_a_property_are_described_with_kind_unit_and_rounding() -> None:
    text = """
properties:
  odom:
    topic: odom
    type: nav_msgs/msg/Odometry
    fields:
      - {path: pose.pose.position.x, round: 2}
      - {path: twist.twist.angular.z, unit: degrees, name: turn}
      - {path: pose.pose.orientation, as: yaw, unit: degrees, round: 0}
      - header.stamp
      - {path: pose.pose.position.y, scale: 2}
    rate: 5
    expire: 2
"""
    assert told(text, "odom") == (
        "from topic odom (nav_msgs/msg/Odometry), at most 5 times a second, removed after 2 s without a message. "
        "X: number in metres, 2 decimals; Turn: number in degrees per second; Yaw: whole number in degrees; "
        "Stamp: number in seconds; Y: number."
    )


@pytest.mark.parametrize(
    ("type_name", "field", "expected"),
    [
        ("std_msgs/msg/Bool", "data", "Data: true or false"),
        ("std_msgs/msg/String", "data", "Data: text"),
        ("std_msgs/msg/String", "{path: data, as: atom}", "Data: atom"),
        ("std_msgs/msg/Int32", "data", "Data: whole number"),
        ("std_msgs/msg/Int32", "{path: data, scale: 0.5}", "Data: number"),
        ("std_msgs/msg/Int32", "{path: data, names: {0: off, 1: on_again}}", "Data: one of off, on_again"),
        (BATTERY, "percentage", "Percentage: number from 0 to 1"),
        (BATTERY, "{path: percentage, unit: share}", "number from 0 to 1"),
        (BATTERY, "temperature", "Temperature: number in degrees Celsius"),
        (BATTERY, "{path: temperature, unit: celsius}", "number in degrees Celsius"),
        ("geometry_msgs/msg/Accel", "angular.z", "Z: number in radians per second squared"),
        (BATTERY, "{path: percentage, unit: percent}", "Percentage: number in percent"),
        (BATTERY, "{path: power_supply_status, as: name}", "one of unknown, charging, "),
        ("sensor_msgs/msg/LaserScan", "{path: ranges, sample: 3}", "Ranges1 to Ranges3: number in metres"),
        ("sensor_msgs/msg/LaserScan", "ranges", "Ranges: list of number in metres"),
        ("sensor_msgs/msg/LaserScan", "{path: ranges, as: count}", "Count: whole number"),
        ("sensor_msgs/msg/LaserScan", "{path: ranges, as: min, round: 1}", "number in metres, 1 decimal"),
        ("sensor_msgs/msg/Image", "{path: ., as: object}", "Object: a reference to sensor_msgs/msg/Image"),
        ("geometry_msgs/msg/PoseStamped", "pose.position", "Position: Point"),
        ("tf2_msgs/msg/TFMessage", "'transforms[*].child_frame_id'", "ChildFrameId: list of text"),
        ("nav_msgs/msg/Odometry", "pose.covariance", "Covariance: list of number"),
        ("made_up_msgs/msg/Thing", "data", "from topic t (made_up_msgs/msg/Thing)"),
    ],
)
def test_each_kind_of_value_has_a_word(type_name: str, field: str, expected: str) -> None:
    text = f"properties: {{t: {{topic: t, type: {type_name}, fields: [{field}]}}}}\n"
    assert expected in told(text, "t")


def test_fields_that_the_mapping_leaves_out_are_those_of_the_type() -> None:
    shown = manual("properties: {at: {topic: p, type: geometry_msgs/msg/Point}}\n").properties
    [scan] = [each for each in shown if each.name == "at"]
    assert scan.usage == "at(X, Y, Z)"
    assert scan.text.endswith("X: number in metres; Y: number in metres; Z: number in metres.")


def test_elements_frames_and_feedback_are_described() -> None:
    text = """
properties:
  joint: {topic: j, type: sensor_msgs/msg/JointState, each: name, fields: [., {path: "/position[i]", round: 2}]}
frames:
  pose: {target: map, source: base_link, fields: [x, {path: yaw, unit: degrees, round: 1}]}
operations:
  go:
    action: navigate_to_pose
    type: nav2_msgs/action/NavigateToPose
    feedback:
      left: {fields: [distance_remaining]}
      all:
"""
    assert told(text, "joint").endswith("Value: text; Position: number in radians or metres, 2 decimals.")
    assert (
        told(text, "pose")
        == "frame base_link in map. X: number in metres; Yaw: number in degrees, 1 decimal."
    )
    assert told(text, "left") == "feedback of go. DistanceRemaining: number in metres."
    assert "NumberOfRecoveries: whole number" in told(text, "all")


def test_parameters_of_operations_are_described() -> None:
    text = """
operations:
  drive:
    parameters: [speed, turn, seconds]
    publish: cmd_vel
    fields:
      - {linear.x: $speed, angular.z: {value: $turn, unit: degrees}}
      - {twist.linear.x: $speed, twist.angular.z: $turn}
    rate: 10
    duration: $seconds
  follow:
    parameters: [route]
    action: follow_waypoints
    type: nav2_msgs/action/FollowWaypoints
    goal: {poses: {each: $route, fields: {pose.position.x: $1, pose.orientation: {value: $2, as: yaw}}}}
  light:
    parameters: [on]
    service: light
    type: std_srvs/srv/SetBool
    request: {data: $on}
    outputs: [message]
  limit: {parameters: [v], set_parameter: max, node: n, value: {value: $v, unit: centimetres}}
  other: {parameters: [v], publish: t, fields: {data: $v}}
"""
    usages = [each.usage for each in manual(text).operations if each.kind == "operation"]
    assert (
        "drive(speed: number in metres per second, turn: number in degrees per second, seconds: number of seconds)"
        in usages
    )
    assert "follow(route: list, of each element: number in metres; number in radians)" in usages
    assert "light(on: true or false, -message: text)" in usages
    assert "limit(v: number in centimetres)" in usages
    assert "other(v: any value)" in usages


def test_what_an_operation_expects_is_described() -> None:
    text = """
operations:
  go:
    description: Go there.
    parameters: [x]
    publish: t
    expect: {pose: [{near: $x, by: 0.5}, _], within: 2, else: not_there}
    meanwhile: {no: {bump: [{in: [left, right]}]}}
"""
    (go,) = (each for each in manual(text).operations if each.name == "go")
    assert go.text == (
        "Go there. Expects pose(near($x,0.5),any) within 2 s, else not_there; no bump(in([left,right]))."
    )


def test_definitions_are_looked_up_on_demand(monkeypatch: pytest.MonkeyPatch) -> None:
    def refuse(*_: object) -> object:
        raise AssertionError("definitions were looked up")

    monkeypatch.setattr("jacaros.robots.mapping.manual.stored_interfaces", refuse)
    made = mapped_type(load_mapping(SHIPPED / "turtlebot4.yaml"), "turtlebot4")
    assert issubclass(made, MappedArtifact)
    with pytest.raises(AssertionError, match="looked up"):
        describe(made)


@pytest.mark.parametrize("name", shipped_mappings())
def test_of_ready_mappings_every_parameter_is_known(name: str) -> None:
    mapping = load_mapping(SHIPPED / name)
    shown = str(describe(mapped_type(mapping, Path(name).stem)))
    assert "any value" not in shown
