"""Messages, types, requests and operations of the rosbridge protocol, without a connection."""

import math
from typing import Any

import cbor2
import pytest

pytest.importorskip("websockets")

from jacaros.robots.ros.protocols.rosbridge_messages import Translator
from jacaros.robots.ros.protocols.rosbridge_wire import Polled, Requests
from jacaros.robots.ros.typestore import DefinitionSchema

SCAN, IMAGE, STAMP = (
    "sensor_msgs/msg/LaserScan",
    "sensor_msgs/msg/CompressedImage",
    "builtin_interfaces/msg/Time",
)


@pytest.fixture
def schema() -> DefinitionSchema:
    """The message classes."""
    return DefinitionSchema(())


@pytest.fixture
def translator(schema: DefinitionSchema) -> Translator:
    """What is tested."""
    return Translator(schema)


def test_times_are_written_as_the_robots_ros_does_and_read_in_both_notations(
    schema: DefinitionSchema, translator: Translator
) -> None:
    time = schema.new(STAMP)
    time.sec, time.nanosec = 7, 9
    assert translator.encode(STAMP, time) == {"sec": 7, "nanosec": 9}
    translator.ros_version = 1
    assert translator.encode(STAMP, time) == {"secs": 7, "nsecs": 9}
    for written in ({"sec": 7, "nanosec": 9}, {"secs": 7, "nsecs": 9}):
        read = translator.decode(STAMP, written)
        assert (read.sec, read.nanosec) == (7, 9)


def test_octets_are_base64_and_null_is_not_a_number(translator: Translator) -> None:
    image = translator.decode(IMAGE, {"format": "png", "data": "AQID"})
    assert image.data.tolist() == [1, 2, 3]
    assert translator.encode(IMAGE, image)["data"] == "AQID"
    scan = translator.decode(SCAN, {"ranges": [1.0, None], "range_max": None})
    assert scan.ranges[0] == 1.0
    assert math.isnan(scan.ranges[1])
    assert math.isnan(scan.range_max)


def test_a_packed_array_is_read_with_its_infinite_numbers(translator: Translator) -> None:
    little_endian_float32 = cbor2.CBORTag(85, b"\x00\x00\x80\x3f\x00\x00\x80\x7f")
    scan = translator.decode(SCAN, cbor2.loads(cbor2.dumps({"ranges": little_endian_float32})))
    assert scan.ranges.tolist() == [1.0, math.inf]
    assert translator.packs(SCAN)
    assert not translator.packs("nav_msgs/msg/Odometry"), "servers lose arrays of a fixed length"


@pytest.mark.parametrize(
    ("value", "problem"),
    [
        ({"angle_min": "wide"}, "field angle_min of sensor_msgs/msg/LaserScan"),
        ({"ranges": 7}, "field ranges"),
        ({"header": {"stamp": 7}}, "field stamp of std_msgs/msg/Header"),
        (7, "expected a sensor_msgs/msg/LaserScan, found 7"),
    ],
)
def test_what_is_not_of_the_type_is_refused_with_the_name_of_the_field(
    translator: Translator, value: Any, problem: str
) -> None:
    with pytest.raises(ValueError, match=problem):
        translator.decode(SCAN, value)


@pytest.mark.parametrize(
    ("tag", "octets", "numbers"),
    [
        (64, b"\x01\xff", [1.0, 255.0]),
        (77, b"\xff\xff\x02\x00", [-1.0, 2.0]),
        (72, b"\xff\x02", [-1.0, 2.0]),
        (86, b"\x00" * 6 + b"\xf8\x3f", [1.5]),
    ],
)
def test_typed_arrays_of_all_kinds_are_read(
    translator: Translator, tag: int, octets: bytes, numbers: list[float]
) -> None:
    assert translator.decode(SCAN, {"ranges": cbor2.CBORTag(tag, octets)}).ranges.tolist() == numbers


@pytest.mark.parametrize("tag", [80, 85])
def test_half_an_element_and_a_kind_that_no_server_sends_are_refused(
    translator: Translator, tag: int
) -> None:
    with pytest.raises(ValueError, match="field ranges"):
        translator.decode(SCAN, {"ranges": cbor2.CBORTag(tag, b"\x00\x00\x00")})


class Rosapi:
    """Answers requests when a test wants."""

    def __init__(self) -> None:
        self.asked: list[str] = []
        self.requests = Requests(self._take)
        self.polled = Polled(
            self.requests, "/rosapi/subscribers", {}, lambda seen: len(seen["subscribers"]), 0
        )

    def _take(self, operation: dict[str, Any]) -> bool:
        self.asked.append(operation["id"])
        return True

    def answer(self, *subscribers: str) -> None:
        self.requests.answered({"id": self.asked[-1], "values": {"subscribers": list(subscribers)}})


def test_values_of_a_lost_connection_are_forgotten_and_requested_immediately() -> None:
    rosapi = Rosapi()
    assert rosapi.polled.value == 0
    rosapi.answer("/robot")
    assert rosapi.polled.value == 1
    rosapi.requests.fail_all()
    assert rosapi.polled.value == 0
    assert len(rosapi.asked) == 2
    rosapi.answer("/robot", "/other")
    assert rosapi.polled.value == 2


def test_an_answer_lost_with_the_connection_is_requested_again_immediately() -> None:
    rosapi = Rosapi()
    assert rosapi.polled.value == 0
    rosapi.requests.fail_all()
    assert rosapi.polled.value == 0
    assert len(rosapi.asked) == 2
    assert rosapi.polled.value == 0
    assert len(rosapi.asked) == 2
