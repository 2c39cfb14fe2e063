"""How one degree of freedom of a robot responds to commands: the delay, the acceleration and the dead band.

Candidates for the acceleration are simulated side by side, and compared with the measured speed of each possible delay
ago. Speeds are in metres or radians per second, times in seconds.
"""

import math
from collections import deque

from jacaros.plane.pose import clamp

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

    def expect(self, lag: int, acceleration: float, least: float) -> None:
        """Begin with values that were measured earlier; *least* is 0.0 if no dead band was found."""
        share = min(range(len(SHARES)), key=lambda i: abs(acceleration - SHARES[i] * self.declared))
        self.costs = [
            [SEEN * (abs(each - lag) / LAGS + abs(i - share) / len(SHARES)) for each in range(LAGS)]
            for i in range(len(SHARES))
        ]
        self.settle_on(lag)
        if least:
            self.lower, self.upper = 0.9 * least, least

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
