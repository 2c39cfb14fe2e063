"""Joins a world to a clock: on each access, the world makes all steps that are due."""

import math

from jacaros.clock import Clock
from jacaros.sim.world import STEP, World

SET_BACK = 0.1
"""Seconds by which a clock is behind the world when it was set back; rounding is less."""

_NEARLY = 1e-3
"""Part of a step by which a float's error may make a step seem not yet due."""


class WorldTime:
    """The time of a world on a clock.

    A world cannot be seen but through its messages, so it is stepped just before something is published or
    commanded, several steps of 20 ms at once: a command applies at the first step after the moment it came,
    exactly as if the steps had been made one by one, and a virtual run need not stop fifty times a second.

    Attributes:
        world: the world.
        clock: the clock.
        epoch: the clock's time at which the world's time was 0, in seconds.
    """

    def __init__(self, world: World, clock: Clock) -> None:
        self.world, self.clock = world, clock
        self.epoch = clock.now() - world.time

    def catch_up(self) -> None:
        """Make all steps that are due now."""
        due = math.floor(self.passed() / STEP + _NEARLY) - round(self.world.time / STEP)
        for _ in range(due):
            self.world.step()

    def passed(self) -> float:
        """Seconds since the world began; when the clock was set back the world goes on from where it is."""
        passed = self.clock.now() - self.epoch
        if passed < self.world.time - SET_BACK:
            self.epoch = self.clock.now() - self.world.time
            return self.world.time
        return passed

    def now(self) -> float:
        """When the present state of the world was, on the clock (seconds): the stamp of its messages."""
        return self.epoch + self.world.time
