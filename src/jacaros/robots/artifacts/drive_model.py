"""What is measured of a robot while it drives, and where it will be when the next command takes effect.

A command takes effect late: it travels to the base, the wheels follow with a limited acceleration, and odometry
travels back. `DriveModel` compares the commands that were sent with the speeds that odometry shows. Candidates for the
delay and the acceleration are simulated side by side; the pair that explains odometry best is used. Lengths are in
metres, angles in radians, times in seconds."""

import math
from collections import deque
from dataclasses import dataclass
from typing import NamedTuple

from jacaros.robots.plane.pose import Pose, clamp, normalised


class Velocity(NamedTuple):
    """A command or a measurement: metres per second ahead, radians per second to the left."""

    linear: float = 0.0
    angular: float = 0.0


STANDSTILL = Velocity()
"""The command that stops a robot."""


@dataclass(frozen=True, slots=True)
class Limits:
    """What a robot can do; the defaults are those of a TurtleBot 2.

    Attributes:
        speed: metres per second.
        turn_speed: radians per second.
        acceleration: metres per second squared.
        turn_acceleration: radians per second squared.
    """

    speed: float = 0.65
    turn_speed: float = math.pi
    acceleration: float = 0.8
    turn_acceleration: float = 5.0

    def clip(self, velocity: Velocity) -> Velocity:
        """Return the nearest velocity that the robot can drive."""
        return Velocity(clamp(velocity.linear, self.speed), clamp(velocity.angular, self.turn_speed))


DRIFT = 0.02
"""Share of the way by which odometry's speeds may differ from its poses."""


class Filtered:
    """A measured coordinate and its uncertainty; for exact odometry, simply its newest value."""

    def __init__(self) -> None:
        self.value = 0.0
        self.noise = 0.0
        self._variance = 0.0

    @property
    def deviation(self) -> float:
        """Standard deviation of the value."""
        return math.sqrt(self._variance)

    def move(self, way: float) -> None:
        """Move by *way* before the next measurement."""
        self.value += way
        self._variance += (DRIFT * way) ** 2 + 1e-8

    def measure(self, difference: float) -> None:
        """Correct by a measurement that is *difference* from the value."""
        noise = self.noise * self.noise
        if difference * difference > 25.0 * (self._variance + noise):
            self._variance = difference * difference  # the robot was moved, or localised anew
        share = self._variance / (self._variance + noise) if noise > 0.0 else 1.0
        self.value += share * difference
        self._variance *= 1.0 - share

    def stand(self, difference: float) -> None:
        """Learn the noise from the *difference* of two changes of a standing robot."""
        self.noise = math.sqrt(0.9 * self.noise * self.noise + 0.1 * min(difference * difference / 6.0, 1e-2))


# How one degree of freedom of a robot responds to commands. Candidates for the acceleration are simulated side by
# side, and compared with the measured speed of each possible delay ago.

TICK = 0.025
"""Seconds between two states of the simulated candidates."""

LAGS = 28
"""Number of candidates for the delay, two ticks apart: up to 1.35 s."""

SHARES = (0.125, 0.177, 0.25, 0.354, 0.5, 0.707, 1.0)
"""Candidates for the acceleration, as shares of the limit that the robot was declared to have."""

WINDOW = 2 * LAGS - 1

KEEP = 0.98
"""Weight that an older comparison keeps with each newer one."""

SEEN = 1e-3
"""Squared relative error that separates candidates; until then, the longest delay is assumed."""

HELD = 0.2
"""Seconds of the same command that count, beside those in which the wheels speed up."""

STEP = 1.4
"""Factor by which a command is raised that does not move the robot."""


class Axis:
    """One degree of freedom: driving ahead or turning.

    Args:
        cruise: greatest speed that is commanded.
        acceleration: declared limit.
        rolling: speed above which odometry shows movement.

    Attributes:
        speed: the newest speed, filtered.
        acceleration: the measured limit, at most the declared one.
        lower: greatest speed at which the robot was commanded to move and did not; 0.0: none.
        upper: least speed at which it rolled.
        has_rolled: it has followed a command.
        noise: standard deviation of the measured speed of a standing robot.
    """

    def __init__(self, cruise: float, acceleration: float, rolling: float) -> None:
        self.speed = 0.0
        self.cruise = cruise
        self.acceleration = acceleration
        self.declared = acceleration
        self.lower, self.upper = 0.0, math.inf
        self.has_rolled = False
        self.noise = 0.0
        self._rolling = rolling
        self._scale = 1.0 / (cruise * cruise)
        self._rates = [TICK * acceleration * share for share in SHARES]
        self._states = [deque([0.0] * WINDOW, WINDOW) for _ in SHARES]
        self.costs = [[SEEN * (LAGS - lag) / LAGS for lag in range(LAGS)] for _ in SHARES]

    @property
    def least(self) -> float:
        """The least speed that is expected to roll."""
        return min(self.cruise, self.upper, max(self._rolling, STEP * self.lower))

    @property
    def threshold(self) -> float:
        """Speed above which odometry shows movement."""
        return max(self._rolling, 3.0 * self.noise)

    @property
    def held(self) -> float:
        """Seconds of the same command after which odometry shows that the robot rolls."""
        return HELD + self.threshold / self.acceleration

    def advance(self, wanted: float) -> None:
        """Move all candidates on by one tick with the command *wanted*."""
        for states, rate in zip(self._states, self._rates, strict=True):
            now = states[-1]
            states.append(now + clamp(wanted - now, rate))

    @property
    def rests(self) -> bool:
        """Whether the slowest candidate, and so every one, has come to rest."""
        return not self._states[0][-1] and not self._states[-1][0]

    def is_excited(self) -> bool:
        """Return whether the candidates differ, so that a measurement tells something."""
        states = self._states[-1]
        return max(states) - min(states) > self._rolling

    def compare(self, speed: float) -> None:
        """Add the errors of all candidates against a measured speed."""
        for states, costs in zip(self._states, self.costs, strict=True):
            for lag, state in enumerate(list(states)[::-2]):
                error = speed - state
                costs[lag] = KEEP * costs[lag] + self._scale * error * error

    def stand(self, difference: float) -> None:
        """Learn the noise from the *difference* of two speeds of a standing robot."""
        self.noise = math.sqrt(0.9 * self.noise * self.noise + 0.1 * min(difference * difference / 2.0, 1e-2))

    def expected(self, lag: int) -> float:
        """Return the speed of the best candidate with this delay."""
        best = min(range(len(SHARES)), key=lambda i: (self.costs[i][lag], -i))
        return self._states[best][-1 - 2 * lag]

    def settle_on(self, lag: int) -> None:
        """Use the acceleration that explains the measurements best with this delay."""
        costs = [each[lag] for each in self.costs]
        best = min(range(len(SHARES)), key=lambda i: (costs[i], -i))
        self.acceleration = self.declared * SHARES[best]

    def effective(self, wanted: float) -> float:
        """Return the speed that the wheels follow: none below the dead band."""
        return wanted if abs(wanted) > self.lower else 0.0

    def did_not_roll(self, speed: float) -> bool:
        """Note that the robot stood at this command; return whether a faster one may help.

        Far above a speed at which it has rolled, it is blocked.
        """
        if speed >= min(1.5 * self.upper, 0.9 * self.cruise):
            return False
        self.lower = max(self.lower, speed)
        self.upper = max(self.upper, STEP * speed)
        return True

    def rolled(self, speed: float) -> None:
        """Note that the robot rolled at this command."""
        self.has_rolled = True
        self.upper = min(self.upper, speed)
        self.lower = min(self.lower, 0.9 * self.upper)


def vertex(costs: list[float], best: int) -> float:
    """Return where between its neighbours the minimum of a parabola lies, from -0.5 to 0.5."""
    if not 0 < best < len(costs) - 1:
        return 0.0
    before, at, after = costs[best - 1 : best + 2]
    bend = before - 2.0 * at + after
    return 0.5 * (before - after) / bend if bend > 0.0 else 0.0


def ramp(speed: float, wanted: float, acceleration: float, seconds: float) -> tuple[float, float]:
    """Return the way and the new speed of wheels that follow *wanted*."""
    change = wanted - speed
    needed = abs(change) / acceleration
    if needed <= seconds:
        return (speed + wanted) / 2.0 * needed + wanted * (seconds - needed), wanted
    after = speed + math.copysign(acceleration * seconds, change)
    return (speed + after) / 2.0 * seconds, after


# The whole robot.

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
