"""Contract: what the driver of docs/reference/middleware.md does when its broker or a node dies."""

from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
from graphs import InProcesses
from masters import Broker
from presence import need

pytestmark = pytest.mark.mqtt
TEXT = "std_msgs/msg/String"
LATCHED = {"durability": "transient_local", "depth": 1}


@pytest.fixture
def broker(tmp_path: Path, request: pytest.FixtureRequest) -> Iterator[Broker]:
    """A broker of this test's own."""
    need("mqtt", request.config)
    made = Broker(tmp_path)
    yield made
    made.close()


@pytest.fixture
def nodes(broker: Broker) -> Iterator[Any]:
    """A graph at that broker."""
    made = InProcesses("mqtt", broker.environment)
    yield made
    made.close()


def test_nodes_wait_for_their_broker_and_find_it_again(nodes: Any, broker: Broker) -> None:
    left, right = nodes.peer("left"), nodes.peer("right")
    assert not left.connected()
    assert left.log()[0] == f"waiting for the MQTT broker at 127.0.0.1:{broker.port}"
    left.advertise("/map", TEXT, **LATCHED)
    right.subscribe("/map", TEXT, **LATCHED)
    broker.start()
    nodes.wait_until(lambda: left.subscription_count("/map") == 1, "they find each other")
    left.publish("/map", {"data": "flat"})
    nodes.wait_until(lambda: right.received("/map") == [{"data": "flat"}], "the message arrives")
    broker.kill()
    nodes.wait_until(lambda: left.connection() == [True, False], "the loss is reported")
    broker.start()
    late = nodes.peer("late")
    late.subscribe("/map", TEXT, **LATCHED)
    nodes.wait_until(
        lambda: late.received("/map") == [{"data": "flat"}], "a broker without memory gets it again"
    )
    nodes.wait_until(lambda: left.subscription_count("/map") == 2, "all three are there")


def test_a_node_that_is_killed_is_gone(nodes: Any, broker: Broker) -> None:
    broker.start()
    left, right = nodes.peer("left"), nodes.peer("right")
    left.advertise("/odom", TEXT)
    right.subscribe("/odom", TEXT)
    nodes.wait_until(lambda: right.publisher_count("/odom") == 1, "they find each other")
    nodes.kill(left)
    nodes.wait_until(lambda: right.publisher_count("/odom") == 0, "its last will is done")
