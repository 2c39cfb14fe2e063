"""A property of a latched topic has the value that was published before it, or the log says why not."""

import pytest
from mapped_lab import mapped
from robot_lab import Lab

from jacaros.robots.ros.qos import LATCHED

PLACE = "properties:\n  place: {topic: /place, type: std_msgs/msg/String, fields: [data]}\n"
HEADED = "properties:\n  pose: {topic: /pose, type: geometry_msgs/msg/PointStamped, fields: [point.x]}\n"


async def test_a_property_has_the_value_that_was_published_before_it(lab: Lab) -> None:
    lab.backend.publisher("/place", "std_msgs/msg/String", LATCHED).publish({"data": "kitchen"})
    watcher = lab.watch(await lab.make(mapped(PLACE)))
    await lab.sleep(5)
    assert watcher.holds("place") == [("kitchen",)]
    assert lab.logged == []


async def test_messages_of_volatile_publishers_arrive_beside_it(lab: Lab) -> None:
    watcher = lab.watch(await lab.make(mapped(PLACE)))
    lab.backend.publisher("/place", "std_msgs/msg/String", LATCHED).publish({"data": "kitchen"})
    lab.backend.publisher("/place", "std_msgs/msg/String").publish({"data": "hall"})
    await lab.sleep(1)
    assert watcher.values("place") == [("hall",)] or watcher.holds("place") == [("hall",)]


async def test_the_old_stamp_of_a_latched_message_is_accepted(lab: Lab) -> None:
    message = {"header": {"stamp": lab.clock.now() - 3600.0}, "point": {"x": 2.0}}
    lab.backend.publisher("/pose", "geometry_msgs/msg/PointStamped", LATCHED).publish(message)
    watcher = lab.watch(await lab.make(mapped(HEADED)))
    await lab.sleep(1)
    assert watcher.holds("pose") == [(2.0,)]
    assert watcher.signals == []
    assert lab.logged == []


@pytest.mark.parametrize("qos", ["default", "sensor_data", "{durability: volatile}"])
async def test_a_property_that_asks_for_new_messages_only_says_what_it_misses(lab: Lab, qos: str) -> None:
    lab.backend.publisher("/place", "std_msgs/msg/String", LATCHED).publish({"data": "kitchen"})
    watcher = lab.watch(await lab.make(mapped(PLACE.replace("fields", f"qos: {qos}, fields"))))
    await lab.sleep(5)
    assert watcher.holds("place") == []
    [line] = lab.logged
    assert "no message on topic /place: /lab latches its messages" in line
    assert "help: write `qos: latched`" in line


async def test_a_message_before_the_first_look_is_enough(lab: Lab) -> None:
    publisher = lab.backend.publisher("/place", "std_msgs/msg/String", LATCHED)
    await lab.make(mapped(PLACE.replace("fields", "qos: default, fields")))
    publisher.publish({"data": "kitchen"})
    await lab.sleep(5)
    assert lab.logged == []
