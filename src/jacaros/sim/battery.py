"""The robot's battery: it drains with time and with motion, and charges in a dock only."""

from jacaros.sim.description import BatterySettings

FULL_VOLTAGE = 16.4
EMPTY_VOLTAGE = 12.8


class Battery:
    """A battery with a level in percent, 0 to 100.

    Attributes:
        level: percent left.
        charging: True while a dock gives it current and it is not full.
    """

    __slots__ = ("charging", "level", "settings")

    def __init__(self, settings: BatterySettings) -> None:
        self.settings = settings
        self.level = settings.level
        self.charging = False

    def step(self, dt: float, distance: float, turn: float, docked: bool) -> None:
        """Let *dt* seconds pass in which the robot drove *distance* metres and turned *turn* radians."""
        settings = self.settings
        drain = settings.drain_per_second * dt
        drain += settings.drain_per_metre * abs(distance) + settings.drain_per_radian * abs(turn)
        if docked:
            # The dock feeds the robot too, so a full battery stays full.
            level = self.level + settings.charge_per_second * dt
            self.level = 100.0 if level > 100.0 else level
        else:
            self.level = self.level - drain if self.level > drain else 0.0
        self.charging = docked and self.level < 100.0

    @property
    def empty(self) -> bool:
        """True when the motors get no current any more."""
        return self.level <= 0.0

    @property
    def voltage(self) -> float:
        """Volts, falling in a straight line from a full to an empty four-cell battery."""
        return EMPTY_VOLTAGE + (FULL_VOLTAGE - EMPTY_VOLTAGE) * self.level / 100.0
