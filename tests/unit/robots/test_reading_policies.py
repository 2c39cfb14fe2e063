"""Latest only, expiry, NaN and the range of view: of a reading alone, and in artifacts with an agent that watches."""

import itertools
import math
from functools import partial
from typing import Any, ClassVar

import pytest
from robot_lab import Lab, Watcher, made

from jacaros.artifacts import ArtifactId, Structure, operation
from jacaros.robots.artifacts.odometry import ArtOdometry
from jacaros.robots.artifacts.sensors import ArtBaseScan
from jacaros.robots.artifacts.thesis import ArtTutorial
from jacaros.robots.kit.reading import LONGEST_WAIT, Reading
from jacaros.robots.kit.ros_artifact import RosArtifact
from jacaros.robots.streams import ReadingPolicy, Values
from jacaros.runtime.clock import VirtualClock
from jacaros.runtime.trace import Cause


class Slow(Reading):
    """A reading whose observer is behind whenever a test says so."""

    def __init__(self, lab: Lab, **policy: Any) -> None:
        self.lab, self.is_behind = lab, False
        self.log: list[tuple[float, Values | str]] = []
        withdrawn = partial(self.note, "withdrawn")
        args = (self.show, "", withdrawn, self.refuse, lambda: self.is_behind)
        super().__init__(ReadingPolicy(**policy), lab.clock, *args)

    def note(self, what: Values | str) -> None:
        self.log.append((round(self.lab.clock.elapsed, 6), what))

    def show(self, values: Values, cause: Cause | None) -> None:
        self.note(values)
        self.is_behind = True

    def refuse(self, number: float) -> None:
        self.note(f"refused {number}")

    async def burst(self, numbers: range) -> None:
        """Take a number each millisecond."""
        for number in numbers:
            self.take((number,))
            await self.lab.sleep(0.001)


async def test_newest_only_delivery_holds_a_burst_back_until_the_previous_value_is_processed(
    lab: Lab,
) -> None:
    slow = Slow(lab, latest_only=True)
    await slow.burst(range(100))
    slow.is_behind = False
    await lab.sleep(0.01)
    slow.is_behind = False
    await lab.sleep(1)
    assert [values for _, values in slow.log] == [(0,), (99,)]
    assert slow.log[1][0] <= 0.11


async def test_without_the_policy_every_value_is_delivered_immediately(lab: Lab) -> None:
    slow = Slow(lab)
    for number in range(5):
        slow.take((number,))
    assert slow.log == [(0, (number,)) for number in range(5)]


async def test_an_observer_that_never_takes_up_does_not_keep_values_for_ever(lab: Lab) -> None:
    slow = Slow(lab, latest_only=True)
    await slow.burst(range(3001))
    times = [moment for moment, _ in slow.log]
    assert times[0] == 0
    assert all(LONGEST_WAIT <= b - a < LONGEST_WAIT + 0.02 for a, b in itertools.pairwise(times))
    assert len(times) == 3


async def test_a_held_value_is_dropped_when_it_returns_to_the_previous_one(lab: Lab) -> None:
    slow = Slow(lab, latest_only=True)
    for number in (1, 2, 1):
        slow.take((number,))
    slow.is_behind = False
    await lab.sleep(1)
    slow.take((2,))
    assert slow.log == [(0, (1,)), (1, (2,))]


@pytest.mark.parametrize("policy", [{"latest_only": True, "expire": 1.0}, {"rate": 1.0}])
async def test_a_closed_reading_lets_nothing_pass_that_waits_or_comes(lab: Lab, policy: Any) -> None:
    slow = Slow(lab, **policy)
    slow.take((1,))
    slow.take((2,))
    slow.close()
    slow.take((3,))
    slow.is_behind = False
    await lab.sleep(3)
    assert slow.log == [(0, (1,))]


async def test_values_expire_without_messages_and_return_with_the_next_one(lab: Lab) -> None:
    slow = Slow(lab, expire=2.0)
    for _ in range(4):
        slow.take((1,))
        await lab.sleep(1)
    await lab.sleep(3)
    assert slow.newest is None
    with pytest.raises(TimeoutError):
        await slow.first(1)
    slow.take((1,))
    await lab.sleep(1)
    assert slow.log == [(0, (1,)), (5, "withdrawn"), (8, (1,))]


async def test_a_value_held_back_by_a_rate_is_not_passed_after_it_has_expired(lab: Lab) -> None:
    slow = Slow(lab, expire=1.0, rate=0.5)
    slow.take((1,))
    slow.take((2,))
    await lab.sleep(5)
    assert slow.log == [(0, (1,)), (1, "withdrawn")]


async def test_what_is_not_finite_is_refused_in_lists_too(lab: Lab) -> None:
    slow = Slow(lab)
    for values in ((1.0, math.nan), ([0.5, [math.inf]],), (1, "nan", [0.5])):
        slow.take(values)
    assert slow.log == [(0, "refused nan"), (0, "refused inf"), (0, (1, "nan", [0.5]))]


# In artifacts.


def say(lab: Lab, x: float) -> None:
    """Publish odometry of a position on the x axis."""
    lab.say("/odom", "nav_msgs/msg/Odometry", pose={"pose": {"position": {"x": x}}})


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
    artifact, watcher = await lab.make(ArtOdometry), SlowWatcher(lab.clock)
    lab.workspace.focus(artifact, watcher)
    watcher.untaken.clear()
    for number in range(1, 500):
        say(lab, number)
        await lab.sleep(0.001)
    assert watcher.values("odom")[1:] == [(1, 0, 0)]
    watcher.untaken.clear()
    await lab.sleep(0.01)
    assert watcher.values("odom")[1:] == [(1, 0, 0), (499, 0, 0)]


async def test_messages_that_each_count_do_not_wait(lab: Lab) -> None:
    artifact, watcher = await lab.make(ArtTutorial), SlowWatcher(lab.clock)
    lab.workspace.focus(artifact, watcher)
    for word in ("a", "b", "c"):
        lab.say("/chatter", "std_msgs/msg/String", data=word)
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


@made(Holder)
async def test_at_most_one_update_waits_while_an_operation_keeps_the_artifact(
    lab: Lab, artifact: ArtifactId, watcher: Watcher
) -> None:
    [holder] = Holder.made
    holding = await lab.begun(0.1, artifact, "hold")
    for number in range(1, 100):
        holder.level.take((number,))
        await lab.sleep(0.001)
    await holding.done
    await lab.sleep(0.1)
    assert watcher.values("level") == [(0,), (1,), (99,)]


@made(ArtOdometry, Structure("expire", (2,)))
async def test_a_property_expires_and_comes_back(lab: Lab, artifact: ArtifactId, watcher: Watcher) -> None:
    assert watcher.holds("odom") == []
    say(lab, 1)
    await lab.sleep(1)
    assert watcher.holds("odom") == [(1, 0, 0)]
    await lab.sleep(1.5)
    assert watcher.holds("odom") == watcher.holds("pose") == []
    assert (await lab.call(artifact, "getCurrentOdom")).reason == "no_odometry(5)"
    say(lab, 1)
    await lab.sleep(0.1)
    assert watcher.holds("odom") == [(1, 0, 0)]
    await lab.do(artifact, "getCurrentOdom")


@made(ArtBaseScan, Structure("expire", (1,)), Structure("mode", ("on_demand",)))
async def test_a_scan_on_demand_expires_too_and_is_defined_by_the_operation(
    lab: Lab, artifact: ArtifactId, watcher: Watcher
) -> None:
    lab.say("/scan", "sensor_msgs/msg/LaserScan", ranges=[1.0] * 5, range_max=5.0)
    await lab.sleep(0.5)
    assert watcher.holds("laserrange") == []
    await lab.do(artifact, "getCurrentBaseScan")
    assert watcher.holds("laserrange") == [(1, 1, 1, 1, 1)]
    await lab.sleep(1)
    assert watcher.holds("laserrange") == []
