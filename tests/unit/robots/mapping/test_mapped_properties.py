"""Properties and signals of mapped artifacts, on the graph inside the process."""

import math
from typing import Any

import pytest
from mapped_lab import mapped, settle
from robot_lab import Lab, Watcher, in_lab

from jacaros.artifacts import ArtifactId, OperationFailed
from jacaros.artifacts.env.values import Atom, Structure
from jacaros.robots.mapping.decoding import MessageHandle
from jacaros.robots.ros.qos import LATCHED, QoS

POINT = "geometry_msgs/msg/Point"


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

    async def points(self, *xs: float, pause: float = 0.0) -> None:
        for x in xs:
            await self.say("p", POINT, x=x)
            if pause:
                await self.lab.sleep(pause)

    def values(self, name: str = "a") -> list[tuple[object, ...]]:
        return self.watcher.values(name)

    @property
    def held(self) -> list[tuple[object, ...]]:
        return self.watcher.holds("a")


async def talk(lab: Lab, text: str, *arguments: object) -> Talk:
    artifact = await lab.make(mapped(text), *arguments)
    return Talk(lab, artifact, lab.watch(artifact))


def points(text: str) -> str:
    return f"properties: {{a: {{topic: p, type: {POINT}, fields: [x], {text}}}}}"


async def test_a_property_is_there_from_the_first_message_on(lab: Lab) -> None:
    t = await talk(lab, points(""))
    await settle()
    assert t.held == []
    await t.points(1, 1, 2)
    assert t.values() == [(1,), (2,)]


async def test_initial_values(lab: Lab) -> None:
    t = await talk(lab, points("initial: [0]"))
    assert t.held == [(0,)]
    await t.points(1)
    assert t.held == [(1,)]


async def test_rate(lab: Lab) -> None:
    t = await talk(lab, points("rate: 2, latest_only: false"))
    await t.points(1, 2, 3)
    await lab.sleep(1)
    assert t.values() == [(1,), (3,)]


async def test_dead_band(lab: Lab) -> None:
    t = await talk(lab, points("dead_band: 0.5"))
    await t.points(1, 1.4, 1.6)
    assert t.values() == [(1,), (1.6,)]


async def test_on_demand_values_are_shown_by_operations_only(lab: Lab) -> None:
    text = points("mode: on_demand") + "\noperations: {look: {refresh: a}, get: {read: a}}"
    t = await talk(lab, text)
    await t.points(1, 2)
    assert t.held == []
    await t.lab.do(t.artifact, "look")
    assert t.held == [(2,)]


async def test_refresh_fails_when_no_message_comes(lab: Lab) -> None:
    t = await talk(lab, points("mode: on_demand") + "\noperations: {look: {refresh: a}}")
    assert (await t.lab.call(t.artifact, "look")).reason == "no_message(5)"


async def test_a_property_expires(lab: Lab) -> None:
    t = await talk(lab, points("expire: 2"))
    await t.points(1)
    await t.lab.sleep(1.9)
    assert t.held == [(1,)]
    await t.lab.sleep(0.2)
    assert t.held == []
    await t.points(1)
    assert t.held == [(1,)]


async def test_one_subscription_serves_all_properties_of_a_topic(lab: Lab) -> None:
    text = f"""
properties:
  a: {{topic: p, type: {POINT}, fields: x}}
  b: {{topic: p, type: {POINT}, fields: [y, z]}}
signals:
  c: {{topic: p, type: {POINT}, fields: [x, y]}}
"""
    t = await talk(lab, text)
    await t.say("p", POINT, x=1, y=2, z=3)
    assert (t.values("a"), t.values("b")) == ([(1,)], [(2, 3)])
    assert t.watcher.signals == [("c", (1, 2))]
    assert t.publishers[f"p {POINT}"].subscription_count == 1


async def test_annotations_of_the_belief(lab: Lab) -> None:
    text = """
properties:
  a:
    topic: p
    type: geometry_msgs/msg/PointStamped
    fields: [point.x]
    annotations: {frame: header.frame_id, at: {path: header.stamp}}
"""
    t = await talk(lab, text)
    header = {"frame_id": "map", "stamp": 3.5}
    await t.say("p", "geometry_msgs/msg/PointStamped", point={"x": 1}, header=header)
    [added] = t.watcher.observations[-1].added
    assert added.annotations == (Structure("frame", ("map",)), Structure("at", (3.5,)))
    await t.say("p", "geometry_msgs/msg/PointStamped", point={"x": 2}, header={**header, "stamp": 4})
    [(_, now)] = t.watcher.observations[-1].changed
    assert now.annotations[1] == Structure("at", (4.0,))


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
    {}
"""


async def joints(t: Talk, **positions: float) -> None:
    await t.say("j", "sensor_msgs/msg/JointState", name=list(positions), position=list(positions.values()))


async def test_one_property_for_each_element(lab: Lab) -> None:
    t = await talk(lab, JOINTS.format(""))
    await joints(t, left=1, right=2)
    assert t.held == [("left", 1), ("right", 2)]
    await joints(t, left=1, right=3, top=4)
    last = t.watcher.observations[-1]
    assert [new.values for _, new in last.changed] == [("right", 3)]
    assert [new.values for new in last.added] == [("top", 4)]
    await joints(t, right=3)
    assert t.held == [("right", 3)]


async def test_elements_that_are_not_seen_expire(lab: Lab) -> None:
    t = await talk(lab, JOINTS.format("expire: 2"))
    await joints(t, left=1)
    await t.lab.sleep(1.5)
    await joints(t, right=2)
    assert t.held == [("left", 1), ("right", 2)]
    await t.lab.sleep(0.6)
    assert t.held == [("right", 2)]
    await t.lab.sleep(1.5)
    assert t.held == []


async def test_dead_band_of_elements(lab: Lab) -> None:
    t = await talk(lab, JOINTS.format("dead_band: 0.5"))
    await joints(t, left=1, right=2)
    await joints(t, left=1.1, right=3)
    assert t.held == [("left", 1), ("right", 3)]


POSES = """
properties:
  here: {topic: p, type: geometry_msgs/msg/Point, fields: [x, y]}
  a:
    topic: seen
    type: geometry_msgs/msg/PoseArray
    each: poses
    fields: [position.x, position.y]
    range_of_view: {metres: 2, at: [position.x, position.y]FROM}
"""


async def seen(t: Talk, *xs: float) -> None:
    await t.say("seen", "geometry_msgs/msg/PoseArray", poses=[{"position": {"x": x}} for x in xs])


async def test_only_what_is_near_the_robot_is_in_view(lab: Lab) -> None:
    t = await talk(lab, POSES.replace("FROM", ""))
    await seen(t, 1, 2, 3)
    assert t.held == [(1, 0), (2, 0)]


async def test_the_view_moves_with_a_property(lab: Lab) -> None:
    t = await talk(lab, POSES.replace("FROM", ", from: here"))
    await seen(t, 1, 4, 9)
    assert t.held == []
    await t.say("p", POINT, x=5)
    assert t.held == [(4, 0)]
    await t.say("p", POINT, x=8)
    assert t.held == [(9, 0)]


async def test_the_view_by_a_distance(lab: Lab) -> None:
    view = "range_of_view: {metres: 1, distance: range}"
    text = f"properties: {{a: {{topic: r, type: sensor_msgs/msg/Range, fields: range, {view}}}}}"
    t = await talk(lab, text)
    for distance in (0.5, 2, 0.75):
        await t.say("r", "sensor_msgs/msg/Range", range=distance)
        assert t.held == ([] if distance == 2 else [(distance,)])


async def test_signals_for_each_element_and_for_changes_alone(lab: Lab) -> None:
    text = """
signals:
  part: {topic: j, type: sensor_msgs/msg/JointState, each: name, fields: [., "/position[i]"], when_changed: true}
"""
    t = await talk(lab, text)
    await joints(t, left=1, right=2)
    await joints(t, left=1, right=3)
    assert t.watcher.signals == [("part", ("left", 1)), ("part", ("right", 2)), ("part", ("right", 3))]


async def test_signals_at_most_so_often(lab: Lab) -> None:
    text = f"signals: {{a: {{topic: p, type: {POINT}, fields: x, rate: 1}}}}"
    t = await talk(lab, text)
    await t.points(1, 2, 3)
    assert [arguments for _, arguments in t.watcher.signals] == [(1,)]
    await t.lab.sleep(1.1)
    assert [arguments for _, arguments in t.watcher.signals] == [(1,), (3,)], (
        "the last of a burst is not lost"
    )
    await t.lab.sleep(3)
    await t.points(4)
    assert [arguments for _, arguments in t.watcher.signals] == [(1,), (3,), (4,)]


async def test_a_change_within_the_pause_of_signals_is_not_lost(lab: Lab) -> None:
    text = f"signals: {{a: {{topic: p, type: {POINT}, fields: x, rate: 1, when_changed: true}}}}"
    t = await talk(lab, text)
    await t.points(1, 1, 0)
    assert [arguments for _, arguments in t.watcher.signals] == [(1,)]
    await t.lab.sleep(1.1)
    assert [arguments for _, arguments in t.watcher.signals] == [(1,), (0,)]
    await t.lab.sleep(2)
    await t.points(0)
    assert len(t.watcher.signals) == 2


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
    assert any("waiting for topic /p, to find its type" in line for line in t.lab.logged)
    assert any("m.yaml:1:25: no node uses topic /p" in line for line in t.lab.logged)
    assert any("write its type: type: package/msg/Type" in line for line in t.lab.logged)
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


async def test_another_type_at_the_topic_is_logged_once_with_the_line(lab: Lab) -> None:
    t = await talk(lab, points(""))
    for _ in range(3):
        await t.say("p", "std_msgs/msg/String", data="x")
    [line] = [line for line in t.lab.logged if "std_msgs/msg/String" in line]
    assert "m.yaml:1:25: " in line
    assert POINT in line


async def test_an_incompatible_qos_is_logged_once_with_the_line(lab: Lab) -> None:
    t = await talk(lab, points("qos: latched"))
    for _ in range(3):
        await t.say("p", POINT, x=1)
    [line] = [line for line in t.lab.logged if "transient_local" in line]
    assert "m.yaml:1:25: " in line
    assert t.held == []


async def test_the_last_message_of_a_latched_topic_waits(lab: Lab) -> None:
    publisher = lab.backend.publisher("p", POINT, LATCHED)
    publisher.publish(publisher.message(x=4))
    artifact = await lab.make(mapped(points("qos: latched")))
    watcher = lab.watch(artifact)
    await settle()
    assert watcher.holds("a") == [(4,)]


async def test_images_are_handles(lab: Lab) -> None:
    text = "properties: {a: {topic: i, type: sensor_msgs/msg/Image, fields: {path: ., as: object}}}"
    t = await talk(lab, text)
    await t.say("i", "sensor_msgs/msg/Image", data=[1, 2])
    [(found,)] = t.held
    assert isinstance(found, MessageHandle)
    assert list(found.value.data) == [1, 2]


async def test_names_of_constants_are_atoms(lab: Lab) -> None:
    text = "properties: {a: {topic: b, type: sensor_msgs/msg/BatteryState, fields: {path: power_supply_status, as: name}}}"
    t = await talk(lab, text)
    await t.say("b", "sensor_msgs/msg/BatteryState", power_supply_status=4)
    assert t.held == [(Atom("full"),)]
    assert isinstance(t.held[0][0], Atom)


def test_a_wrong_mapping_cannot_be_made_into_an_artifact() -> None:
    async def body(lab: Lab) -> None:
        try:
            await lab.make(mapped(f"properties: {{a: {{topic: p, type: {POINT}, fields: [u, v]}}}}"))
        except OperationFailed as failure:
            lab.logged.append(failure.message)

    [message] = in_lab(body, None).logged
    assert f"m.yaml:1:68: error: `u`: {POINT} has no field `u`" in message
    assert "`v`" in message


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

    async def transform(parent: str, child: str, x: float) -> None:
        lab.backend.tf_broadcast(
            {
                "header": {"stamp": lab.clock.now(), "frame_id": parent},
                "child_frame_id": child,
                "transform": {"translation": {"x": x}},
            }
        )
        await settle()

    await transform("map", "r1/base_link", 1)
    await lab.sleep(0.5)
    assert t.held == [(1, 0, 0)]
    await transform("odom", "other/base_link", 2)
    await lab.sleep(4)
    assert t.watcher.holds("b") == []
    assert any("m.yaml:1:47: `b` is unknown: " in line for line in lab.logged)


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


async def test_parameters_of_a_missing_node_are_logged_once(lab: Lab) -> None:
    t = await talk(lab, "parameters: {a: {node: lob, parameter: speed}}")
    await t.lab.sleep(25)
    [told] = t.lab.logged
    assert told.endswith(
        "m.yaml:1:14: `a` is not known yet: node /lob does not answer; still trying\n"
        "    1 | parameters: {a: {node: lob, parameter: speed}}\n"
        "                     ^\n"
        "  = help: is the node running, and is this its name?"
    )


async def test_parameters_of_nodes_are_properties_that_follow(lab: Lab) -> None:
    from jacaros.robots.ros.parameter import DeclaredParameter

    text = "parameters: {a: {node: lab, parameter: speed, fields: {path: ., unit: centimetres}}}"
    t = await talk(lab, text)
    await t.lab.sleep(3)
    assert t.held == []
    own = t.lab.backend.parameters()
    own.declare("speed", DeclaredParameter(0.5))
    await t.lab.sleep(2)
    assert t.held == [(50.0,)]
    await own.set("speed", 0.75)
    await settle()
    assert t.held == [(75.0,)]
    own.withdraw("speed")
    own.declare("speed", DeclaredParameter("fast"))
    await t.lab.sleep(2)
    assert t.held == []
    told = "\n".join(t.lab.logged)
    assert '`a` is not shown: parameter `speed`: expected a number, found "fast"' in told
    assert "Traceback" not in told


async def test_otherwise_replaces_a_missing_element(lab: Lab) -> None:
    field = '{path: "ranges[2]", otherwise: range_max}'
    text = f"properties: {{a: {{topic: s, type: sensor_msgs/msg/LaserScan, fields: [{field}]}}}}"
    t = await talk(lab, text)
    for ranges in ([1.0, 2.0], [1.0, 2.0, 3.0], []):
        await t.say("s", "sensor_msgs/msg/LaserScan", ranges=ranges, range_max=8.0)
    assert t.values() == [(8.0,), (3.0,), (8.0,)]


async def test_a_missing_element_is_reported_with_help(lab: Lab) -> None:
    text = (
        "properties:\n"
        '  a: {topic: s, type: sensor_msgs/msg/LaserScan, fields: ["ranges[0]"]}\n'
        '  b: {topic: h, type: nav_msgs/msg/Path, fields: ["poses[0].header.frame_id"]}\n'
    )
    t = await talk(lab, text)
    await t.say("s", "sensor_msgs/msg/LaserScan")
    await t.say("h", "nav_msgs/msg/Path")
    told = "\n".join(t.lab.logged)
    assert '  = help: write a replacement: {path: "ranges[0]", otherwise: 0}' in told
    assert "  = help: read the list, or an element that always exists" in told


async def test_a_weak_publisher_is_reported_with_help(lab: Lab) -> None:
    text = "properties: {a: {topic: s, type: std_msgs/msg/String, qos: latched}}"
    t = await talk(lab, text)
    await t.say("s", "std_msgs/msg/String", data="x")
    told = "\n".join(t.lab.logged)
    assert "requests transient_local, the publisher offers volatile" in told
    assert "  = help: write qos: sensor_data, which is compatible with any publisher" in told


async def test_what_has_no_place_is_out_of_view(lab: Lab) -> None:
    view = 'range_of_view: {metres: 3, distance: "ranges[1]"}'
    text = f"properties: {{a: {{topic: s, type: sensor_msgs/msg/LaserScan, fields: [range_max], {view}}}}}"
    t = await talk(lab, text)
    await t.say("s", "sensor_msgs/msg/LaserScan", ranges=[1.0], range_max=1.0)
    assert t.held == []
    await t.say("s", "sensor_msgs/msg/LaserScan", ranges=[1.0, 2.0], range_max=2.0)
    assert t.held == [(2.0,)]
    assert t.lab.logged == []


async def test_a_property_does_not_go_back_in_time_but_signals_are_sent(lab: Lab) -> None:
    text = """
properties:
  range: {topic: range, type: sensor_msgs/msg/Range, fields: [range]}
signals:
  ping: {topic: range, type: sensor_msgs/msg/Range, fields: [range]}
"""
    artifact = await lab.make(mapped(text))
    watcher = lab.watch(artifact)
    publisher = lab.backend.publisher("range", "sensor_msgs/msg/Range")
    now = lab.clock.now()
    for value, stamp in (
        (1.0, now),
        (2.0, now + 0.2),
        (3.0, now + 0.1),
        (4.0, now + 0.2),
        (5.0, now + 0.3),
    ):
        publisher.publish(publisher.message(range=value, header={"stamp": stamp}))
        await lab.sleep(0.1)
    assert watcher.values("range") == [(1.0,), (2.0,), (4.0,), (5.0,)]
    signals = [(name, *map(str, values)) for name, values in watcher.signals]
    assert [value for name, value, *_ in signals if name == "ping"] == ["1.0", "2.0", "3.0", "4.0", "5.0"]
    assert [rest for name, *rest in signals if name == "bad_message"] == [["/range", "out_of_order(0.1)"]]


async def test_an_echo_too_near_to_be_measured_is_not_one_beyond_the_range(lab: Lab) -> None:
    text = """
properties:
  ranges:
    topic: scan
    type: sensor_msgs/msg/LaserScan
    fields: [{path: ranges, sample: 5, otherwise: range_max, round: 2}]
"""
    artifact = await lab.make(mapped(text))
    watcher = lab.watch(artifact)
    publisher = lab.backend.publisher("scan", "sensor_msgs/msg/LaserScan")
    inf = math.inf
    publisher.publish(
        publisher.message(ranges=[-inf, inf, 1.0, math.nan, -inf], range_min=0.12, range_max=8.0)
    )
    await settle()
    assert watcher.values("ranges") == [(0.12, 8.0, 1.0, 8.0, 0.12)]
