"""`jacaros ros` on the graph of the embedded world."""

import json
from pathlib import Path

import pytest
from command_lab import Outcome, Told

from jacaros.runtime.cli.main import call

COMMAND = ("ros",)


def test_each_entry_is_listed_on_one_line(told: Told) -> None:
    lines = told("list", "--world", "house").splitlines()
    assert "topic /odom nav_msgs/msg/Odometry publishers=1 subscriptions=0" in lines
    assert "topic /cmd_vel geometry_msgs/msg/Twist publishers=0 subscriptions=1" in lines
    assert "action /navigate_to_pose nav2_msgs/action/NavigateToPose" in lines
    assert lines[-1] == "node /world"
    assert not any("jacaros_ros" in line for line in lines), "our own node is there for the look alone"


def test_environment_variables_select_the_graph(monkeypatch, outcome, told: Told):
    monkeypatch.setenv("JACAROS_WORLD", "two_robots")
    assert "action /robot_1/dock irobot_create_msgs/action/Dock" in told("list").splitlines()
    monkeypatch.setenv("JACAROS_ROS", "ros3")
    code, _, errors = outcome("list")
    assert code == 2
    assert "'ros3' is not one of" in errors


def test_rates_are_measured(told: Told) -> None:
    lines = told("list", "--rates").splitlines()
    assert "topic /odom nav_msgs/msg/Odometry publishers=1 subscriptions=0 rate=20" in lines
    assert "topic /scan sensor_msgs/msg/LaserScan publishers=1 subscriptions=0 rate=5" in lines


def test_the_list_is_available_as_json(told: Told) -> None:
    data = json.loads(told("list", "--world", "two_robots", "--json", "--rates"))
    assert set(data) == {"topics", "actions", "services", "nodes"}
    [odom] = [topic for topic in data["topics"] if topic["name"] == "/robot_1/odom"]
    ends = {"publishers": ["/world"], "subscriptions": []}
    assert odom == {"name": "/robot_1/odom", "types": ["nav_msgs/msg/Odometry"], **ends, "rate": 20.0}


def test_a_topic_is_shown_with_fields_units_endpoints_and_a_message(told: Told) -> None:
    text = told("show", "odom")
    lines = [" ".join(line.split()) for line in text.splitlines()]
    assert lines[:3] == [
        "topic /odom",
        "type: nav_msgs/msg/Odometry",
        "publishers: /world (reliable, volatile)",
    ]
    assert "latest message" in lines
    assert "pose.pose.position.x float64 m 0" in lines
    assert "twist.twist.angular.z float64 rad/s 0" in lines
    assert 'child_frame_id string "base_footprint"' in lines
    assert "- {path: pose.pose.orientation, as: yaw, unit: degrees, round: 1}" in lines


def test_long_lists_are_shortened(told: Told) -> None:
    data = json.loads(told("show", "/scan", "--json"))
    [ranges] = [row for row in data["parts"]["message"] if row["path"] == "ranges"]
    assert (ranges["type"], ranges["unit"]) == ("float32[]", "m")
    assert len(ranges["value"]["first"]) == 6
    assert ranges["value"]["length"] > 100


def test_an_action_is_shown_with_its_three_parts(told: Told) -> None:
    data = json.loads(told("show", "/navigate_to_pose", "--json"))
    assert list(data["parts"]) == ["goal", "result", "feedback"]
    assert {"path": "distance_remaining", "type": "float32", "unit": "m"} in data["parts"]["feedback"]
    assert "    action: navigate_to_pose" in data["mapping"]


def test_a_service_a_node_and_a_type_are_shown(told: Told) -> None:
    service = json.loads(told("show", "/map_server/map", "--json"))
    assert list(service["parts"]) == ["request", "response"]
    node = told("show", "/world")
    assert "publishes: /amcl_pose, /battery_state, " in node
    text = told("show", "sensor_msgs/BatteryState")
    assert text.startswith("type sensor_msgs/msg/BatteryState")
    assert "0 to 1" in text
    assert "entry for a mapping file" not in text


@pytest.mark.parametrize(
    ("arguments", "code", "text"),
    [
        (["show", "/odm"], 2, "unknown name: `/odm`\n  = help: did you mean `/odom`?"),
        (["show", "/robot_1/odom"], 2, "did you mean `/odom`?"),
        (["show", "/nonsense"], 2, "`jacaros ros list` shows all names"),
        (["show", "/o dom"], 2, "'/o dom' is not a ROS name"),
        (["show", "nonsense_msgs/Thing"], 1, "nonsense_msgs"),
        (["list", "--domain-id", "3"], 2, "--domain-id needs --ros ros2"),
        (["list", "--master", "http://robot.lab.example:11311"], 2, "--master needs --ros ros1"),
        (["list", "--ros", "ros2", "--world", "house"], 2, "jacaros sim"),
        (["list", "--world", "hose"], 1, "hose"),
        (["list", "--timeout", "0"], 2, "--timeout"),
        (["map", "/world"], 2, "`/world` is a node"),
        (
            ["map", "nav_msgs/msg/Odometry"],
            2,
            "a mapping file contains topics, services and actions",
        ),
    ],
)
def test_mistakes_are_reported(arguments: list[str], code: int, text: str, outcome: Outcome) -> None:
    got, output, errors = outcome(*arguments)
    assert (got, output) == (code, "")
    assert text in errors
    assert "Traceback" not in errors


def test_the_usual_things_of_a_robot_are_mapped(told: Told) -> None:
    text = told("map", "--world", "house")
    for name in ("odom", "scan", "battery", "map", "drive", "stop", "navigate_to", "dock", "undock", "pose"):
        assert f"\n  {name}:" in text
    assert "\nframes:\n" in text
    assert "action: move_base" not in text, "one action to drive is enough"
    assert "#   jacaros ros check robot.yaml --world house" in text


def test_the_file_names_what_it_leaves_out(told: Told) -> None:
    text = told("map", "--world", "house")
    _, _, left = text.partition("\n# Not in this file; `jacaros ros show NAME --world house` prints")
    lines = left.splitlines()
    assert "#   action /move_base" in lines
    assert sum(line.startswith(("#   action ", "#   topic ")) for line in lines) == 12
    assert lines[-1].startswith("#   and ")
    assert "/tf" not in left
    assert "/odom" not in left
    assert "not taken" not in told("map", "/odom", "--world", "house")


def test_each_robot_gets_an_artifact(told: Told) -> None:
    text = told("map", "/robot_0/odom", "/robot_1/cmd_vel", "--world", "two_robots")
    assert "\n  robot_0:\n    namespace: robot_0 " in text
    assert "\n  robot_1:\n    namespace: robot_1 " in text
    assert "        topic: odom\n" in text
    assert "        publish: cmd_vel\n" in text


def test_one_robot_in_a_namespace_needs_no_list_of_artifacts(told: Told) -> None:
    text = told("map", "odom", "scan", "--namespace", "robot_1", "--world", "two_robots")
    assert "\nnamespace: robot_1 " in text
    assert '# connected("/robot_1/odom") and so on' in text
    assert "    topic: scan\n" in text
    assert "artifacts:" not in text


def test_names_do_not_clash(told: Told) -> None:
    text = told("map", "/dock", "/dock_robot", "/navigate_to_pose", "/move_base", "/cmd_vel", "/goal_pose")
    for name in ("dock", "dock_robot", "navigate_to", "move_base", "drive", "goal_pose"):
        assert text.count(f"\n  {name}:") == 1
    assert "parameters: [x, y, yaw]" in text


def test_docking_of_a_kobuki_has_the_usual_name(told: Told) -> None:
    text = told("map", "/dock_drive_action", "--world", "house")
    assert "  dock:   " in text
    assert "outputs" not in text


def test_a_file_is_written_but_not_overwritten(tmp_path: Path, outcome: Outcome, told: Told) -> None:
    file = tmp_path / "robot.yaml"
    assert "wrote " in told("map", "/odom", "-o", str(file))
    first = file.read_text(encoding="utf-8")
    code, _, errors = outcome("map", "/scan", "-o", str(file))
    assert code == 2
    assert "--force overwrites it" in errors
    assert file.read_text(encoding="utf-8") == first
    told("map", "/scan", "-o", str(file), "--force")
    assert "LaserScan" in file.read_text(encoding="utf-8")


def test_a_field_is_shown_with_the_constants_that_name_its_values(capsys: pytest.CaptureFixture[str]) -> None:
    assert call(["ros", "show", "sensor_msgs/msg/BatteryState"]) == 0
    told = capsys.readouterr().out.splitlines()
    at = next(number for number, line in enumerate(told) if line.startswith("  power_supply_status "))
    assert told[at + 1 : at + 3] == [
        "      0 = POWER_SUPPLY_STATUS_UNKNOWN",
        "      1 = POWER_SUPPLY_STATUS_CHARGING",
    ]
    at = next(number for number, line in enumerate(told) if line.startswith("  voltage "))
    assert not told[at + 1].startswith("      ")


def test_constants_that_name_no_single_field_are_shown_after_the_fields(told: Told) -> None:
    shown = told("show", "visualization_msgs/msg/MarkerArray")
    _, others = shown.split("\nconstants of visualization_msgs/msg/Marker\n")
    assert others.splitlines()[:2] == ["      0 = ARROW", "      1 = CUBE"]
    assert "      9 = TEXT_VIEW_FACING" in others  # not the value of the string `text`
    data = json.loads(told("show", "visualization_msgs/msg/MarkerArray", "--json"))
    assert data["constants"]["visualization_msgs/msg/Marker"]["ARROW"] == 0
    assert "constants of" not in told("show", "sensor_msgs/msg/JoyFeedback")


def test_bounds_of_strings_and_lists_are_shown(told: Told) -> None:
    assert "string<=255" in told("show", "type_description_interfaces/msg/FieldType")
    assert "float64[<=3]" in told("show", "shape_msgs/msg/SolidPrimitive")
