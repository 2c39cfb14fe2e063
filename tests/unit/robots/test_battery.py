"""ArtSimBattery: the thesis's timer, and a robot's own battery, with odd options and odd drivers."""

import math
from types import SimpleNamespace
from typing import Any

import pytest
from robot_lab import Lab, Watcher, made

from jacaros.artifacts import ArtifactId, Out, Structure
from jacaros.look.page.graph_scene import SeenRobot
from jacaros.robots.artifacts.battery import ArtSimBattery, diagnosis
from jacaros.robots.artifacts.velocity import ArtCmdVelMuxAndOdometry

FULL, MEDIUM, LOW = "Full Battery", "Medium Battery", "Low Battery"


def option(name: str, value: Any) -> Structure:
    return Structure(name, (value,))


def charge(lab: Lab, topic: str = "/battery_state") -> Any:
    """Return a function that publishes a charge and a status."""
    publisher = lab.backend.publisher(topic, "sensor_msgs/msg/BatteryState")

    def publish(share: float, status: str = "UNKNOWN") -> None:
        message = publisher.message(percentage=share)
        message.power_supply_status = getattr(message, f"POWER_SUPPLY_STATUS_{status}")
        publisher.publish(message)

    return publish


OWN = option("source", "robot")
pytestmark = made(ArtSimBattery, "bot")


@pytest.mark.parametrize(
    ("words", "percents"), [(FULL, (100, 99, 51)), (MEDIUM, (50, 35, 21)), (LOW, (20, 7, 0))]
)
def test_every_charge_has_its_diagnosis(words: str, percents: tuple[int, ...]) -> None:
    """Defect 5: the thresholds were compared for equality, so a charge could jump over them."""
    assert {diagnosis(each) for each in percents} == {words}


async def test_the_timer_drains_one_percent_a_second_and_stops_at_zero(lab: Lab) -> None:
    watcher = lab.watch(await lab.make(ArtSimBattery))
    assert watcher.holds("battery") == [(100,)]
    assert watcher.holds("diagnostics") == [(FULL,)]
    await lab.sleep(50.5)
    assert watcher.holds("battery") == [(50,)]
    assert watcher.holds("diagnostics") == [(MEDIUM,)]
    await lab.sleep(30)
    assert watcher.holds("diagnostics") == [(LOW,)]
    await lab.sleep(60)
    assert watcher.holds("battery") == [(0,)]
    assert [values for _, values in watcher.changes if _ == "battery"] == [(n,) for n in range(100, -1, -1)]
    assert watcher.values("diagnostics") == [(FULL,), (MEDIUM,), (LOW,)]
    assert watcher.signals == []


@pytest.mark.parametrize("level", [0, 15, 20, 37, 99])
async def test_recharging_ends_at_exactly_one_hundred_whatever_it_begins_with(lab: Lab, level: int) -> None:
    """Defect 5: 15 became 105, and never "Full Battery"."""
    battery = await lab.make(ArtSimBattery, option("level", level))
    watcher = lab.watch(battery)
    await lab.do(battery, "operationRecharge")
    levels = [values[0] for values in watcher.values("battery")]
    assert levels == [level, *range(level + 10, 100, 10), 100]
    assert watcher.holds("diagnostics") == [(FULL,)]
    words = [values[0] for values in watcher.values("diagnostics")]
    assert words == list(dict.fromkeys(diagnosis(each) for each in levels))  # type: ignore[arg-type]
    assert lab.clock.elapsed == pytest.approx(0.5 * (len(levels) - 1))
    await lab.sleep(1.5)
    assert watcher.holds("battery")[0][0] in (98, 99)


async def test_nothing_drains_while_the_battery_is_charged_and_other_operations_are_served(lab: Lab) -> None:
    """Defect 5: it kept draining, and could not be queried."""
    battery = await lab.make(ArtSimBattery, option("level", 10), option("drain", 5))
    watcher = lab.watch(battery)
    charging = await lab.begun(2.1, battery, "operationRecharge")
    out = Out()
    await lab.do(battery, "getCurrentBattery", out)
    assert out.value == 60
    assert lab.clock.elapsed == pytest.approx(2.1)
    await charging.done
    levels = [values[0] for values in watcher.values("battery")]
    assert levels == sorted(levels)  # type: ignore[type-var]


@made(ArtSimBattery, option("level", 50))
async def test_a_second_recharge_waits_for_the_first_and_a_dropped_one_lets_the_battery_drain_again(
    lab: Lab, artifact: ArtifactId, watcher: Watcher
) -> None:
    runs = [lab.begin(artifact, "operationRecharge") for _ in range(2)]
    for each in runs:
        await each.done
    assert lab.clock.elapsed == pytest.approx(2.5)
    await lab.sleep(20)
    dropped = await lab.begun(0.2, artifact, "operationRecharge")
    dropped.execution.cancel()
    level = watcher.holds("battery")[0][0]
    await lab.sleep(3)
    assert level - watcher.holds("battery")[0][0] == 3  # type: ignore[operator]


@made(ArtSimBattery, option("level", 2))
async def test_an_empty_battery_drains_again_after_recharging(
    lab: Lab, artifact: ArtifactId, watcher: Watcher
) -> None:
    await lab.sleep(5)
    await lab.do(artifact, "operationRecharge")
    await lab.sleep(2.5)
    assert watcher.holds("battery") == [(98,)]


async def test_the_speed_of_draining_is_an_option_and_may_be_nought(lab: Lab) -> None:
    fast = lab.watch(await lab.make(ArtSimBattery, option("drain", 4)))
    never = lab.watch(await lab.make(ArtSimBattery, option("drain", 0), option("level", 42)))
    await lab.sleep(10.01)
    assert fast.holds("battery") == [(60,)]
    assert never.values("battery") == [(42,)]


WITH_DOCK = """
bounds: {from: [-3, -3], to: [3, 3]}
docks: [{name: dock, x: 1, y: 0, yaw_degrees: 0, radius: 0.25}]
robots: [{name: turtlebot, battery: {level: 22, drain_per_second: 0.3, charge_per_second: 5}}]
"""


@pytest.mark.world(WITH_DOCK)
@made(ArtSimBattery, OWN)
async def test_a_robots_battery_is_shown_charges_in_the_dock_and_is_waited_for(
    lab: Lab, artifact: ArtifactId, watcher: Watcher
) -> None:
    assert watcher.held == {}
    out = Out()
    await lab.do(artifact, "getCurrentBattery", out)
    assert out.value == 21
    assert watcher.values("diagnostics") == [(MEDIUM,)]
    assert (await lab.call(artifact, "operationRecharge")).reason == "not_docked"
    assert 5 <= lab.clock.elapsed < 6.5
    await lab.sleep(3)
    assert watcher.holds("diagnostics") == [(LOW,)]
    motion = await lab.make(ArtCmdVelMuxAndOdometry)
    await lab.do(motion, "driveTo", 1, 0)
    begin = lab.clock.elapsed
    await lab.do(artifact, "operationRecharge")
    assert lab.clock.elapsed - begin == pytest.approx(16, abs=2)
    assert watcher.holds("battery") == [(100,)]
    assert watcher.values("diagnostics") == [(MEDIUM,), (LOW,), (MEDIUM,), (FULL,)]
    await lab.do(artifact, "operationRecharge")
    await lab.do(motion, "driveTo", 0, 0)
    await lab.sleep(10)
    assert watcher.holds("battery")[0][0] in range(90, 99)


async def test_a_recharge_that_loses_the_dock_fails(lab: Lab) -> None:
    battery = await lab.make(ArtSimBattery, "bot", option("dock_timeout", 2))
    publisher = charge(lab, "/bot/battery_state")
    publisher(0.3, "CHARGING")
    charging = await lab.begun(1, battery, "operationRecharge")
    publisher(0.4, "CHARGING")
    await lab.sleep(1.5)
    assert not charging.done.done()
    publisher(0.4, "DISCHARGING")
    await charging.done
    assert charging.reason == "not_docked"
    assert lab.clock.elapsed == pytest.approx(3.5, abs=0.6)


async def test_a_driver_that_knows_no_status_is_understood_by_its_rising_charge(lab: Lab) -> None:
    battery = await lab.make(ArtSimBattery, "bot", option("dock_timeout", 2))
    publish = charge(lab, "/bot/battery_state")
    publish(0.9, "UNKNOWN")
    charging = lab.begin(battery, "operationRecharge")
    for percent in range(91, 101):
        await lab.sleep(1)
        publish(percent / 100, "UNKNOWN")
    await charging.done
    assert charging.ok
    assert lab.clock.elapsed == pytest.approx(10, abs=0.6)


@pytest.mark.parametrize(("share", "status"), [(1.0, "CHARGING"), (0.996, "NOT_CHARGING")])
async def test_a_battery_is_full_though_its_driver_charges_for_ever_or_its_charge_stops_rising(
    lab: Lab, artifact: ArtifactId, share: float, status: str
) -> None:
    charge(lab, "/bot/battery_state")(share, status)
    await lab.do(artifact, "operationRecharge")
    assert lab.clock.elapsed < 7


@pytest.mark.parametrize("status", ["CHARGING", "UNKNOWN"])
async def test_a_battery_that_is_almost_full_is_not_full(lab: Lab, status: str) -> None:
    """Rounding must not end a charge early."""
    battery = await lab.make(ArtSimBattery, "bot")
    watcher = lab.watch(battery)
    publish = charge(lab, "/bot/battery_state")
    publish(0.994, status)
    charging = lab.begin(battery, "operationRecharge")
    for tenth in range(995, 1000):
        await lab.sleep(4)
        publish(tenth / 1000, status)
    await lab.sleep(4)
    assert watcher.holds("battery") == [(99,)]
    assert not charging.done.done()
    publish(1.0, "FULL")
    await charging.done
    assert watcher.holds("battery") == [(100,)]


async def test_a_battery_of_unknown_charge_is_not_shown_and_does_not_hide_a_known_one(lab: Lab) -> None:
    battery = await lab.make(ArtSimBattery, option("topic", "power"))
    watcher = lab.watch(battery)
    publish = charge(lab, "/power")
    publish(math.nan, "DISCHARGING")
    await lab.sleep(0.1)
    assert watcher.held == {}
    assert (await lab.call(battery, "getCurrentBattery", Out())).reason == "no_battery(5)"
    for share in (0.504, math.nan):
        publish(share, "DISCHARGING")
        await lab.sleep(0.1)
        assert watcher.holds("battery") == [(50,)]
    assert watcher.holds("diagnostics") == [(MEDIUM,)]


@made(ArtSimBattery, OWN)
async def test_an_impossible_charge_is_reported_and_not_shown(lab: Lab, watcher: Watcher) -> None:
    tell = charge(lab)
    for share in (0.5, -1.0, -0.01, 0.4):
        tell(share)
        await lab.sleep(0.1)
    assert watcher.values("battery") == [(50,), (40,)]
    [(name, why)] = watcher.signals
    assert (name, *map(str, why)) == ("bad_message", "/battery_state", 'out_of_range("percentage")')


async def test_the_levels_of_the_diagnoses_are_options(lab: Lab) -> None:
    watcher = lab.watch(await lab.make(ArtSimBattery, option("medium", 90), option("low", 80)))
    await lab.sleep(9.5)
    assert watcher.holds("diagnostics") == [(FULL,)]
    await lab.sleep(1.0)
    assert watcher.holds("diagnostics") == [(MEDIUM,)]
    await lab.sleep(10.0)
    assert watcher.holds("diagnostics") == [(LOW,)]


async def test_a_low_level_above_the_medium_one_is_rejected(lab: Lab) -> None:
    with pytest.raises(Exception, match=r"low\(60\) is above medium\(50\)"):
        await lab.make(ArtSimBattery, option("low", 60))


async def test_agent_and_page_read_the_charge_of_a_driver_alike(lab: Lab) -> None:
    seen = SeenRobot("r")
    publisher = lab.backend.publisher("/battery_state", "sensor_msgs/msg/BatteryState")
    lab.backend.subscription("/battery_state", "sensor_msgs/msg/BatteryState", seen.hear_battery)
    watcher = lab.watch(await lab.make(ArtSimBattery, OWN))
    pose = SimpleNamespace(
        position=SimpleNamespace(x=0.0, y=0.0, z=0.0), orientation=SimpleNamespace(x=0.0, y=0.0, z=0.0, w=1.0)
    )
    seen.odometry = SimpleNamespace(header=SimpleNamespace(frame_id="odom"), pose=SimpleNamespace(pose=pose))
    for told, percent in ((0.5, 50), (1.2, 100), (80.0, 80), (1.4, 1), (1.0, 1)):
        publisher.publish(publisher.message(percentage=told))
        await lab.sleep(1.0)
        assert watcher.holds("battery") == [(percent,)]
        assert math.floor(seen.view(lab.backend).battery) == percent


@pytest.mark.parametrize(("level", "shown"), [(150, 100), (-5, 0), (42.4, 42), (0.6, 1)])
async def test_the_level_at_the_start_is_a_whole_percentage(lab: Lab, level: float, shown: int) -> None:
    watcher = lab.watch(await lab.make(ArtSimBattery, option("level", level), option("drain", 0)))
    assert watcher.holds("battery") == [(shown,)]


@pytest.mark.parametrize(
    ("arguments", "topic"),
    [
        (("bot",), "/bot/battery_state"),
        ((option("namespace", "bot"),), "/bot/battery_state"),
        ((option("topic", "power"),), "/power"),
        ((OWN,), "/battery_state"),
    ],
)
async def test_a_robots_battery_is_followed_if_anything_names_the_robot(
    lab: Lab, arguments: Any, topic: str
) -> None:
    watcher = lab.watch(await lab.make(ArtSimBattery, *arguments))
    assert watcher.holds("battery") == []
    charge(lab, topic)(0.5)
    await lab.sleep(2.5)
    assert watcher.holds("battery") == [(50,)]


async def test_a_timer_can_be_asked_for_whatever_the_robot_is_named(lab: Lab) -> None:
    watcher = lab.watch(await lab.make(ArtSimBattery, "bot", option("source", "timer")))
    charge(lab, "/bot/battery_state")(0.5)
    await lab.sleep(1.5)
    assert watcher.values("battery") == [(100,), (99,)]


@made(ArtSimBattery, OWN)
@pytest.mark.parametrize(
    ("shares", "shown", "lines"),
    [
        ((0.28997, 0.29, 0.2899999999, 0.999), [28, 29, 99], 0),  # not 100 before it is full
        ((1.4, 0.8), [100, 80], 0),
        ((1.6, 1.2, 98.2, 19.6, 1.0), [1, 98, 19, 1], 1),
    ],
    ids=[
        "rounded down but for the loss of its 32 bits",
        "a little above one",
        "once in percent, always in percent",
    ],
)
async def test_charges_of_drivers(
    lab: Lab, watcher: Watcher, shares: tuple[float, ...], shown: list[int], lines: int
) -> None:
    publish = charge(lab)
    for share in shares:
        publish(share)
        await lab.sleep(0.1)
    assert watcher.values("battery") == [(each,) for each in shown]
    assert ["assuming percent" in line for line in lab.logged] == [True] * lines


async def test_a_charge_that_expires_is_unknown_until_the_next_message(lab: Lab) -> None:
    watcher = lab.watch(await lab.make(ArtSimBattery, OWN, option("expire", 2.0)))
    publish = charge(lab)
    publish(0.6)
    await lab.sleep(1.5)
    assert watcher.holds("battery") == [(60,)]
    await lab.sleep(1.0)
    assert watcher.holds("battery") == []
    assert watcher.holds("diagnostics") == []
    publish(0.6)
    await lab.sleep(0.1)
    assert watcher.holds("battery") == [(60,)]
    assert watcher.holds("diagnostics") == [("Full Battery",)]


@made(ArtSimBattery, OWN)
async def test_a_full_battery_off_the_dock_needs_no_charge(lab: Lab, artifact: ArtifactId) -> None:
    charge(lab)(1.0, "NOT_CHARGING")
    await lab.sleep(0.1)
    before = lab.clock.elapsed
    await lab.do(artifact, "operationRecharge")
    assert lab.clock.elapsed == before


@pytest.mark.parametrize(("arguments", "seconds"), [((), 5.0), ((option("dock_timeout", 2.0),), 2.0)])
async def test_a_recharge_off_the_dock_fails_after_the_timeout(
    lab: Lab, arguments: Any, seconds: float
) -> None:
    battery = await lab.make(ArtSimBattery, OWN, *arguments)
    charge(lab)(0.5, "DISCHARGING")
    await lab.sleep(20)
    before = lab.clock.elapsed
    failed = await lab.call(battery, "operationRecharge")
    assert failed.reason == "not_docked"
    assert seconds <= lab.clock.elapsed - before <= seconds + 0.5


async def test_a_charge_that_has_stopped_rising_just_below_full_is_complete_after_the_timeout(
    lab: Lab,
) -> None:
    battery = await lab.make(ArtSimBattery, OWN, option("dock_timeout", 3.0))
    publish = charge(lab)
    publish(0.996, "CHARGING")
    await lab.sleep(0.1)
    charging = await lab.begun(2.0, battery, "operationRecharge")
    publish(0.997, "CHARGING")  # it rises: the wait begins again
    await lab.sleep(2.0)
    assert not charging.done.done()
    publish(0.997, "CHARGING")
    await charging.done
    assert charging.reason == "None"
    assert 5.0 <= lab.clock.elapsed <= 6.0


async def test_a_charge_that_stops_rising_well_below_full_is_not_complete(lab: Lab) -> None:
    battery = await lab.make(ArtSimBattery, OWN, option("dock_timeout", 3.0))
    publish = charge(lab)
    charging = lab.begin(battery, "operationRecharge")
    for _ in range(10):
        publish(0.99, "CHARGING")
        await lab.sleep(1.0)
    assert not charging.done.done()
    publish(0.99, "DISCHARGING")
    await charging.done
    assert charging.reason == "not_docked"
