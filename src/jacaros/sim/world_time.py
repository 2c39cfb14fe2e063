"""Connects a world to a clock: on each access, the world makes all steps that are due."""

import math

from jacaros.runtime.clock import Clock
from jacaros.sim.world import STEP, World

SET_BACK = 0.1
"""Seconds that a clock must be behind the world to count as set back; rounding errors are smaller."""

_NEARLY = 1e-3
"""Fraction of a step by which a rounding error may make a step seem not yet due."""


class WorldTime:
    """The time of a world on a clock.

    A world is visible only through its messages. It is therefore stepped just before a message is published or a command
    arrives, several steps of 20 ms in a row. A command takes effect at the first step after its arrival, exactly as if the
    steps had been made one by one, and a virtual run need not stop fifty times a second.

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
        """Seconds since the world began; if the clock is set back, the world continues from its current state."""
        passed = self.clock.now() - self.epoch
        if passed < self.world.time - SET_BACK:
            self.epoch = self.clock.now() - self.world.time
            return self.world.time
        return passed

    def now(self) -> float:
        """Time of the current state on the clock (seconds): the stamp of its messages."""
        return self.epoch + self.world.time
