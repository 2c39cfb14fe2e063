"""Properties and signals of mapped artifacts, on the graph inside the process."""

import math
from typing import Any

import pytest
from mapped_lab import mapped, settle
from robot_lab import Lab, Watcher

from jacaros.artifacts import ArtifactId, OperationFailed
from jacaros.artifacts.env.values import Structure
from jacaros.robots.mapping.decoding import MessageHandle
from jacaros.robots.ros.qos import LATCHED, QoS

POINT, SCAN = "geometry_msgs/msg/Point", "sensor_msgs/msg/LaserScan"


class Talk:
    """An observed mapped artifact, and a publisher."""

    def __init__(self, lab: Lab, artifact: ArtifactId, watcher: Watcher) -> None:
        self.lab, self.artifact, self.watcher = lab, artifact, watcher
        self.publishers: dict[str, Any] = {}

    async def say(self, topic: str, type_name: str, qos: QoS | None = None, **fields: Any) -> None:
        key = f"{topic} {type_name}"
        if key not in self.publishers:
            self.publishers[key] = self.lab.backend.publisher(topic, type_name, *([qos] if qos else []))
        self.publishers[key].publish(self.publishers[key].message(**fields))
        await settle()

    async def points(self, *xs: float) -> None:
        for x in xs:
            await self.say("p", POINT, x=x)

    async def scan(self, **fields: Any) -> None:
        await self.say("s", SCAN, **fields)

    def values(self, name: str = "a") -> list[tuple[object, ...]]:
        return self.watcher.values(name)

    @property
    def held(self) -> list[tuple[object, ...]]:
        return self.watcher.holds("a")

    @property
    def told(self) -> str:
        return "\n".join(self.lab.logged)


async def talk(lab: Lab, text: str, *arguments: object) -> Talk:
    artifact = await lab.make(mapped(text), *arguments)
    return Talk(lab, artifact, lab.watch(artifact))


def points(text: str) -> str:
    return f"properties: {{a: {{topic: p, type: {POINT}, fields: [x], {text}}}}}"


@pytest.mark.parametrize(
    ("policy", "xs", "shown"),
    [
        ("", (1, 1, 2), [1, 2]),
        ("rate: 2, latest_only: false", (1, 2, 3), [1, 3]),
        ("dead_band: 0.5", (1, 1.4, 1.6), [1, 1.6]),
    ],
)
async def test_a_property_is_there_from_the_first_message_on(
    lab: Lab, policy: str, xs: tuple[float, ...], shown: list[float]
) -> None:
    t = await talk(lab, points(policy))
    await settle()
    assert t.held == []
    await t.points(*xs)
    await lab.sleep(1)
    assert t.values() == [(x,) for x in shown]


async def test_on_demand_values_are_shown_by_operations_only_which_fail_without_a_message(lab: Lab) -> None:
    text = points("mode: on_demand") + "\noperations: {look: {refresh: a}}"
    t = await talk(lab, text)
    assert (await t.lab.call(t.artifact, "look")).reason == "no_message(5)"
    await t.points(1, 2)
    assert t.held == []
    await t.lab.do(t.artifact, "look")
    assert t.held == [(2,)]


async def test_a_property_expires(lab: Lab) -> None:
    t = await talk(lab, points("expire: 2"))
    await t.points(1)
    await t.lab.sleep(1.9)
    assert t.held == [(1,)]
    await t.lab.sleep(0.2)
    assert t.held == []
    await t.points(1)
    assert t.held == [(1,)]


ONE_TOPIC = f"""
properties:
  a: {{topic: p, type: {POINT}, fields: x}}
  b: {{topic: p, type: {POINT}, fields: [y, z]}}
signals:
  c: {{topic: p, type: {POINT}, fields: [x, y]}}
"""


async def test_one_subscription_serves_all_properties_of_a_topic(lab: Lab) -> None:
    t = await talk(lab, ONE_TOPIC)
    await t.say("p", POINT, x=1, y=2, z=3)
    assert (t.values("a"), t.values("b")) == ([(1,)], [(2, 3)])
    assert t.watcher.signals == [("c", (1, 2))]
    assert t.publishers[f"p {POINT}"].subscription_count == 1


async def test_a_number_that_is_not_finite_is_logged_once_with_the_line(lab: Lab) -> None:
    t = await talk(lab, points(""))
    await t.points(1, math.nan, math.nan)
    assert t.held == [(1,)]
    [line] = t.lab.logged
    assert "m.yaml:1:14: `a` is not shown: `x` is nan" in line
    assert "  = help: write a replacement: {path: x, otherwise: 0}" in line
    assert t.watcher.signals == [("bad_message", ("/p", Structure("not_finite", ("x",))))]


JOINTS = """
properties:
  a:
    topic: j
    type: sensor_msgs/msg/JointState
    each: name
    fields: [., '/position[i]']
"""


async def joints(t: Talk, **positions: float) -> None:
    await t.say("j", "sensor_msgs/msg/JointState", name=list(positions), position=list(positions.values()))


async def test_one_property_for_each_element(lab: Lab) -> None:
    t = await talk(lab, JOINTS)
    await joints(t, left=1, right=2)
    assert t.held == [("left", 1), ("right", 2)]
    await joints(t, left=1, right=3, top=4)
    last = t.watcher.observations[-1]
    assert [new.values for _, new in last.changed] == [("right", 3)]
    assert [new.values for new in last.added] == [("top", 4)]
    await joints(t, right=3)
    assert t.held == [("right", 3)]


async def test_dead_band_of_elements(lab: Lab) -> None:
    t = await talk(lab, JOINTS + "    dead_band: 0.5")
    await joints(t, left=1, right=2)
    await joints(t, left=1.1, right=3)
    assert t.held == [("left", 1), ("right", 3)]


PART = "{topic: j, type: sensor_msgs/msg/JointState, each: name, fields: [., '/position[i]'], when_changed: true}"


async def test_signals_for_each_element_and_for_changes_alone(lab: Lab) -> None:
    t = await talk(lab, f"signals: {{part: {PART}}}")
    await joints(t, left=1, right=2)
    await joints(t, left=1, right=3)
    assert t.watcher.signals == [("part", ("left", 1)), ("part", ("right", 2)), ("part", ("right", 3))]


@pytest.mark.parametrize(("arguments", "x"), [((), 1), (("r1",), 2), ((Structure("namespace", ("r1",)),), 2)])
async def test_names_are_below_the_namespace_unless_they_begin_with_a_slash(
    lab: Lab, arguments: tuple[object, ...], x: float
) -> None:
    text = f"""
namespace: usual
properties:
  a: {{topic: p, type: {POINT}, fields: x}}
  b: {{topic: /p, type: {POINT}, fields: x}}
"""
    t = await talk(lab, text, *arguments)
    for topic, each in (("/usual/p", 1), ("/r1/p", 2), ("/p", 3)):
        await t.say(topic, POINT, x=each)
    assert (t.values("a"), t.values("b")) == ([(x,)], [(3,)])


async def test_a_missing_type_is_found_when_a_node_publishes(lab: Lab) -> None:
    t = await talk(lab, "properties: {a: {topic: p, fields: x}}")
    await t.lab.sleep(4)
    assert "waiting for topic /p, to find its type" in t.told
    assert "m.yaml:1:25: no node uses topic /p" in t.told
    assert "write its type: type: package/msg/Type" in t.told
    await t.points(1)
    await t.lab.sleep(1)
    await t.points(2)
    assert t.held == [(2,)]


async def test_a_found_type_that_does_not_match_is_reported_with_the_line(lab: Lab) -> None:
    t = await talk(lab, "properties: {a: {topic: p, fields: x}}")
    await t.say("p", "std_msgs/msg/String")
    await t.lab.sleep(1)
    [line] = [line for line in t.lab.logged if "no field" in line]
    assert "m.yaml:1:36: `x`: std_msgs/msg/String has no field `x`" in line
    assert "  = help: its fields: data (string)" in line


@pytest.mark.parametrize(
    ("policy", "type_name", "fields", "why", "also"),
    [
        ("", "std_msgs/msg/String", {"data": "x"}, "std_msgs/msg/String", POINT),
        (
            "qos: latched",
            POINT,
            {"x": 1},
            "requests transient_local, the publisher offers volatile",
            "sensor_data",
        ),
    ],
    ids=["another type", "incompatible QoS"],
)
async def test_what_keeps_a_publisher_away_is_logged_once_with_the_line(
    lab: Lab, policy: str, type_name: str, fields: dict[str, Any], why: str, also: str
) -> None:
    t = await talk(lab, points(policy))
    for _ in range(3):
        await t.say("p", type_name, **fields)
    [line] = [line for line in t.lab.logged if why in line]
    assert "m.yaml:1:25: " in line
    assert also in line
    assert t.held == []


async def test_images_are_handles(lab: Lab) -> None:
    text = "properties: {a: {topic: i, type: sensor_msgs/msg/Image, fields: {path: ., as: object}}}"
    t = await talk(lab, text)
    await t.say("i", "sensor_msgs/msg/Image", data=[1, 2])
    [(found,)] = t.held
    assert isinstance(found, MessageHandle)
    assert list(found.value.data) == [1, 2]


async def test_a_wrong_mapping_cannot_be_made_into_an_artifact(lab: Lab) -> None:
    with pytest.raises(OperationFailed) as failed:
        await lab.make(mapped(f"properties: {{a: {{topic: p, type: {POINT}, fields: [u, v]}}}}"))
    assert f"m.yaml:1:68: error: `u`: {POINT} has no field `u`" in failed.value.message
    assert "`v`" in failed.value.message


async def test_connected_topics_are_shown(lab: Lab) -> None:
    t = await talk(lab, f"connected: true\n{points('')}")
    assert t.watcher.holds("connected") == []
    await t.points(1)
    await t.lab.sleep(1)
    assert t.watcher.holds("connected") == [("/p",)]


@pytest.mark.world("empty")
async def test_frames_are_properties_while_they_are_known(lab: Lab) -> None:
    text = """
frames:
  pose: {target: odom, source: base_link, rate: 4}
  heading: {target: odom, source: base_link, fields: {path: yaw, unit: degrees}, expire: 1}
"""
    t = await talk(lab, text)
    await t.lab.sleep(1)
    assert t.watcher.holds("pose") == [(0.0, 0.0, 0.0)]
    assert t.watcher.holds("heading") == [(0.0,)]


async def test_frames_get_the_prefix_of_the_robot(lab: Lab) -> None:
    text = "frames: {a: {target: map, source: base_link}, b: {target: /odom, source: base_link}}"
    t = await talk(lab, text, "r1")
    for parent, child, x, seconds in (("map", "r1/base_link", 1, 0.5), ("odom", "other/base_link", 2, 4)):
        header, transform = {"stamp": lab.clock.now(), "frame_id": parent}, {"translation": {"x": x}}
        lab.backend.tf_broadcast({"header": header, "child_frame_id": child, "transform": transform})
        await lab.sleep(seconds)
    assert t.values() == [(1, 0, 0)]
    assert t.watcher.holds("b") == []
    assert "m.yaml:1:47: `b` is unknown: " in t.told


@pytest.mark.parametrize(("qos", "told"), [("default", 1), ("latched", 0)])
async def test_stamps_of_latched_messages_may_be_old(lab: Lab, qos: str, told: int) -> None:
    t = await talk(
        lab, f"properties: {{a: {{topic: p, type: {POINT}Stamped, fields: [point.x], qos: {qos}}}}}"
    )
    old = {"stamp": t.lab.clock.now() - 60, "frame_id": "map"}
    await t.say("p", "geometry_msgs/msg/PointStamped", LATCHED, point={"x": 2}, header=old)
    await settle()
    assert t.held == [(2.0,)]
    assert sum("differs from our clock" in line for line in t.lab.logged) == told


async def test_otherwise_replaces_a_missing_element(lab: Lab) -> None:
    field = '{path: "ranges[2]", otherwise: range_max}'
    t = await talk(lab, f"properties: {{a: {{topic: s, type: {SCAN}, fields: [{field}]}}}}")
    for ranges in ([1.0, 2.0], [1.0, 2.0, 3.0], []):
        await t.scan(ranges=ranges, range_max=8.0)
    assert t.values() == [(8.0,), (3.0,), (8.0,)]


MISSING = f"""
properties:
  a: {{topic: s, type: {SCAN}, fields: ["ranges[0]"]}}
  b: {{topic: h, type: nav_msgs/msg/Path, fields: ["poses[0].header.frame_id"]}}
"""


async def test_a_missing_element_is_reported_with_help(lab: Lab) -> None:
    t = await talk(lab, MISSING)
    await t.scan()
    await t.say("h", "nav_msgs/msg/Path")
    assert '  = help: write a replacement: {path: "ranges[0]", otherwise: 0}' in t.told
    assert "  = help: read the list, or an element that always exists" in t.told


async def test_a_property_does_not_go_back_in_time_but_signals_are_sent(lab: Lab) -> None:
    part = "{topic: range, type: sensor_msgs/msg/Range, fields: [range]}"
    t = await talk(lab, f"properties: {{range: {part}}}\nsignals: {{ping: {part}}}")
    now = lab.clock.now()
    for value, later in enumerate((0, 0.2, 0.1, 0.2, 0.3), 1):
        await t.say("range", "sensor_msgs/msg/Range", range=value, header={"stamp": now + later})
        await lab.sleep(0.1)
    assert t.values("range") == [(1.0,), (2.0,), (4.0,), (5.0,)]
    signals = [(name, *map(str, values)) for name, values in t.watcher.signals]
    assert [value for name, value, *_ in signals if name == "ping"] == ["1.0", "2.0", "3.0", "4.0", "5.0"]
    assert [rest for name, *rest in signals if name == "bad_message"] == [["/range", "out_of_order(0.1)"]]


async def test_an_echo_too_near_to_be_measured_is_not_one_beyond_the_range(lab: Lab) -> None:
    field, inf = "{path: ranges, sample: 5, otherwise: range_max, round: 2}", math.inf
    t = await talk(lab, f"properties: {{a: {{topic: s, type: {SCAN}, fields: [{field}]}}}}")
    await t.scan(ranges=[-inf, inf, 1.0, math.nan, -inf], range_min=0.12, range_max=8.0)
    assert t.values() == [(0.12, 8.0, 1.0, 8.0, 0.12)]


async def test_smaller_numbers_than_the_least_become_it(lab: Lab) -> None:
    field = "{path: data, scale: -100, offset: 100, least: 0, round: 0}"
    t = await talk(lab, f"properties: {{a: {{topic: s, type: std_msgs/msg/Float64, fields: [{field}]}}}}")
    for variance in (0.0025, 0.25, 1.5):
        await t.say("s", "std_msgs/msg/Float64", data=variance)
    assert t.values() == [(100,), (75,), (0,)]
