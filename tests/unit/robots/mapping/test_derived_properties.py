"""Derived properties and signals of mapping files: end to end on the virtual clock, and what is wrong with declarations."""

from typing import Any

import pytest
from mapped_lab import mapped, settle
from robot_lab import Lab, Watcher, made

from jacaros.robots.mapping.file import MappingError, read_mapping

POINT = "geometry_msgs/msg/PointStamped"
MAPPING = f"""
properties:
  a: {{topic: a, type: {POINT}, fields: [point.x], dead_band: 100}}
  b: {{topic: b, type: {POINT}, fields: [point.x]}}
signals:
  hit: {{topic: hit, type: {POINT}, fields: [point.x]}}
"""


class Sender:
    """An observed mapped artifact, and publishers."""

    def __init__(self, lab: Lab, watcher: Watcher) -> None:
        self.lab, self.watcher = lab, watcher
        self.publishers: dict[str, Any] = {}

    def signals(self, name: str) -> list[str]:
        """The signals of that name, so far."""
        return [each for each in map(str, self.watcher.signals) if name in each]

    async def send(self, topic: str, x: float, ago: float = 0.0) -> None:
        """Publish a value whose stamp is *ago* seconds old."""
        if topic not in self.publishers:
            self.publishers[topic] = self.lab.backend.publisher(topic, POINT)
            await settle()
        publisher = self.publishers[topic]
        now = self.lab.clock.now() - ago
        stamp = {"sec": int(now), "nanosec": round(now % 1 * 1e9)}
        publisher.publish(publisher.message(header={"stamp": stamp}, point={"x": x}))
        await settle()


async def derived(lab: Lab, entry: str) -> Sender:
    """Make an artifact whose mapping derives *entry*."""
    artifact = await lab.make(mapped(f"{MAPPING}derived:\n  {entry}\n"))
    return Sender(lab, lab.watch(artifact))


async def test_a_count_of_signals_comes_and_goes_with_the_window(lab: Lab) -> None:
    s = await derived(lab, "often: {count: hit, within: 2.5, at_least: 3}")
    for _ in range(3):
        await s.send("hit", 1.0)
        await s.lab.sleep(0.5)
    assert s.watcher.holds("often") == [()]
    await s.lab.sleep(0.9)
    assert s.watcher.holds("often") == [()]
    await s.lab.sleep(0.2)
    await settle()
    assert s.watcher.holds("often") == []


async def test_messages_count_that_a_dead_band_drops(lab: Lab) -> None:
    s = await derived(lab, "number: {count: a, within: 10}")
    for x in (1.0, 2.0, 6.0):
        await s.send("a", x)
    assert s.watcher.values("number") == [(1,), (2,), (3,)]
    await s.lab.sleep(10.1)
    await settle()
    assert s.watcher.holds("number") == []


async def test_stamps_count_and_not_arrivals(lab: Lab) -> None:
    s = await derived(lab, "recent: {count: a, within: 2.5}")
    await s.send("a", 1.0)
    await s.lab.sleep(2.0)
    await s.send("a", 3.0, ago=1.0)
    assert s.watcher.holds("recent") == [(2,)]
    await s.lab.sleep(1.6)  # longer than the window after its stamp, not after its arrival
    await settle()
    assert s.watcher.holds("recent") == []


async def test_a_message_that_took_long_counts_although_the_window_has_moved(lab: Lab) -> None:
    s = await derived(lab, "many: {count: a, within: 1}")
    await s.send("a", 1.0)
    await s.lab.sleep(1.0)
    await settle()
    assert s.watcher.holds("many") == []
    await s.send("a", 1.0, ago=0.15)
    assert s.watcher.holds("many") == [(1,)]


async def test_topics_come_together_by_their_stamps(lab: Lab) -> None:
    s = await derived(lab, "joined: {together: [a, b], within: 0.05}")
    await s.lab.sleep(1.0)
    await s.send("b", 10.0)
    await s.lab.sleep(0.1)
    await s.send("a", 1.0, ago=0.08)
    await s.send("a", 2.0)
    assert s.watcher.values("joined") == [(1.0, 10.0)]


async def test_entries_may_be_derived_of_those_above(lab: Lab) -> None:
    low = "low: {hysteresis: a, on_below: 10, off_above: 20}"
    s = await derived(lab, f"{low}\n  unsteady: {{count: low, within: 5, at_least: 2}}")
    for x in (5.0, 50.0, 5.0):
        await s.send("a", x)
    assert s.watcher.holds("unsteady") == [()]


FAR = """
frames: {pose: {target: map, source: base_link}}
derived: {far: {hysteresis: pose, on_above: 1.5, off_below: 0.5}}
"""


@made(mapped(FAR))
async def test_frames_are_streams(lab: Lab, watcher: Watcher) -> None:
    seen = []
    for x in (0.0, 1.6, 0.8, 0.4):
        await _stand(lab, x)
        await lab.sleep(0.5)
        seen.append(watcher.holds("far") == [()])
    assert seen == [False, True, True, False]


async def _stand(lab: Lab, x: float) -> None:
    """Send the transform of a robot that stands at x metres now."""
    header = {"stamp": lab.clock.now(), "frame_id": "map"}
    transform = {"translation": {"x": x}}
    lab.backend.tf_broadcast({"header": header, "child_frame_id": "base_link", "transform": transform})
    await settle()


def _problems(entry: str) -> list[str]:
    with pytest.raises(MappingError) as caught:
        read_mapping(f"{MAPPING}derived:\n  {entry}\n", "m.yaml")
    return [f"{p.column}: {p.message} | {p.help}" for p in caught.value.problems]


@pytest.mark.parametrize(
    ("entry", "told"),
    [
        ("x: {count: hitt, within: 1}", "14: unknown property `hitt` | did you mean `hit`?"),
        ("x: {count: hit, within: -1}", "27: `within` must be above zero | write a positive time"),
        (
            "x: {count: hit, within: .inf}",
            "27: `within` is unbounded | give a finite time: memory is bounded by",
        ),
        ("x: {count: hit}", "6: `count` needs `within` | give the length of the window"),
        ("x: {cuont: hit, within: 1}", "7: `x` has no operator | did you mean `count`?"),
        ("x: {held: a, count: a, within: 1}", "23: `held` and `count` are alternatives | derive one name"),
        ("x: {held: a, for: 1, value: 2}", "13: `a` has 1 values, not 2 | write a smaller `value`"),
        ("x: {count: hit, within: 1, lateness: 1}", "40: `count` waits for nothing | leave `lateness` out"),
        ("x: {absent: hit, for: 1, wait: 2}", "28: `absent` has no option `wait` | options: for"),
        ("x: {together: [a], within: 1}", "6: `together` needs two streams or more | write them as a list"),
        ("x: {together: [a, a], within: 1}", "6: `together` names a stream twice | name each stream once"),
        ("x: hit", "6: `x` has no operator | write one, such as"),
        (
            "a: {count: hit, within: 1}",
            "3: the derived entry `a` has the same name as the property on line 3",
        ),
    ],
)
def test_mistakes_are_reported_with_location_and_help(entry: str, told: str) -> None:
    assert any(each.startswith(told) for each in _problems(entry)), _problems(entry)
