"""Mapping files compared with message types: mismatches are reported with location and help."""

from pathlib import Path

import pytest

from jacaros.robots.mapping.checking import check_mapping
from jacaros.robots.mapping.file import MappingError, read_mapping
from jacaros.robots.mapping.interfaces import stored_interfaces
from jacaros.runtime.mas.mappings import check_mapping_file

ODOMETRY = "properties: {{a: {{topic: t, type: nav_msgs/msg/Odometry, {}}}}}"
BATTERY = "properties: {{a: {{topic: t, type: sensor_msgs/msg/BatteryState, {}}}}}"
TWIST = "operations: {{go: {{publish: t, type: geometry_msgs/msg/Twist, parameters: [v], {}}}}}"
GOAL = "operations: {{go: {{action: t, type: nav2_msgs/action/NavigateToPose, parameters: [v], {}}}}}"

WRONG = {
    "type": (
        "properties: {a: {topic: t, type: nav_msgs/msg/Odometri}}",
        "1:34: the type `nav_msgs/msg/Odometri` is not known here | did you mean `nav_msgs/msg/Odometry`?",
    ),
    "service type": (
        "operations: {a: {service: t, type: std_srvs/srv/Triger}}",
        "1:36: the type `std_srvs/srv/Triger` is not known here | did you mean `std_srvs/srv/Trigger`?",
    ),
    "action type": (
        "operations: {a: {action: t, type: nav2_msgs/action/NavigateToPos}}",
        "1:35: the type `nav2_msgs/action/NavigateToPos` is not known here | did you mean `nav2_msgs/action/NavigateToPose",
    ),
    "field": (
        ODOMETRY.format("fields: [pose.pose.positon.x]"),
        (
            "1:66: `pose.pose.positon.x`: geometry_msgs/msg/Pose has no field `positon` | did you mean `position`? "
            "Its fields: position (geometry_msgs/msg/Point), orientation (geometry_msgs/msg/Quaternion)"
        ),
    ),
    "names of a bool": (
        "properties: {a: {topic: t, type: std_msgs/msg/Bool, fields: [{path: data, names: {on: lit}}]}}",
        "1:62: `names` has 'on', but `data` is bool | write names: {true: lit}",
    ),
    "names of a number": (
        "properties: {a: {topic: t, type: std_msgs/msg/Int32, fields: [{path: data, names: {a: b}}]}}",
        "1:63: `names` has 'a', but `data` is int32 | write values of int32",
    ),
    "names of a text": (
        "operations: {a: {parameters: [x], publish: t, type: std_msgs/String, fields: {data: {value: $x, names: {1: b}}}}}",
        "1:85: `names` has 1, but `data` is string | write values of string",
    ),
    "unit of another kind": (
        ODOMETRY.format("fields: [{path: pose.pose.position.x, unit: degrees}]"),
        "1:66: messages have `pose.pose.position.x` in m, but degrees is a unit of angle | units of length are metres, ",
    ),
    "unit of a list": (
        "properties: {a: {topic: t, type: sensor_msgs/msg/LaserScan, fields: [{path: ranges, as: min, unit: percent}]}}",
        "1:70: messages have `ranges` in m, but percent is a unit of share",
    ),
    "unit of a stamp": (
        ODOMETRY.format("fields: [{path: header.stamp, unit: metres}]"),
        "1:66: messages have `header.stamp` in s, but metres is a unit of length",
    ),
    "degrees already": (
        "properties: {a: {topic: t, type: sensor_msgs/msg/NavSatFix, fields: [{path: latitude, unit: degrees}]}}",
        "1:70: messages already have `latitude` in degrees | leave `unit` out",
    ),
    "unit of a velocity": (
        TWIST.format("fields: {linear.x: {value: $v, unit: degrees}}"),
        "1:98: messages have `linear.x` in m/s, but degrees is a unit of angle | units of speed are metres_per_second, ",
    ),
    "field said twice": (
        TWIST.format("fields: {linear: [1, 2, 3], linear.x: $v}"),
        "1:117: `linear.x` is part of `linear` on line 1 | leave one of them out",
    ),
    "range of view of a wrong position": (
        ODOMETRY.format("range_of_view: {metres: 3, at: [pose.x, pose.y]}"),
        "1:72: `pose.x`: geometry_msgs/msg/PoseWithCovariance has no field `x`",
    ),
    "frame without a header": (
        "properties: {a: {topic: t, type: std_msgs/msg/String, frame: odom}}",
        "1:62: `frame` is for messages with a header, but std_msgs/msg/String has none | leave it out",
    ),
    "field of a number": (
        ODOMETRY.format("fields: [pose.pose.position.x.y]"),
        "1:66: `pose.pose.position.x.y`: pose.pose.position.x is float64 and has no fields | write pose.pose.position.x",
    ),
    "element of a number": (
        ODOMETRY.format("fields: ['pose.pose.position.x[0]']"),
        "1:66: `pose.pose.position.x[0]`: pose.pose.position.x is float64, not an array | write pose.pose.position.x",
    ),
    "element that is not there": (
        ODOMETRY.format("fields: ['pose.covariance[36]']"),
        (
            "1:66: `pose.covariance[36]`: pose.covariance has 36 elements | elements are pose.covariance[0] to "
            "pose.covariance[35]"
        ),
    ),
    "field of an array": (
        "properties: {a: {topic: t, type: tf2_msgs/msg/TFMessage, fields: [transforms.header]}}",
        (
            "1:67: `transforms.header`: transforms is an array, geometry_msgs/msg/TransformStamped[] | write "
            "transforms[0].header, or transforms[*].header for all"
        ),
    ),
    "yaw": (
        ODOMETRY.format("fields: {path: pose.pose.position, as: yaw}"),
        (
            "1:65: `as: yaw` is for quaternions, but `pose.pose.position` is geometry_msgs/msg/Point | name the field that "
            "is a geometry_msgs/msg/Quaternion, such as pose.pose.orientation"
        ),
    ),
    "unit": (
        ODOMETRY.format("fields: {path: header.frame_id, unit: degrees}"),
        "1:65: unit, scale or offset needs a number, but `header.frame_id` is string | name a field that is a number",
    ),
    "atom": (
        ODOMETRY.format("fields: {path: pose.pose.position.x, as: atom}"),
        "1:65: `as: atom` is for strings, but `pose.pose.position.x` is float64 | leave `as` out",
    ),
    "sample": (
        ODOMETRY.format("fields: {path: pose.pose.position.x, sample: 5}"),
        "1:65: `sample` is for lists, but `pose.pose.position.x` is float64 | name a field that is a list",
    ),
    "otherwise": (
        BATTERY.format("fields: {path: percentage, otherwise: location}"),
        "1:72: `otherwise` must be a number, but `location` is string | ",
    ),
    "constants": (
        BATTERY.format("fields: {path: present, as: name, prefix: X_}"),
        (
            "1:72: sensor_msgs/msg/BatteryState has no constant with the prefix `X_` | its constants: "
            "POWER_SUPPLY_STATUS_UNKNOWN, "
        ),
    ),
    "ambiguous constants": (
        BATTERY.format("fields: {path: present, as: name}"),
        (
            "1:72: sensor_msgs/msg/BatteryState: the constants `power_supply_status_unknown` and "
            "`power_supply_health_unknown` "
            "have the same value 0 | write prefix: ... with the common prefix of the constants of `present`, or names: "
            "{0: power_supply_health_unknown}"
        ),
    ),
    "each": (
        BATTERY.format("each: percentage"),
        "1:70: `each` is for arrays, but `percentage` is float32 | ",
    ),
    "range of view": (
        BATTERY.format("range_of_view: {metres: 1, distance: location}"),
        "1:79: `range_of_view` needs numbers, but `location` is string | ",
    ),
    "dead bands of all fields": (
        "properties: {a: {topic: t, type: geometry_msgs/msg/Point, dead_band: [1]}}",
        "1:14: `dead_band` has 1 values, but geometry_msgs/msg/Point has 3 fields | ",
    ),
    "target": (
        TWIST.format("fields: {linear.w: 1}"),
        "1:98: `linear.w`: geometry_msgs/msg/Vector3 has no field `w` | its fields: x (float64), y (float64), z (float64)",
    ),
    "constant": (
        TWIST.format("fields: {linear.x: fast}"),
        (
            "1:98: geometry_msgs/msg/Vector3: field x is float64, but 'fast' is given | write another value, or a "
            "parameter: $name"
        ),
    ),
    "constant by name": (
        "operations: {go: {publish: t, type: sensor_msgs/msg/Joy, fields: {header.stamp: now, 'buttons[0]': UP}}}",
        (
            "1:100: `buttons[0]` is int32, but 'UP' is not a constant of sensor_msgs/msg/Joy | write a number, or a "
            "parameter: $name"
        ),
    ),
    "truth": (
        "operations: {go: {service: s, type: std_srvs/srv/SetBool, request: {data: 'yes'}}}",
        (
            "1:75: `data` is bool, but 'yes' is not a constant of std_srvs/srv/SetBool_Request | write true or false, or a "
            "parameter: $name"
        ),
    ),
    "now": (
        TWIST.format("fields: {linear.x: now}"),
        "1:98: `now` is a time, but `linear.x` is float64 | write another value",
    ),
    "quaternion": (
        TWIST.format("fields: {angular: {value: $v, as: yaw}}"),
        (
            "1:97: `as: yaw` makes a quaternion, but `angular` is geometry_msgs/msg/Vector3 | name the field that is a "
            "geometry_msgs/msg/Quaternion, such as pose.pose.orientation"
        ),
    ),
    "goal": (
        GOAL.format("goal: {pose.pose.position: 3}"),
        (
            "1:113: geometry_msgs/msg/Pose: field position is geometry_msgs/msg/Point, but 3 is given | write another "
            "value, or a parameter: $name"
        ),
    ),
    "output": (
        GOAL.format("outputs: [error]"),
        "1:96: `error`: nav2_msgs/action/NavigateToPose_Result has no field `error` | did you mean `error_msg`?",
    ),
    "feedback": (
        GOAL.format("feedback: {left: [distance]}"),
        (
            "1:104: `distance`: nav2_msgs/action/NavigateToPose_Feedback has no field `distance` | did you mean "
            "`distance_remaining`? Its fields: current_pose"
        ),
    ),
    "success": (
        GOAL.format("success: ok"),
        "1:95: `ok`: nav2_msgs/action/NavigateToPose_Result has no field `ok` | its fields: ",
    ),
    "elements": (
        GOAL.format("goal: {pose: {each: $v, fields: {pose.x: $1}}}"),
        "1:99: `each` fills a list of messages, but `pose` is geometry_msgs/msg/PoseStamped | write a value",
    ),
}


def told(text: str) -> list[str]:
    with pytest.raises(MappingError) as caught:
        check_mapping(read_mapping(text, "m.yaml"), stored_interfaces())
    return [f"{p.line}:{p.column}: {p.message} | {p.help}" for p in caught.value.problems]


@pytest.mark.parametrize("name", WRONG)
def test_mismatches_are_reported_with_location_and_help(name: str) -> None:
    text, expected = WRONG[name]
    found = told(text)
    assert any(each.startswith(expected) for each in found), found


def test_all_problems_are_reported_in_one_pass() -> None:
    found = told(ODOMETRY.format("fields: [a, b]") + "\n" + TWIST.format("fields: {c: 1, d: 2}"))
    assert len(found) == 4


def test_types_known_only_to_the_robot_are_marked() -> None:
    [found] = told("properties: {a: {topic: t, type: acme_msgs/msg/Gripper}}")
    assert "the type `acme_msgs/msg/Gripper` is not known here" in found
    assert "interface_paths" in found


def test_a_unit_that_messages_do_not_usually_have_is_said() -> None:
    text = ODOMETRY.format("fields: [{path: pose.pose.position.x, unit: degrees, message_unit: radians}]")
    check_mapping(read_mapping(text), stored_interfaces())


@pytest.mark.parametrize("unit", ["meters", "[degrees]", "3", "{a: b}"])
def test_an_unknown_unit_does_not_stop_the_check_of_types(unit: str, tmp_path: Path) -> None:
    file = tmp_path / "m.yaml"
    head = "properties:\n  a:\n    topic: t\n    type: nav_msgs/msg/Odometry\n    fields:\n"
    field = f"      - {{path: pose.pose.position.x, unit: {unit}}}\n"
    file.write_text(f"{head}{field}      - pose.nothing\n", encoding="utf-8")
    messages = [each.message for each in check_mapping_file(file)]
    assert any(each.startswith("unknown unit") for each in messages)
    assert any("has no field `nothing`" in each for each in messages)


@pytest.mark.parametrize(
    ("line", "told"),
    [
        (
            "topic: b, type: sensor_msgs/msg/BatteryState, fields: [{path: voltage, unit: percent}]",
            "`voltage` in V",
        ),
        (
            "topic: j, type: sensor_msgs/msg/JointState, fields: [{path: 'position[0]', unit: percent}]",
            "rad or m",
        ),
    ],
)
def test_a_unit_that_the_message_cannot_be_converted_to_is_an_error(line: str, told: str) -> None:
    with pytest.raises(MappingError, match=told):
        check_mapping(read_mapping(f"properties: {{p: {{{line}}}}}"), stored_interfaces())


def test_a_joint_is_shown_in_degrees_or_millimetres() -> None:
    for unit in ("degrees", "millimetres"):
        fields = f"[{{path: 'position[0]', unit: {unit}}}]"
        line = f"properties: {{p: {{topic: j, type: sensor_msgs/msg/JointState, fields: {fields}}}}}"
        check_mapping(read_mapping(line), stored_interfaces())


@pytest.mark.parametrize("field", ["lifetime", "lifetime.sec"])
def test_a_duration_is_not_negative(field: str) -> None:
    line = (
        f"operations: {{mark: {{publish: m, type: visualization_msgs/msg/Marker, fields: {{{field}: -3}}}}}}"
    )
    with pytest.raises(MappingError, match="expected a duration that is not negative"):
        check_mapping(read_mapping(line), stored_interfaces())


@pytest.mark.parametrize(
    ("type_name", "field", "why"),
    [
        ("sensor_msgs/Joy", "'buttons[0]': 3000000000", "it must be from -2147483648 to 2147483647"),
        ("sensor_msgs/JoyFeedback", "id: {value: 30, scale: 0.1}", "it must be from 0 to 255"),
        ("sensor_msgs/JoyFeedback", "type: {value: $x, names: {300: loud}}", "`names` has 300"),
        ("shape_msgs/SolidPrimitive", "dimensions: [1, 2, 3, 4]", "but 4 elements are given"),
        ("shape_msgs/SolidPrimitive", "'dimensions[3]': 1", "dimensions has at most 3 elements"),
        (
            "type_description_interfaces/msg/FieldType",
            f"nested_type_name: {256 * 'x'}",
            "string<=255, but a string of 256 characters is given",
        ),
    ],
)
def test_a_value_outside_the_range_of_its_field_is_refused(type_name: str, field: str, why: str) -> None:
    line = f"operations: {{o: {{parameters: [x], publish: t, type: {type_name}, fields: {{{field}}}}}}}"
    line = line if "$x" in line else line.replace("parameters: [x], ", "")
    with pytest.raises(MappingError) as caught:
        check_mapping(read_mapping(line), stored_interfaces())
    assert why in str(caught.value)


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
