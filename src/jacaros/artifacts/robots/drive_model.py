"""What is measured of a robot while it drives, and where it will be when the next command takes effect.

A command takes effect late: it travels to the base, the wheels follow with a limited acceleration, and odometry
travels back. `DriveModel` compares the commands that were sent with the speeds that odometry shows. Candidates for the
delay and the acceleration are simulated side by side; the pair that explains odometry best is used. Lengths are in
metres, angles in radians, times in seconds.
"""

import math
from collections import deque
from dataclasses import dataclass

from jacaros.artifacts.robots.control import STANDSTILL, Limits, Velocity
from jacaros.artifacts.robots.filtering import Filtered
from jacaros.artifacts.robots.response import HELD, LAGS, TICK, WINDOW, Axis, ramp, vertex
from jacaros.plane.pose import Pose, clamp, normalised

LONGEST_PENDING = 3.0
"""Seconds of commands that may be on the way; without odometry, poses are made up anyway."""

STOOD = 0.09
"""Seconds for which odometry must show a standing robot: below its threshold, wheels may still roll out."""

RESTED = 2.0
"""Seconds after the last command from which on candidates that stand need not be moved."""

LATE = 0.15
"""Seconds of delay and jitter from which on they, and not the wheels, limit how exactly a robot is placed."""

SLOW = Velocity(0.1, 0.3)
"""Metres and radians per second above which a robot moves, however noisy its odometry is."""

ROLLING = Velocity(0.02, 0.05)
"""Metres and radians per second above which odometry shows movement."""


@dataclass(frozen=True, slots=True)
class DriveQuality:
    """What is known of a robot.

    Attributes:
        delay: seconds from a command until odometry shows its effect.
        acceleration, turn_acceleration: metres and radians per second squared, at most the declared ones.
        least, least_turn: the least speeds that roll: metres and radians per second; 0 while none was found.
    """

    delay: float
    acceleration: float
    turn_acceleration: float
    least: float = 0.0
    least_turn: float = 0.0


class DriveModel:
    """Measure a robot, and predict its pose.

    Args:
        limits: cruise speeds and declared accelerations.

    Attributes:
        linear, angular: the degrees of freedom.
        delay: seconds from a command until odometry shows its effect; long until it was measured.
        jitter: seconds by which messages are late irregularly.
        period: seconds between odometry messages.
        pose: the newest pose.
        measured: the delay has been measured.
    """

    def __init__(self, limits: Limits) -> None:
        self.linear = Axis(limits.speed, limits.acceleration, ROLLING.linear)
        self.angular = Axis(limits.turn_speed, limits.turn_acceleration, ROLLING.angular)
        self.delay = 2 * TICK * (LAGS - 1)
        self.jitter = self.period = 0.0
        self.measured = False
        self._x, self._y, self._heading = Filtered(), Filtered(), Filtered()
        self._commands: deque[tuple[float, Velocity]] = deque([(-math.inf, STANDSTILL)])
        self._ticked = -math.inf
        self._last: tuple[Pose, Velocity] | None = None
        self._changes = (0.0, 0.0, 0.0)
        self._at = self._received = -math.inf
        self._compared = self._rolled_at = -math.inf
        self._still = 0
        self._stood_since = -math.inf

    @property
    def pose(self) -> Pose:
        """The newest pose, filtered if odometry is noisy; the heading may be beyond a full turn."""
        return Pose(self._x.value, self._y.value, self._heading.value)

    @property
    def uncertainty(self) -> Velocity:
        """Standard deviations of the pose: metres and radians."""
        return Velocity(max(self._x.deviation, self._y.deviation), self._heading.deviation)

    @property
    def quality(self) -> DriveQuality | None:
        """What was measured; None before."""
        if not self.measured:
            return None
        return DriveQuality(
            self.delay,
            self.linear.acceleration,
            self.angular.acceleration,
            self.linear.lower and self.linear.least,
            self.angular.lower and self.angular.least,
        )

    def expect(self, quality: DriveQuality) -> None:
        """Begin with what was measured earlier, until this run measures something else."""
        self.delay, self.measured = clamp(quality.delay, self.delay), True
        self.linear.expect(self._lag(), quality.acceleration, quality.least)
        self.angular.expect(self._lag(), quality.turn_acceleration, quality.least_turn)

    def commanded(self, velocity: Velocity, now: float) -> None:
        """Note a command that is sent now."""
        if velocity != STANDSTILL:
            self._still = 0
        if velocity == self._commands[-1][1]:
            return
        self._commands.append((now, velocity))
        while self._commands[1][0] < now - LONGEST_PENDING:
            self._commands.popleft()

    def observed(self, pose: Pose, velocity: Velocity, received: float, late: float) -> None:
        """Note a message of odometry, received *late* seconds later than others were."""
        self._note_arrival(received)
        at = max(received - late, self._at)
        self._advance(at)
        standing = self._stands(velocity)
        since, command = self._commands[-1]
        unmoved = command == STANDSTILL and at > since + self.delay + self.jitter
        self._measure(pose, velocity, at - self._at, self._still >= 3 or len(self._commands) == 1)
        self._at = at
        if at - self._compared >= 0.04:
            self._compared = at
            self._compare(velocity)
        self._still = self._still + 1 if standing and unmoved else 0
        self._stood_since = self._stood_since if self._still > 1 else at

    def _note_arrival(self, received: float) -> None:
        interval = received - self._received
        self._received = received
        if interval > 2.0:
            return
        if not self.period:
            self.period = interval
        self.jitter += 0.05 * (3.0 * abs(interval - self.period) - self.jitter)
        self.period += 0.1 * (interval - self.period)

    def _advance(self, until: float) -> None:
        """Move the candidates on to *until*."""
        if until - self._ticked > 2.0 * WINDOW * TICK:
            self._ticked = until - WINDOW * TICK
        since, command = self._commands[-1]
        if command == STANDSTILL and until - since > RESTED and self.linear.rests and self.angular.rests:
            self._ticked = until
            return
        commands = self._commands
        index = len(commands) - 1
        while index > 0 and commands[index][0] > self._ticked:
            index -= 1
        while self._ticked + TICK <= until:
            self._ticked += TICK
            while index + 1 < len(commands) and commands[index + 1][0] <= self._ticked:
                index += 1
            wanted = commands[index][1]
            self.linear.advance(self.linear.effective(wanted.linear))
            self.angular.advance(wanted.angular if wanted.linear else self.angular.effective(wanted.angular))

    def _stands(self, velocity: Velocity) -> bool:
        return (
            abs(velocity.linear) <= self.linear.threshold and abs(velocity.angular) <= self.angular.threshold
        )

    def _measure(self, pose: Pose, velocity: Velocity, seconds: float, rests: bool) -> None:
        """Filter the pose and the speeds; a robot that *rests* shows how noisy they are."""
        coordinates = (self._x, self._y, self._heading)
        last, self._last = self._last, (pose, velocity)
        if last is None or seconds > 2.0:
            self._changes = (0.0, 0.0, 0.0)
            self._x.value, self._y.value = pose.x, pose.y
            self._heading.value += normalised(pose.yaw - self._heading.value)
            self.linear.speed, self.angular.speed = velocity
            return
        before, self._changes = self._changes, _changes(last[0], pose)
        if rests and abs(velocity.linear) < SLOW.linear and abs(velocity.angular) < SLOW.angular:
            # Differences, because the robot may be moved by others.
            for each, old, new in zip(coordinates, before, self._changes, strict=True):
                each.stand(new - old)
            self.linear.stand(velocity.linear - last[1].linear)
            self.angular.stand(velocity.angular - last[1].angular)
        v, w = (self.linear.speed + velocity.linear) / 2.0, (self.angular.speed + velocity.angular) / 2.0
        middle = self._heading.value + w * seconds / 2.0
        ways = (v * math.cos(middle) * seconds, v * math.sin(middle) * seconds, w * seconds)
        for each, way, value in zip(coordinates, ways, pose, strict=True):
            each.move(way)
            difference = value - each.value
            each.measure(normalised(difference) if each is self._heading else difference)
        self._filter_speeds(velocity)

    def _filter_speeds(self, velocity: Velocity) -> None:
        lag = self._lag()
        for axis, speed in ((self.linear, velocity.linear), (self.angular, velocity.angular)):
            expected = axis.expected(lag)
            share = 1.0 / (1.0 + (axis.noise / 0.02) ** 2)
            axis.speed = expected + share * (speed - expected)

    def _lag(self) -> int:
        return min(LAGS - 1, round(self.delay / (2.0 * TICK)))

    def _compare(self, velocity: Velocity) -> None:
        """Compare candidates with what odometry shows, and choose the best. A blocked robot shows nothing about itself."""
        excited, held_up = False, self._is_held_up(velocity)
        if held_up and self.measured:
            return
        for axis, speed in ((self.linear, velocity.linear), (self.angular, velocity.angular)):
            if axis.is_excited():
                axis.compare(speed)
                excited = True
        if not excited:
            return
        costs = [
            min(each[lag] for each in self.linear.costs) + min(each[lag] for each in self.angular.costs)
            for lag in range(LAGS)
        ]
        best = min(range(LAGS), key=costs.__getitem__)
        self.delay = 2.0 * TICK * (best + vertex(costs, best))
        self.measured = self.measured or not self._stands(velocity)
        self.linear.settle_on(best)
        self.angular.settle_on(best)

    def _is_held_up(self, velocity: Velocity) -> bool:
        """Note the commands at which the robot rolls or stands. Return whether it stands in spite of its commands."""
        if not self._stands(velocity):
            self._rolled_at = self._at
            self._note_rolling(velocity, self._at - self.delay)
            return False
        for axis, index in ((self.linear, 0), (self.angular, 1)):
            shown, held = self._at - self.delay, self.jitter + axis.held
            slowest = min(abs(each[index]) for each in self._sent(shown - held, shown))
            if slowest and self._at - self._rolled_at > held:
                axis.did_not_roll(slowest)
                return True
            if slowest:
                return False  # it turns while it drives
        return False

    def _note_rolling(self, velocity: Velocity, shown: float) -> None:
        """Note the commands at which the robot rolls, if they are known; odometry shows those until *shown*."""
        if self.measured:
            commands = self._sent(shown - self.jitter - HELD, shown + self.jitter)
            fastest = max(abs(each.linear) for each in commands)
            if self.linear.threshold < abs(velocity.linear) <= 1.2 * fastest:
                self.linear.rolled(max(fastest, abs(velocity.linear)))
            turn = max(abs(each.angular) for each in commands)
            if not fastest and self.angular.threshold < abs(velocity.angular) <= 1.2 * turn:
                self.angular.rolled(max(turn, abs(velocity.angular)))

    def _sent(self, start: float, end: float) -> list[Velocity]:
        """Return the commands that held between two times."""
        return [each for *_, each in self._pending(start, end)]

    def ahead(self, now: float) -> tuple[Pose, Velocity]:
        """Return pose and velocity at the moment at which a command that is sent now takes effect."""
        x, y, heading = self._x.value, self._y.value, self._heading.value
        v, w = self.linear.speed, self.angular.speed
        start = max(self._at - self.delay, now - LONGEST_PENDING)
        for begin, end, wanted in self._pending(start, now):
            seconds = end - begin
            to_v = self.linear.effective(wanted.linear)
            to_w = wanted.angular if wanted.linear else self.angular.effective(wanted.angular)
            dv, v = ramp(v, to_v, self.linear.acceleration, seconds)
            dw, w = ramp(w, to_w, self.angular.acceleration, seconds)
            middle = heading + dw / 2.0
            x += dv * math.cos(middle)
            y += dv * math.sin(middle)
            heading += dw
        return Pose(x, y, heading), Velocity(v, w)

    def _pending(self, start: float, now: float) -> list[tuple[float, float, Velocity]]:
        """Return the commands that odometry does not show yet, with the times from and to which they count."""
        found: list[tuple[float, float, Velocity]] = []
        end = now
        for at, velocity in reversed(self._commands):
            begin = max(at, start)
            while end - begin > 0.1:  # steps are short, for curves
                found.append((end - 0.1, end, velocity))
                end -= 0.1
            if end > begin:
                found.append((begin, end, velocity))
            end = min(end, begin)
            if at <= start:
                break
        found.reverse()
        return found

    def has_rolled(self, driving: bool) -> bool:
        """Return whether the robot ever followed a command to drive, or to turn."""
        return (self.linear if driving else self.angular).has_rolled

    @property
    def is_late(self) -> bool:
        """Whether the robot reacts too late, or too irregularly, for short pulses."""
        return self.delay + self.jitter > LATE

    def __str__(self) -> str:
        """Describe what was measured, for messages."""
        quality = self.quality
        if quality is None:
            return "nothing was measured yet"
        text = f"measured: {quality.delay:.2f} s of delay, {quality.acceleration:.2g} m/s2"
        if quality.least:
            text += f", rolls from {quality.least:.2g} m/s on"
        if quality.least_turn:
            text += f", turns from {math.degrees(quality.least_turn):.2g} degrees/s on"
        return text

    def has_come_to_rest(self) -> bool:
        """Return whether the robot stands and nothing is on the way that would move it."""
        if len(self._commands) == 1:
            return self._still >= 1
        return self._still >= 2 and self._at - self._stood_since >= STOOD


def _changes(old: Pose, new: Pose) -> tuple[float, float, float]:
    return new.x - old.x, new.y - old.y, normalised(new.yaw - old.yaw)
