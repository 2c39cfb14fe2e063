"""Latest only, expiry, NaN and the range of view: of a reading alone, and in artifacts with an agent that watches."""

import itertools
import math
from functools import partial
from typing import Any, ClassVar

import pytest
from robot_lab import Lab, Watcher

from jacaros.artifacts import Structure, operation
from jacaros.artifacts.streams import ReadingPolicy
from jacaros.robots.artifacts.odometry import ArtOdometry
from jacaros.robots.artifacts.sensors import ArtBaseScan
from jacaros.robots.artifacts.thesis import ArtTutorial
from jacaros.robots.kit.reading import LONGEST_WAIT, RangeOfView, Reading
from jacaros.robots.kit.ros_artifact import RosArtifact
from jacaros.robots.mapping.decoding import ReadValues
from jacaros.runtime.clock import VirtualClock, run
from jacaros.runtime.trace import Cause

ODOMETRY = "nav_msgs/msg/Odometry"


class Slow:
    """A reading whose observer is behind whenever a test says so."""

    def __init__(self, policy: ReadingPolicy) -> None:
        self.clock = VirtualClock()
        self.behind = False
        self.log: list[tuple[float, ReadValues | str]] = []
        withdrawn = partial(self.note, "withdrawn")
        self.reading = Reading(policy, self.clock, self.show, "", withdrawn, self.refuse, lambda: self.behind)

    def note(self, what: ReadValues | str) -> None:
        self.log.append((round(self.clock.elapsed, 6), what))

    def show(self, values: ReadValues, cause: Cause | None) -> None:
        self.note(values)
        self.behind = True

    def refuse(self, number: float) -> None:
        self.note(f"refused {number}")


def test_newest_only_delivery_holds_a_burst_back_until_the_previous_value_is_processed() -> None:
    slow = Slow(ReadingPolicy(latest_only=True))

    async def main() -> None:
        for number in range(100):
            slow.reading.take((number,))
            await slow.clock.sleep(0.001)
        slow.behind = False
        await slow.clock.sleep(0.01)
        slow.behind = False
        await slow.clock.sleep(1)

    run(main, slow.clock)
    assert [values for _, values in slow.log] == [(0,), (99,)]
    assert slow.log[1][0] <= 0.11


def test_without_the_policy_every_value_is_delivered_immediately() -> None:
    slow = Slow(ReadingPolicy())

    async def main() -> None:
        for number in range(5):
            slow.reading.take((number,))

    run(main, slow.clock)
    assert slow.log == [(0, (number,)) for number in range(5)]


def test_an_observer_that_never_takes_up_does_not_keep_values_for_ever() -> None:
    slow = Slow(ReadingPolicy(latest_only=True))

    async def main() -> None:
        for number in range(3001):
            slow.reading.take((number,))
            await slow.clock.sleep(0.001)

    run(main, slow.clock)
    times = [moment for moment, _ in slow.log]
    assert times[0] == 0
    assert all(LONGEST_WAIT <= b - a < LONGEST_WAIT + 0.02 for a, b in itertools.pairwise(times))
    assert len(times) == 3


def test_a_held_value_is_dropped_when_it_returns_to_the_previous_one() -> None:
    slow = Slow(ReadingPolicy(latest_only=True))

    async def main() -> None:
        for number in (1, 2, 1):
            slow.reading.take((number,))
        slow.behind = False
        await slow.clock.sleep(1)
        slow.reading.take((2,))

    run(main, slow.clock)
    assert slow.log == [(0, (1,)), (1, (2,))]


def test_a_closed_reading_lets_nothing_pass_that_waits() -> None:
    slow = Slow(ReadingPolicy(latest_only=True, expire=1.0))

    async def main() -> None:
        slow.reading.take((1,))
        slow.reading.take((2,))
        slow.reading.close()
        slow.behind = False
        await slow.clock.sleep(3)

    run(main, slow.clock)
    assert slow.log == [(0, (1,))]


def test_values_expire_without_messages_and_return_with_the_next_one() -> None:
    slow = Slow(ReadingPolicy(expire=2.0))

    async def main() -> None:
        for _ in range(4):
            slow.reading.take((1,))
            await slow.clock.sleep(1)
        await slow.clock.sleep(3)
        assert slow.reading.newest is None
        with pytest.raises(TimeoutError):
            await slow.reading.first(1)
        slow.reading.take((1,))
        await slow.clock.sleep(1)

    run(main, slow.clock)
    assert slow.log == [(0, (1,)), (5, "withdrawn"), (8, (1,))]


def test_a_value_held_back_by_a_rate_is_not_passed_after_it_has_expired() -> None:
    slow = Slow(ReadingPolicy(expire=1.0, rate=0.5))

    async def main() -> None:
        slow.reading.take((1,))
        slow.reading.take((2,))
        await slow.clock.sleep(5)

    run(main, slow.clock)
    assert slow.log == [(0, (1,)), (1, "withdrawn")]


def test_what_is_not_finite_is_refused_in_lists_too() -> None:
    slow = Slow(ReadingPolicy())

    async def main() -> None:
        slow.reading.take((1.0, math.nan))
        slow.reading.take(([0.5, [math.inf]],))
        slow.reading.take((1, "nan", [0.5]))

    run(main, slow.clock)
    assert slow.log == [(0, "refused nan"), (0, "refused inf"), (0, (1, "nan", [0.5]))]


# In artifacts.


class Odom:
    """Publishes odometry of positions on the x axis."""

    def __init__(self, lab: Lab) -> None:
        self._lab = lab
        self._publisher = lab.backend.publisher("/odom", ODOMETRY)

    def say(self, x: float, **header: Any) -> None:
        pose = {"pose": {"position": {"x": x}}}
        self._publisher.publish(self._publisher.message(header=header, pose=pose))


class SlowWatcher(Watcher):
    """An observer that processes nothing until it is released."""

    def __init__(self, clock: VirtualClock) -> None:
        super().__init__(clock)
        self.untaken: set[str] = set()

    def observe(self, observation: Any) -> None:
        super().observe(observation)
        self.untaken |= {new.name for _, new in observation.changed}

    def has_untaken(self, name: str) -> bool:
        return name in self.untaken


async def test_a_lagging_observer_gets_the_newest_value_when_it_has_caught_up(lab: Lab) -> None:
    odom = Odom(lab)
    artifact = await lab.make(ArtOdometry)
    watcher = SlowWatcher(lab.clock)
    lab.workspace.focus(artifact, watcher)
    watcher.untaken.clear()
    for number in range(1, 500):
        odom.say(number)
        await lab.sleep(0.001)
    assert watcher.values("odom")[1:] == [(1, 0, 0)]
    watcher.untaken.clear()
    await lab.sleep(0.01)
    assert watcher.values("odom")[1:] == [(1, 0, 0), (499, 0, 0)]


async def test_messages_that_each_count_do_not_wait(lab: Lab) -> None:
    artifact = await lab.make(ArtTutorial)
    watcher = SlowWatcher(lab.clock)
    lab.workspace.focus(artifact, watcher)
    publisher = lab.backend.publisher("/chatter", "std_msgs/msg/String")
    for word in ("a", "b", "c"):
        publisher.publish(publisher.message(data=word))
    await lab.sleep(0.1)
    assert watcher.values("chatter") == [("",), ("a",), ("b",), ("c",)]


class Holder(RosArtifact):
    """Keeps the artifact for itself for a while."""

    made: ClassVar[list["Holder"]] = []

    def open(self) -> None:
        self.made[:] = [self]
        self.level = self.reading("level", ReadingPolicy(latest_only=True), 0)

    @operation
    async def hold(self) -> None:
        await self.clock.sleep(2)  # no step: no other operation runs


async def test_at_most_one_update_waits_while_an_operation_keeps_the_artifact(lab: Lab) -> None:
    artifact = await lab.make(Holder)
    watcher = lab.watch(artifact)
    [made] = Holder.made
    holding = lab.begin(artifact, "hold")
    await lab.sleep(0.1)
    for number in range(1, 100):
        made.level.take((number,))
        await lab.sleep(0.001)
    await holding.done
    await lab.sleep(0.1)
    assert watcher.values("level") == [(0,), (1,), (99,)]


async def test_a_property_expires_and_comes_back(lab: Lab) -> None:
    odom = Odom(lab)
    artifact = await lab.make(ArtOdometry, Structure("expire", (2,)))
    watcher = lab.watch(artifact)
    assert watcher.holds("odom") == []
    odom.say(1)
    await lab.sleep(1)
    assert watcher.holds("odom") == [(1, 0, 0)]
    await lab.sleep(1.5)
    assert watcher.holds("odom") == watcher.holds("pose") == []
    assert (await lab.call(artifact, "getCurrentOdom")).reason == "no_odometry(5)"
    odom.say(1)
    await lab.sleep(0.1)
    assert watcher.holds("odom") == [(1, 0, 0)]
    await lab.do(artifact, "getCurrentOdom")


async def test_a_scan_on_demand_expires_too_and_is_defined_by_the_operation(lab: Lab) -> None:
    options = (Structure("expire", (1,)), Structure("mode", ("on_demand",)))
    artifact = await lab.make(ArtBaseScan, *options)
    watcher = lab.watch(artifact)
    publisher = lab.backend.publisher("/scan", "sensor_msgs/msg/LaserScan")
    publisher.publish(publisher.message(ranges=[1.0] * 5, range_max=5.0))
    await lab.sleep(0.5)
    assert watcher.holds("laserrange") == []
    await lab.do(artifact, "getCurrentBaseScan")
    assert watcher.holds("laserrange") == [(1, 1, 1, 1, 1)]
    await lab.sleep(1)
    assert watcher.holds("laserrange") == []


# The range of view.


def test_only_elements_within_reach_of_the_robot_are_in_view() -> None:
    shown: list[list[ReadValues]] = []
    view = RangeOfView(2.0, lambda elements, cause: shown.append(elements))
    cells: list[ReadValues] = [(0, 0, "a"), (2, 0, "b"), (3, 0, "c"), (math.nan, 0, "d")]
    view.take(cells)
    assert shown == []
    view.stand(0, 0)
    assert shown == [[(0, 0, "a"), (2, 0, "b")]]
    view.stand(0.005, 0)
    view.take(list(cells))
    assert len(shown) == 1
    view.stand(2.5, 0)
    assert shown[-1] == [(2, 0, "b"), (3, 0, "c")]
    view.take([])
    assert shown[-1] == []


class Landmarks(RosArtifact):
    """Shows the poses of a message that are near the robot."""

    def open(self) -> None:
        self.view = RangeOfView(2.0, lambda seen, cause: self.start(self.show_elements, "landmark", seen))
        self.subscription("landmarks", "geometry_msgs/msg/PoseArray", self.take)

    def take(self, sample: Any) -> None:
        self.view.take([(each.position.x, each.position.y) for each in sample.message.poses])

    @operation
    def stand(self, x: float, y: float) -> None:
        """Note where the robot is."""
        self.view.stand(x, y)


async def test_elements_in_view_are_properties_and_one_that_stays_gives_no_event(lab: Lab) -> None:
    artifact = await lab.make(Landmarks)
    watcher = lab.watch(artifact)
    publisher = lab.backend.publisher("/landmarks", "geometry_msgs/msg/PoseArray")
    poses = [{"position": {"x": float(x)}} for x in range(5)]
    publisher.publish(publisher.message(poses=poses))
    await lab.sleep(0.1)
    await lab.do(artifact, "stand", 0, 0)
    assert watcher.holds("landmark") == [(0, 0), (1, 0), (2, 0)]
    await lab.do(artifact, "stand", 1, 0)
    assert watcher.holds("landmark") == [(0, 0), (1, 0), (2, 0), (3, 0)]
    assert watcher.values("landmark") == [(0, 0), (1, 0), (2, 0), (3, 0)]
    await lab.do(artifact, "stand", 9, 0)
    assert watcher.holds("landmark") == []
