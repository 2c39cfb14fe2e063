"""A measured coordinate, filtered by its noise."""

import math

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
