"""Mapping files compared with message types: mismatches are reported with location and help."""

from collections.abc import Mapping
from pathlib import Path

import pytest
from mapped_lab import mistakes

from jacaros.robots.mapping.checking import check_mapping
from jacaros.robots.mapping.file import MappingError, read_mapping
from jacaros.robots.mapping.interfaces import StoredInterfaces, stored_interfaces
from jacaros.robots.ros.errors import UnknownInterface
from jacaros.robots.ros.fields import FieldType
from jacaros.runtime.mas.checks.observables import Observables
from jacaros.runtime.mas.mappings import check_mapping_file

SHORT = {
    "ODOMETRY": "properties: {a: {topic: t, type: nav_msgs/msg/Odometry, ...}}",
    "BATTERY": "properties: {a: {topic: t, type: sensor_msgs/msg/BatteryState, ...}}",
    "JOINT": "properties: {a: {topic: t, type: sensor_msgs/msg/JointState, ...}}",
    "TWIST": "operations: {go: {publish: t, type: geometry_msgs/msg/Twist, parameters: [v], ...}}",
    "GOAL": "operations: {go: {action: t, type: nav2_msgs/action/NavigateToPose, parameters: [v], ...}}",
}


WRONG = r"""
properties: {a: {topic: t, type: nav_msgs/msg/Odometri}}
  1:34: the type `nav_msgs/msg/Odometri` is not known here | did you mean `nav_msgs/msg/Odometry`?
operations: {a: {service: t, type: std_srvs/srv/Triger}}
  1:36: the type `std_srvs/srv/Triger` is not known here | did you mean `std_srvs/srv/Trigger`?
operations: {a: {action: t, type: nav2_msgs/action/NavigateToPos}}
  1:35: the type `nav2_msgs/action/NavigateToPos` is not known here | did you mean `nav2_msgs/action/NavigateToPose
ODOMETRY fields: [pose.pose.positon.x]
  1:66: `pose.pose.positon.x`: geometry_msgs/msg/Pose has no field `positon` | did you mean `position`? Its fields:
  position (geometry_msgs/msg/Point), orientation (geometry_msgs/msg/Quaternion)
properties: {a: {topic: t, type: std_msgs/msg/Bool, fields: [{path: data, names: {on: lit}}]}}
  1:62: `names` has 'on', but `data` is bool | write names: {true: lit}
properties: {a: {topic: t, type: std_msgs/msg/Int32, fields: [{path: data, names: {a: b}}]}}
  1:63: `names` has 'a', but `data` is int32 | write values of int32
operations: {a: {parameters: [x], publish: t, type: std_msgs/String, fields: {data: {value: $x, names: {1: b}}}}}
  1:85: `names` has 1, but `data` is string | write values of string
ODOMETRY fields: [{path: pose.pose.position.x, unit: degrees}]
  1:66: messages have `pose.pose.position.x` in m, but degrees is a unit of angle | units of length are metres,
properties: {a: {topic: t, type: sensor_msgs/msg/LaserScan, fields: [{path: ranges, as: min, unit: percent}]}}
  1:70: messages have `ranges` in m, but percent is a unit of share
ODOMETRY fields: [{path: header.stamp, unit: metres}]
  1:66: messages have `header.stamp` in s, but metres is a unit of length
properties: {a: {topic: t, type: sensor_msgs/msg/NavSatFix, fields: [{path: latitude, unit: degrees}]}}
  1:70: messages already have `latitude` in degrees | leave `unit` out
TWIST fields: {linear.x: {value: $v, unit: degrees}}
  1:98: messages have `linear.x` in m/s, but degrees is a unit of angle | units of speed are metres_per_second,
TWIST fields: {linear: [1, 2, 3], linear.x: $v}
  1:117: `linear.x` is part of `linear` on line 1 | leave one of them out
properties: {a: {topic: t, type: std_msgs/msg/String, frame: odom}}
  1:62: `frame` is for messages with a header, but std_msgs/msg/String has none | leave it out
ODOMETRY fields: [pose.pose.position.x.y]
  1:66: `pose.pose.position.x.y`: pose.pose.position.x is float64 and has no fields | write pose.pose.position.x
ODOMETRY fields: ['pose.pose.position.x[0]']
  1:66: `pose.pose.position.x[0]`: pose.pose.position.x is float64, not an array | write pose.pose.position.x
ODOMETRY fields: ['pose.covariance[36]']
  1:66: `pose.covariance[36]`: pose.covariance has 36 elements | elements are pose.covariance[0] to
  pose.covariance[35]
properties: {a: {topic: t, type: tf2_msgs/msg/TFMessage, fields: [transforms.header]}}
  1:67: `transforms.header`: transforms is an array, geometry_msgs/msg/TransformStamped[] | write
  transforms[0].header, or transforms[*].header for all
ODOMETRY fields: {path: pose.pose.position, as: yaw}
  1:65: `as: yaw` is for quaternions, but `pose.pose.position` is geometry_msgs/msg/Point | name the field that is a
  geometry_msgs/msg/Quaternion, such as pose.pose.orientation
ODOMETRY fields: {path: header.frame_id, unit: degrees}
  1:65: unit, scale or offset needs a number, but `header.frame_id` is string | name a field that is a number
ODOMETRY fields: {path: pose.pose.position.x, as: atom}
  1:65: `as: atom` is for strings, but `pose.pose.position.x` is float64 | leave `as` out
ODOMETRY fields: {path: pose.pose.position.x, sample: 5}
  1:65: `sample` is for lists, but `pose.pose.position.x` is float64 | name a field that is a list
BATTERY fields: {path: percentage, otherwise: location}
  1:72: `otherwise` must be a number, but `location` is string |
BATTERY fields: {path: present, as: name}
  1:72: sensor_msgs/msg/BatteryState: the constants `power_supply_status_unknown` and `power_supply_health_unknown`
  have the same value 0 | write names: {0: power_supply_health_unknown}
BATTERY each: percentage
  1:70: `each` is for arrays, but `percentage` is float32 |
properties: {a: {topic: t, type: geometry_msgs/msg/Point, dead_band: [1]}}
  1:14: `dead_band` has 1 values, but geometry_msgs/msg/Point has 3 fields |
TWIST fields: {linear.w: 1}
  1:98: `linear.w`: geometry_msgs/msg/Vector3 has no field `w` | its fields: x (float64), y (float64), z (float64)
TWIST fields: {linear.x: fast}
  1:98: geometry_msgs/msg/Vector3: field x is float64, but 'fast' is given | write another value, or a parameter:
  $name
operations: {go: {publish: t, type: sensor_msgs/msg/Joy, fields: {header.stamp: now, 'buttons[0]': UP}}}
  1:100: `buttons[0]` is int32, but 'UP' is not a constant of sensor_msgs/msg/Joy | write a number, or a parameter:
  $name
operations: {go: {service: s, type: std_srvs/srv/SetBool, request: {data: 'yes'}}}
  1:75: `data` is bool, but 'yes' is not a constant of std_srvs/srv/SetBool_Request | write true or false, or a
  parameter: $name
TWIST fields: {linear.x: now}
  1:98: `now` is a time, but `linear.x` is float64 | write another value
TWIST fields: {angular: {value: $v, as: yaw}}
  1:97: `as: yaw` makes a quaternion, but `angular` is geometry_msgs/msg/Vector3 | name the field that is a
  geometry_msgs/msg/Quaternion, such as pose.pose.orientation
GOAL goal: {pose.pose.position: 3}
  1:113: geometry_msgs/msg/Pose: field position is geometry_msgs/msg/Point, but 3 is given | write another value, or a
  parameter: $name
GOAL outputs: [error]
  1:96: `error`: nav2_msgs/action/NavigateToPose_Result has no field `error` | did you mean `error_msg`?
GOAL feedback: {left: [distance]}
  1:104: `distance`: nav2_msgs/action/NavigateToPose_Feedback has no field `distance` | did you mean
  `distance_remaining`? Its fields: current_pose
GOAL success: ok
  1:95: `ok`: nav2_msgs/action/NavigateToPose_Result has no field `ok` | its fields:
GOAL goal: {pose: {each: $v, fields: {pose.x: $1}}}
  1:99: `each` fills a list of messages, but `pose` is geometry_msgs/msg/PoseStamped | write a value
"""


def full(text: str) -> str:
    """Replace a word of SHORT at the beginning."""
    word, _, rest = text.partition(" ")
    return SHORT[word].replace("...", rest) if word in SHORT else text


def told(text: str) -> list[str]:
    with pytest.raises(MappingError) as caught:
        check_mapping(read_mapping(text, "m.yaml"), stored_interfaces())
    return [f"{p.line}:{p.column}: {p.message} | {p.help}" for p in caught.value.problems]


@pytest.mark.parametrize(("text", "expected"), mistakes(WRONG).items())
def test_mismatches_are_reported_with_location_and_help(text: str, expected: str) -> None:
    found = told(full(text))
    assert any(each.startswith(expected) for each in found), found


def test_all_problems_are_reported_in_one_pass() -> None:
    assert len(told(full("ODOMETRY fields: [a, b]") + "\n" + full("TWIST fields: {c: 1, d: 2}"))) == 4


def test_types_known_only_to_the_robot_are_marked() -> None:
    [found] = told("properties: {a: {topic: t, type: acme_msgs/msg/Gripper}}")
    assert "the type `acme_msgs/msg/Gripper` is not known here" in found
    assert "interface_paths" in found


class WithoutNav2(StoredInterfaces):
    """The interfaces of a robot whose middleware lacks the actions of Nav2."""

    def fields(self, type_name: str) -> Mapping[str, FieldType]:
        if type_name.startswith("nav2_msgs/"):
            raise UnknownInterface(f"{type_name} is not installed")
        return super().fields(type_name)


def test_a_type_that_only_the_robot_lacks_is_not_called_misspelt() -> None:
    with pytest.raises(MappingError) as wrong:
        check_mapping(read_mapping(full("GOAL goal: {pose.pose.position.x: $v}")), WithoutNav2())
    assert "help: nav2_msgs/action/NavigateToPose" in str(wrong.value)
    assert "is not installed" in str(wrong.value)
    assert "did you mean" not in str(wrong.value)


@pytest.mark.parametrize(
    "text",
    [
        "JOINT fields: [{path: 'position[0]', unit: degrees}]",
        "JOINT fields: [{path: 'position[0]', unit: millimetres}]",
    ],
)
def test_a_unit_that_messages_can_have_is_accepted(text: str) -> None:
    check_mapping(read_mapping(full(text)), stored_interfaces())


@pytest.mark.parametrize("unit", ["meters", "[degrees]", "3", "{a: b}"])
def test_an_unknown_unit_does_not_stop_the_check_of_types(unit: str, tmp_path: Path) -> None:
    file = tmp_path / "m.yaml"
    head = "properties:\n  a:\n    topic: t\n    type: nav_msgs/msg/Odometry\n    fields:\n"
    field = f"      - {{path: pose.pose.position.x, unit: {unit}}}\n"
    file.write_text(f"{head}{field}      - pose.nothing\n", encoding="utf-8")
    messages = [each.message for each in check_mapping_file(file, Observables())]
    assert any(each.startswith("unknown unit") for each in messages)
    assert any("has no field `nothing`" in each for each in messages)


@pytest.mark.parametrize(
    ("text", "why"),
    [
        ("BATTERY fields: [{path: voltage, unit: percent}]", "`voltage` in V"),
        ("JOINT fields: [{path: 'position[0]', unit: percent}]", "rad or m"),
    ],
)
def test_a_unit_that_the_message_cannot_be_converted_to_is_an_error(text: str, why: str) -> None:
    assert why in told(full(text))[0]


@pytest.mark.parametrize(
    ("type_name", "field", "why"),
    [
        ("visualization_msgs/Marker", "lifetime: -3", "expected a duration that is not negative"),
        ("visualization_msgs/Marker", "lifetime.sec: -3", "expected a duration that is not negative"),
        ("sensor_msgs/Joy", "'buttons[0]': 3000000000", "it must be from -2147483648 to 2147483647"),
        ("sensor_msgs/JoyFeedback", "id: {value: 30, scale: 0.1}", "it must be from 0 to 255"),
        ("sensor_msgs/JoyFeedback", "type: {value: $x, names: {300: loud}}", "`names` has 300"),
        ("shape_msgs/SolidPrimitive", "dimensions: [1, 2, 3, 4]", "but 4 elements are given"),
        ("shape_msgs/SolidPrimitive", "'dimensions[3]': 1", "dimensions has at most 3 elements"),
        (
            "type_description_interfaces/FieldType",
            f"nested_type_name: {256 * 'x'}",
            "string<=255, but a string of 256 characters is given",
        ),
    ],
)
def test_a_value_outside_the_range_of_its_field_is_refused(type_name: str, field: str, why: str) -> None:
    parameters = "parameters: [x], " if "$x" in field else ""
    found = told(f"operations: {{o: {{{parameters}publish: t, type: {type_name}, fields: {{{field}}}}}}}")
    assert any(why in each for each in found), found


@pytest.mark.parametrize(
    ("variable", "entry", "package"),
    [
        ("AMENT_PREFIX_PATH", ".", "share/fresh_1"),
        ("CMAKE_PREFIX_PATH", ".", "share/fresh_2"),  # ROS 1: /opt/ros/noetic, a workspace's devel
        ("ROS_PACKAGE_PATH", "share", "share/fresh_3"),
        ("ROS_PACKAGE_PATH", "src", "src/repository/fresh_4"),
        ("ROS_PACKAGE_PATH", "src/fresh_5", "src/fresh_5"),
    ],
)
def test_types_of_packages_that_are_installed_are_known(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, variable: str, entry: str, package: str
) -> None:
    folder = tmp_path / package
    for kind, text in (
        ("msg", "time at\n"),
        ("srv", "bool on\n---\n"),
        ("action", "byte b\n---\n---\nFresh f\n"),
    ):
        (folder / kind).mkdir(parents=True)
        (folder / kind / f"Fresh.{kind}").write_text(text, encoding="utf-8")
    (folder / "package.xml").write_text("<package/>", encoding="utf-8")
    monkeypatch.setenv(variable, str(tmp_path / entry))
    stored_interfaces.cache_clear()
    text = (
        "properties: {p: {topic: t, type: PACKAGE/Fresh, fields: [at]}}\n"
        "operations:\n"
        "  s: {service: s, type: PACKAGE/Fresh, request: {on: true}}\n"
        "  a: {action: a, type: PACKAGE/Fresh, goal: {b: 1}}\n"
    ).replace("PACKAGE", folder.name)
    check_mapping(read_mapping(text), stored_interfaces())
    stored_interfaces.cache_clear()
