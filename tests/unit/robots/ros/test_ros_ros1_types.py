"""Classes of ROS 1 packages, and services generated where no package has them."""

from pathlib import Path

import pytest

from jacaros.robots.ros.drivers.ros1.types import GenpySchema
from jacaros.robots.ros.errors import UnknownInterface
from jacaros.robots.ros.fields import FieldType
from jacaros.robots.ros.message import plain, to_seconds

pytest.importorskip(
    "genpy", reason="ROS 1 IS NOT TESTED: no genpy here; run tools/install_ros1.sh and use its venv"
)
pytestmark = pytest.mark.ros1

ADD = "example_interfaces/srv/AddTwoInts"


def define(folder: Path, type_name: str, text: str) -> None:
    package, kind, name = type_name.split("/")
    path = folder / package / kind / f"{name}.{kind}"
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(text)


@pytest.fixture(autouse=True)
def cache(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """The folder of generated classes."""
    monkeypatch.setenv("JACAROS_CACHE", str(tmp_path / "cache"))
    return tmp_path / "cache"


def test_the_generated_service_is_the_one_of_the_tutorials(cache: Path) -> None:
    kind = GenpySchema().service_class(ADD)
    assert kind._md5sum == "6a2e34150c00229791cc89ff309fff21"
    assert kind._type == "rospy_tutorials/AddTwoInts"
    [file] = (cache / "ros1").glob("*.py")
    written = file.stat().st_mtime_ns
    assert GenpySchema().service_class(ADD)._md5sum == kind._md5sum
    assert file.stat().st_mtime_ns == written


def test_it_works_without_a_writable_cache(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (tmp_path / "file").write_text("")
    monkeypatch.setenv("JACAROS_CACHE", str(tmp_path / "file"))
    assert GenpySchema().service_class(ADD)._request_class.__slots__ == ["a", "b"]


def test_services_of_the_users_folders_are_generated(tmp_path: Path) -> None:
    define(tmp_path, "shop/srv/Buy", "string what\nint32[] sizes\n---\nfloat64 price\n")
    schema = GenpySchema([tmp_path])
    assert schema.service_class("shop/srv/Buy")._type == "shop/Buy"
    request = schema.make("shop/srv/Buy_Request", {"what": "tea", "sizes": [1, 2]})
    assert plain(request) == {"what": "tea", "sizes": [1, 2]}
    with pytest.raises(UnknownInterface, match="shop/srv/Sell"):
        schema.service_class("shop/srv/Sell")


def test_times_look_as_on_ros2() -> None:
    schema = GenpySchema()
    factory = schema
    header = factory.make("std_msgs/msg/Header", {"stamp": {"sec": 3, "nanosec": 500_000_000}})
    assert to_seconds(header.stamp) == 3.5
    assert plain(header)["stamp"] == {"sec": 3, "nanosec": 500_000_000}
    assert schema.fields("std_msgs/msg/Header")["stamp"] == FieldType("builtin_interfaces/msg/Time")
    assert to_seconds(factory.make("builtin_interfaces/msg/Duration", {"sec": -1, "nanosec": 0})) == -1.0


def test_a_missing_package_is_named_and_debians_only_where_debian_has_it() -> None:
    with pytest.raises(UnknownInterface, match="; install no_such_msgs, or put its definition into a folder"):
        GenpySchema().new("no_such_msgs/msg/Thing")
    with pytest.raises(
        UnknownInterface, match=r"install nav_msgs \(on Debian: apt-get install python3-nav-msgs\), or"
    ):
        GenpySchema().new("nav_msgs/msg/NoSuchThing")


def test_octets_are_bytes() -> None:
    factory = GenpySchema()
    assert factory.make("sensor_msgs/msg/Image", {"data": [1, 255]}).data == b"\x01\xff"
    assert plain(factory.make("sensor_msgs/msg/Image", {"data": [7]}))["data"] == [7]


MOVE_BASE = """geometry_msgs/PoseStamped target_pose
---
---
geometry_msgs/PoseStamped base_position
"""
PARTS = ("Goal", "Result", "Feedback", "ActionGoal", "ActionResult", "ActionFeedback", "Action")


def test_an_installed_action_is_used(tmp_path: Path) -> None:
    messages = pytest.importorskip("move_base_msgs.msg")
    define(tmp_path, "move_base_msgs/action/MoveBase", "int8 other\n---\n---\n")
    schema = GenpySchema([tmp_path])
    assert schema.action_class("move_base_msgs/action/MoveBase", "ActionGoal") is messages.MoveBaseActionGoal
    assert type(schema.new("move_base_msgs/action/MoveBase_Goal")) is messages.MoveBaseGoal


def test_a_generated_action_is_the_genuine_one(tmp_path: Path) -> None:
    messages = pytest.importorskip("move_base_msgs.msg")
    genuine = {part: getattr(messages, f"MoveBase{part}")._md5sum for part in PARTS}
    define(tmp_path, "copied_msgs/action/MoveBase", MOVE_BASE)
    schema = GenpySchema([tmp_path])
    made = {part: schema.action_class("copied_msgs/action/MoveBase", part) for part in PARTS}
    assert {part: kind._md5sum for part, kind in made.items()} == genuine
    assert made["ActionGoal"]._type == "copied_msgs/MoveBaseActionGoal"
    assert type(made["Action"]().action_goal.goal) is made["Goal"]


def test_our_action_definitions_are_generated() -> None:
    factory = GenpySchema()
    goal = factory.make("nav2_msgs/action/NavigateToPose_Goal", {"pose": {"pose": {"position": {"x": 2}}}})
    assert goal.pose.pose.position.x == 2.0
    assert goal.pose.pose.orientation.w == 1.0
    feedback = factory.make("nav2_msgs/action/NavigateToPose_Feedback", {"navigation_time": 1.5})
    assert to_seconds(feedback.navigation_time) == 1.5
    result = factory.make("nav2_msgs/action/NavigateToPose_Result", {"error_code": 9001})
    assert result.error_code == result.FAILED_TO_LOAD_BEHAVIOR_TREE


def test_definitions_of_ros2_are_read_as_ros1_would_write_them(tmp_path: Path) -> None:
    define(
        tmp_path,
        "lab_msgs/msg/Spot",
        "# a place\nuint8 HERE=1 # in this room\nstring NAME=a # b\nstring<=8 name\nfloat64[<=3] place\n"
        'builtin_interfaces/Time seen\nstring<=4 AREA="x"\nbool known true\n',
    )
    define(tmp_path, "lab_msgs/msg/Spots", "std_msgs/Header header\nlab_msgs/Spot[] spots\nSpot best\n")
    define(tmp_path, "lab_msgs/srv/Find", "Spot like\n---\nSpot[] found\n")
    schema = GenpySchema([tmp_path])
    fields = {name: str(kind) for name, kind in schema.fields("lab_msgs/msg/Spot").items()}
    assert fields == {
        "name": "string",
        "place": "float64[]",
        "seen": "builtin_interfaces/msg/Time",
        "known": "bool",
    }
    factory = schema
    spots = factory.make("lab_msgs/msg/Spots", {"spots": [{"name": "door", "place": [1, 2]}]})
    assert spots.spots[0].HERE == 1
    assert plain(spots)["best"]["place"] == []
    assert plain(factory.make("lab_msgs/srv/Find_Request", {"like": {"name": "x"}}))["like"]["name"] == "x"


def test_unknown_and_faulty_actions_are_reported(tmp_path: Path) -> None:
    define(tmp_path, "lab_msgs/action/Cut", "int32 a\n---\n")
    define(tmp_path, "lab_msgs/action/Odd", "int33 a\n---\n---\n")
    schema = GenpySchema([tmp_path])
    with pytest.raises(UnknownInterface, match=r"no YActionAction\); is it x/action/Y\?; install"):
        schema.action_class("x/action/YAction", "Goal")
    with pytest.raises(
        UnknownInterface, match="invalid definition of lab_msgs/action/Cut: expected goal, result"
    ):
        schema.new("lab_msgs/action/Cut_Goal")
    with pytest.raises(UnknownInterface, match="lab_msgs/msg/int33"):
        schema.new("lab_msgs/action/Odd_Goal")
