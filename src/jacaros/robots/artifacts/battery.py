"""``ArtSimBattery``: a battery drained by a timer, as in the thesis, or the robot's own battery."""

import math
from functools import partial
from typing import ClassVar

from jacaros.artifacts.env.artifact import Out, internal_operation, operation
from jacaros.robots.kit.options import not_negative, number, one_of, positive, text
from jacaros.robots.kit.reading import Reading
from jacaros.robots.kit.ros_artifact import RosArtifact
from jacaros.robots.ros.message import constant
from jacaros.robots.ros.node import Sample
from jacaros.robots.ros.qos import SENSOR_DATA
from jacaros.robots.streams import ReadingPolicy

FULL, MEDIUM, LOW = 100, 50, 20
"""Percent: charged; medium from here down; low from here down."""

CHARGE_STEP, CHARGE_PERIOD = 10, 0.5
"""A timer battery gains this percentage each period in seconds, as in the thesis."""

AS_GOOD_AS_FULL = 0.995
"""Fraction from which a charge that no longer rises counts as full: old batteries never report 1."""

_ALMOST = 1e-4
"""Percentage lost in the 32 bits of a message."""

UNKNOWN = -1
"""Percentage before the robot's first message."""


def diagnosis(percent: float, medium: float = MEDIUM, low: float = LOW) -> str:
    """Return the thesis's words for a charge: "Low Battery" up to *low* percent, "Medium Battery" up to *medium*."""
    if percent <= low:
        return "Low Battery"
    return "Medium Battery" if percent <= medium else "Full Battery"


class ArtSimBattery(RosArtifact):
    """Shows the charge of the battery.

    Made without arguments, it is the thesis's simulation: a timer drains one percent per second, and recharging adds
    ten percent every half second wherever the robot is. Made with a robot's name or one of the options
    ``source(robot)``, ``topic(T)`` and ``namespace(N)``, it follows that robot's ``/battery_state``, and charges only
    in a dock.

    Options:
        drain(P): percent per second of the timer (1); 0: it never drains.
        level(N): initial percentage (100) of the timer battery.
        medium(P), low(P): percent up to which the diagnosis is "Medium Battery" (50) and "Low Battery" (20).
        source(S): ``timer`` or ``robot``.
        topic(T): another topic than ``battery_state``.
        expire(S): seconds without a message after which the robot's charge is unknown again.
        dock_timeout(S): seconds that `operation_recharge` waits for the dock's current (5).

    Properties:
        battery(N): a robot's charge is rounded down, so that 100 means full. N: whole number in percent.
        diagnostics(Text): "Full Battery", "Medium Battery" (50 % and less) or "Low Battery" (20 % and less), or
            as the options say. Before a robot's first message neither property exists.
    """

    known_options: ClassVar = {
        "drain": not_negative,
        "level": number,
        "medium": not_negative,
        "low": not_negative,
        "source": one_of("timer", "robot"),
        "topic": text,
        "dock_timeout": positive,
        "expire": positive,
    }

    def open(self) -> None:
        """Start the timer, or subscribe to the robot's battery."""
        self._level: int = UNKNOWN
        self._levels = self.option("medium", MEDIUM), self.option("low", LOW)
        if self._levels[1] > self._levels[0]:
            self.fail("low({1:g}) is above medium({0:g})".format(*self._levels), "wrong_option", "low")
        self._charging = False
        self._draining = False
        self._share = math.inf
        self._charge = Charge()
        self._fed_at = -math.inf
        self._full_since = math.inf
        expire: float | None = self.option("expire", None)
        policy = ReadingPolicy(on_demand=True, expire=expire)
        forget = partial(self.start, self.forget_battery)
        self._reported = self.kept(Reading(policy, self.clock, on_withdraw=forget))
        is_robots = bool(self.robot) or "topic" in self.options or "namespace" in self.options
        self.follows_robot = self.option("source", "robot" if is_robots else "timer") == "robot"
        if self.follows_robot:
            topic = self.option("topic", "battery_state")
            self._faulty = self.faults_of(topic)
            self.subscription(topic, "sensor_msgs/msg/BatteryState", self._take, SENSOR_DATA)
        else:
            self._show(max(0, min(FULL, round(self.option("level", FULL)))))
            self._drain_on()

    def _show(self, level: int) -> None:
        """Show a charge; update the diagnosis only if it changes."""
        words = diagnosis(level, *self._levels)
        if self._level == UNKNOWN:
            self.define_property("battery", level)
            self.define_property("diagnostics", words)
        else:
            self.update_property("battery", level, if_new=True)
            self.update_property("diagnostics", words, if_new=True)
        self._level = level

    # The timer.

    def _drain_on(self) -> None:
        if not self._draining and self._level > 0 and self.option("drain", 1.0) > 0:
            self._draining = True
            self.start(self.drain)

    @internal_operation
    async def drain(self) -> None:
        """Drain one percent at a time until the battery is empty; pause while it is charged."""
        try:
            while self._level > 0:
                await self.sleep(1.0 / self.option("drain", 1.0))
                if not self._charging:
                    self._show(self._level - 1)
        finally:
            self._draining = False

    async def _charge_by_timer(self) -> None:
        if self._charging:
            await self.until(lambda: not self._charging)
        self._charging = True
        try:
            while self._level < FULL:
                self._show(min(FULL, self._level + CHARGE_STEP))
                await self.sleep(CHARGE_PERIOD)
        finally:
            self._charging = False
            self._drain_on()

    # The robot.

    def _take(self, sample: Sample) -> None:
        state = sample.message
        status = int(state.power_supply_status)
        charging = status == constant(state, "POWER_SUPPLY_STATUS_CHARGING")
        full = status == constant(state, "POWER_SUPPLY_STATUS_FULL")
        told = self._told(float(state.percentage))
        share = self._share if told is None else told
        # Many drivers report no status; a rising charge then shows that there is current.
        rises = share > self._share
        if charging or full or rises:
            self._fed_at = self.clock.elapsed
        self._share = share
        if told is not None:
            level = FULL if full else min(FULL, math.floor(100.0 * share + _ALMOST))
            if level < FULL and share < AS_GOOD_AS_FULL:
                self._full_since = math.inf
            elif self._full_since == math.inf or (rises and level < FULL):
                self._full_since = self.clock.elapsed
            self.start(self.show_battery, level, charging, cause=sample.cause)
            self._reported.take((level,))

    def _told(self, told: float) -> float | None:
        """Return the charge as a fraction of 1; None, after reporting it, if the message has none."""
        known = self._charge.in_percent
        share = self._charge.share(told)
        if share is None:
            report = self._faulty.out_of_range if math.isfinite(told) else self._faulty.not_finite
            report("percentage", told)
        elif self._charge.in_percent and not known:
            self.log(f"the robot reports a charge of {told:g}; expected 0 to 1, assuming percent")
        return share

    @internal_operation
    def show_battery(self, level: int, charging: bool) -> None:
        """Show the robot's charge."""
        self._charging = charging
        self._show(level)

    @internal_operation
    def forget_battery(self) -> None:
        """Show nothing: the robot's last message has expired."""
        if self._level != UNKNOWN:
            self._level = UNKNOWN
            self.remove_property("battery")
            self.remove_property("diagnostics")

    async def _charge_in_dock(self) -> None:
        patience = self.option("dock_timeout", 5.0)
        begin = self.clock.elapsed
        while not self._is_full(patience):
            if self._level < FULL and self.clock.elapsed - max(begin, self._fed_at) > patience:
                self.fail("the robot's battery is not charging: the robot is not in a dock", "not_docked")
            await self.sleep(CHARGE_PERIOD)

    def _is_full(self, patience: float) -> bool:
        """Return whether the robot has finished charging, or has been charging for long without a rising charge."""
        if self._level == FULL and not self._charging:
            return True
        return self.clock.elapsed - self._full_since > patience

    # Operations.

    @operation(name="operationRecharge")
    async def operation_recharge(self) -> None:
        """Charge the battery and wait until it is full.

        With a robot's battery, fails with ``not_docked`` if it does not start charging within `dock_timeout`.
        """
        if self.follows_robot:
            await self._charge_in_dock()
        else:
            await self._charge_by_timer()

    @operation(name="getCurrentBattery")
    async def get_current_battery(self, level: Out) -> None:
        """Give the charge in percent; fails with ``no_battery(5)`` if the robot does not report it within 5 s."""
        if self._level == UNKNOWN:
            await self.newest(self._reported, "no_battery")
        level.set(self._level)


# The charge in a ``sensor_msgs/msg/BatteryState``.

MORE_THAN_FULL = 1.5
"""A driver that reports more than this uses percent: the message type defines a fraction of 1, but some drivers
ignore that."""


class Charge:
    """Read the charge of one robot's messages.

    Attributes:
        in_percent: whether a message has shown that the driver uses percent; it keeps doing so at 1 %.
    """

    def __init__(self) -> None:
        self.in_percent = False

    def share(self, percentage: float) -> float | None:
        """Return the charge as a fraction of 1, from the field of that name; None if the message has none."""
        if not (math.isfinite(percentage) and percentage >= 0.0):
            return None
        self.in_percent = self.in_percent or percentage > MORE_THAN_FULL
        return percentage / 100.0 if self.in_percent else percentage
