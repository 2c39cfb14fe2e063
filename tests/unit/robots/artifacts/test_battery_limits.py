"""ArtSimBattery at its limits: odd options, odd drivers, and when a charge counts as complete."""

from typing import Any

import pytest
from robot_lab import Lab, Watcher, made

from jacaros.artifacts import ArtifactId, Structure
from jacaros.robots.artifacts.battery import ArtSimBattery


def option(name: str, value: Any) -> Structure:
    return Structure(name, (value,))


def reports(lab: Lab, topic: str = "/battery_state") -> Any:
    """A function that publishes a charge and a status."""
    publisher = lab.backend.publisher(topic, "sensor_msgs/msg/BatteryState")

    def publish(share: float, status: str = "UNKNOWN") -> None:
        message = publisher.message(percentage=share)
        message.power_supply_status = getattr(message, f"POWER_SUPPLY_STATUS_{status}")
        publisher.publish(message)

    return publish


pytestmark = made(ArtSimBattery, option("source", "robot"))


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
        ((option("source", "robot"),), "/battery_state"),
    ],
)
async def test_a_robots_battery_is_followed_if_anything_names_the_robot(
    lab: Lab, arguments: Any, topic: str
) -> None:
    watcher = lab.watch(await lab.make(ArtSimBattery, *arguments))
    assert watcher.holds("battery") == []
    reports(lab, topic)(0.5)
    await lab.sleep(2.5)
    assert watcher.holds("battery") == [(50,)]


async def test_a_timer_can_be_asked_for_whatever_the_robot_is_named(lab: Lab) -> None:
    watcher = lab.watch(await lab.make(ArtSimBattery, "bot", option("source", "timer")))
    reports(lab, "/bot/battery_state")(0.5)
    await lab.sleep(1.5)
    assert watcher.values("battery") == [(100,), (99,)]


@pytest.mark.parametrize(
    ("shares", "shown", "lines"),
    [
        ((0.28997, 0.29, 0.2899999999, 0.999), [28, 29, 99], 0),  # not 100 before it is full
        ((1.4, 0.8), [100, 80], 0),
        ((1.6, 1.2, 40.0), [1, 40], 1),
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
    publish = reports(lab)
    for share in shares:
        publish(share)
        await lab.sleep(0.1)
    assert watcher.values("battery") == [(each,) for each in shown]
    assert len(lab.logged) == lines


async def test_a_message_without_a_charge_does_not_hide_the_last_one(lab: Lab, watcher: Watcher) -> None:
    publish = reports(lab)
    publish(0.6)
    await lab.sleep(0.1)
    publish(float("nan"))
    await lab.sleep(0.1)
    assert watcher.values("battery") == [(60,)]
    publish(0.0)
    await lab.sleep(0.1)
    assert watcher.values("battery") == [(60,), (0,)]


async def test_a_charge_that_expires_is_unknown_until_the_next_message(lab: Lab) -> None:
    watcher = lab.watch(await lab.make(ArtSimBattery, option("source", "robot"), option("expire", 2.0)))
    publish = reports(lab)
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


async def test_a_full_battery_off_the_dock_needs_no_charge(lab: Lab, artifact: ArtifactId) -> None:
    reports(lab)(1.0, "NOT_CHARGING")
    await lab.sleep(0.1)
    before = lab.clock.elapsed
    await lab.do(artifact, "operationRecharge")
    assert lab.clock.elapsed == before


@pytest.mark.parametrize(("arguments", "seconds"), [((), 5.0), ((option("dock_timeout", 2.0),), 2.0)])
async def test_a_recharge_off_the_dock_fails_after_the_timeout(
    lab: Lab, arguments: Any, seconds: float
) -> None:
    battery = await lab.make(ArtSimBattery, option("source", "robot"), *arguments)
    reports(lab)(0.5, "DISCHARGING")
    await lab.sleep(20)
    before = lab.clock.elapsed
    failed = await lab.call(battery, "operationRecharge")
    assert failed.reason == "not_docked"
    assert seconds <= lab.clock.elapsed - before <= seconds + 0.5


async def test_a_charge_that_has_stopped_rising_just_below_full_is_complete_after_the_timeout(
    lab: Lab,
) -> None:
    battery = await lab.make(ArtSimBattery, option("source", "robot"), option("dock_timeout", 3.0))
    publish = reports(lab)
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
    battery = await lab.make(ArtSimBattery, option("source", "robot"), option("dock_timeout", 3.0))
    publish = reports(lab)
    charging = lab.begin(battery, "operationRecharge")
    for _ in range(10):
        publish(0.99, "CHARGING")
        await lab.sleep(1.0)
    assert not charging.done.done()
    publish(0.99, "DISCHARGING")
    await charging.done
    assert charging.reason == "not_docked"
