"""Classes of ROS 1 packages, and services generated where no package has them."""

from pathlib import Path

import pytest

from jacaros.ros.backends.ros1_types import GenpySchema
from jacaros.ros.errors import UnknownInterface
from jacaros.ros.fields import FieldType
from jacaros.ros.message import MessageFactory, plain, to_seconds

pytest.importorskip(
    "genpy", reason="ROS 1 IS NOT TESTED: no genpy here; run tools/install_ros1.sh and use its venv"
)
pytestmark = pytest.mark.ros1

ADD = "example_interfaces/srv/AddTwoInts"


def test_the_generated_service_is_the_one_of_the_tutorials(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("JACAROS_CACHE", str(tmp_path))
    kind = GenpySchema().service_class(ADD)
    assert kind._md5sum == "6a2e34150c00229791cc89ff309fff21"
    assert kind._type == "rospy_tutorials/AddTwoInts"
    [file] = (tmp_path / "ros1").iterdir()
    written = file.stat().st_mtime_ns
    assert GenpySchema().service_class(ADD)._md5sum == kind._md5sum
    assert file.stat().st_mtime_ns == written


def test_a_cache_that_cannot_be_written_is_no_hindrance(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (tmp_path / "file").write_text("")
    monkeypatch.setenv("JACAROS_CACHE", str(tmp_path / "file"))
    assert GenpySchema().service_class(ADD)._request_class.__slots__ == ["a", "b"]


def test_services_of_the_users_folders_are_generated(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("JACAROS_CACHE", str(tmp_path / "cache"))
    (tmp_path / "shop" / "srv").mkdir(parents=True)
    (tmp_path / "shop" / "srv" / "Buy.srv").write_text("string what\nint32[] sizes\n---\nfloat64 price\n")
    schema = GenpySchema([tmp_path])
    assert schema.service_class("shop/srv/Buy")._type == "shop/Buy"
    request = MessageFactory(schema).make("shop/srv/Buy_Request", {"what": "tea", "sizes": [1, 2]})
    assert plain(request) == {"what": "tea", "sizes": [1, 2]}
    with pytest.raises(UnknownInterface, match="shop/srv/Sell"):
        schema.service_class("shop/srv/Sell")


def test_times_look_as_on_ros2() -> None:
    schema = GenpySchema()
    factory = MessageFactory(schema)
    header = factory.make("std_msgs/msg/Header", {"stamp": {"sec": 3, "nanosec": 500_000_000}})
    assert to_seconds(header.stamp) == 3.5
    assert plain(header)["stamp"] == {"sec": 3, "nanosec": 500_000_000}
    assert schema.fields("std_msgs/msg/Header")["stamp"] == FieldType("builtin_interfaces/msg/Time")
    assert to_seconds(factory.make("builtin_interfaces/msg/Duration", {"sec": -1, "nanosec": 0})) == -1.0


def test_a_missing_package_names_the_cure() -> None:
    with pytest.raises(UnknownInterface, match="apt-get install python3-no-such-msgs"):
        GenpySchema().new("no_such_msgs/msg/Thing")


def test_octets_are_bytes() -> None:
    factory = MessageFactory(GenpySchema())
    assert factory.make("sensor_msgs/msg/Image", {"data": [1, 255]}).data == b"\x01\xff"
    assert plain(factory.make("sensor_msgs/msg/Image", {"data": [7]}))["data"] == [7]
