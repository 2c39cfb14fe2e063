"""A robot whose delay, acceleration, dead band and noise are known, and the model that measures them."""

import math
import random

from jacaros.robots.artifacts.drive_model import DriveModel, Limits, Velocity
from jacaros.robots.plane.pose import Pose

LIMITS = Limits(speed=0.6, turn_speed=2.0, acceleration=0.8, turn_acceleration=4.0)
STEP = 0.01


class Plant:
    """A robot that follows commands late, with its own acceleration, and shows it in odometry.

    Args:
        delay: seconds from a command until odometry shows its effect.
        acceleration, turn_acceleration: its limits.
        dead: speeds below which its wheels do not roll.
        noise: standard deviations of odometry's pose (metres, radians) and speeds.
        period: seconds between messages.
        limits: what the robot was declared to have.
    """

    def __init__(
        self,
        delay: float = 0.2,
        acceleration: float = 0.8,
        turn_acceleration: float = 4.0,
        dead: tuple[float, float] = (0.0, 0.0),
        noise: tuple[float, float] = (0.0, 0.0),
        period: float = 0.05,
        limits: Limits = LIMITS,
    ) -> None:
        self.model, self.limits = DriveModel(limits), limits
        self.delay, self.rates, self.dead, self.noise = delay, (acceleration, turn_acceleration), dead, noise
        self.period = period
        self.steps = 100_000
        self.pose, self.velocity = Pose(0.0, 0.0, 0.0), Velocity()
        self.wanted = [(-1.0, Velocity())]
        self.random = random.Random(5)

    @property
    def now(self) -> float:
        return self.steps * STEP

    def drive(self, linear: float, angular: float, seconds: float) -> None:
        """Send a command, and let time pass."""
        command = Velocity(linear, angular)
        self.model.commanded(command, self.now)
        self.wanted.append((self.now + self.delay, command))
        self.wait(seconds)

    def wait(self, seconds: float) -> None:
        for _ in range(round(seconds / STEP)):
            self.steps += 1
            self._move(next(each for at, each in reversed(self.wanted) if at < self.now - STEP / 2))
            if self.steps % round(self.period / STEP) == 0:
                self.model.observed(*self._measured(), self.now, 0.0)

    def _move(self, wanted: Velocity) -> None:
        targets = [each if abs(each) >= dead else 0.0 for each, dead in zip(wanted, self.dead, strict=True)]
        v, w = (
            now + max(-rate * STEP, min(rate * STEP, target - now))
            for now, target, rate in zip(self.velocity, targets, self.rates, strict=True)
        )
        x, y, heading = self.pose
        middle = heading + w * STEP / 2
        self.velocity = Velocity(v, w)
        self.pose = Pose(x + v * STEP * math.cos(middle), y + v * STEP * math.sin(middle), heading + w * STEP)

    def _measured(self) -> tuple[Pose, Velocity]:
        if self.noise == (0.0, 0.0):
            return self.pose, self.velocity
        pose, speed = self.noise
        gauss = self.random.gauss
        return (
            Pose(*(each + gauss(0.0, pose) for each in self.pose)),
            Velocity(*(each + gauss(0.0, speed) for each in self.velocity)),
        )
