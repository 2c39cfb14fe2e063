"""The laser range finder, in plain Python or numpy, whichever is faster for the world; the ranges are equal."""

import random
from collections.abc import Iterable, Sequence
from typing import Any

from jacaros.sim.description import LaserSettings, Segment
from jacaros.sim.robot.sensors.laser_plain import Beams, Circle, sweep_circles, sweep_walls

FEW_WALLS = 4
"""Number of walls up to which plain Python is as fast as numpy, and saves its import."""

FEW_CIRCLES = 2
"""The same for the number of robots and people in range."""


class Laser:
    """One robot's laser.

    Attributes:
        settings: settings from the world file.
        beams: its beams, with ``angle_min``, ``angle_max`` and ``angle_increment``.
    """

    def __init__(
        self, settings: LaserSettings, segments: Sequence[Segment], seed: str, with_numpy: bool | None = None
    ) -> None:
        """Create the laser; *with_numpy* selects an implementation, None the faster one. Both return the same bits."""
        self.settings = settings
        self.beams = Beams(settings)
        self._segments = segments
        self._draw = random.Random(seed).random
        self._with_numpy = len(segments) > FEW_WALLS if with_numpy is None else with_numpy
        self._arrays: Any = None

    def look_at(self, segments: Sequence[Segment]) -> None:
        """Replace the walls."""
        self._segments, self._arrays = segments, None

    def scan(self, x: float, y: float, yaw: float, others: Iterable[Circle] = ()) -> list[float]:
        """Return ranges (metres) of the field of view, counter-clockwise; ``inf`` for no echo in range."""
        noise, reach = self.settings.noise, self.settings.range_max
        swept = self._sweep(x, y, yaw, [each for each in others if _near(each, x, y, reach + noise)])
        swept = swept[self.beams.first : self.beams.last]
        if noise:
            swept = [value + (self._draw() * 2.0 - 1.0) * noise for value in swept]
        return [value if value <= reach else float("inf") for value in swept]

    def _sweep(self, x: float, y: float, yaw: float, circles: list[Circle]) -> list[float]:
        if self._with_numpy and self._arrays is None:
            self._arrays = self._wall_arrays()
        if not self._with_numpy:
            ranges = sweep_walls(self._segments, x, y, yaw, self.beams)
            sweep_circles(ranges, circles, x, y, yaw, self.beams)
            return ranges
        if len(circles) > FEW_CIRCLES:
            swept: list[float] = self._arrays.sweep(x, y, yaw, circles)
        else:
            swept = self._arrays.sweep(x, y, yaw)
            sweep_circles(swept, circles, x, y, yaw, self.beams)
        return swept

    def _wall_arrays(self) -> Any:
        """Return the walls as arrays; None where numpy, which is optional, is not installed."""
        try:
            # numpy takes a third of a second to import: only the first wanted scan pays for it.
            from jacaros.sim.robot.sensors.laser_numpy import WallArrays
        except ImportError:
            self._with_numpy = False
            return None
        return WallArrays(self._segments, self.beams)


def _near(circle: Circle, x: float, y: float, reach: float) -> bool:
    """Return whether a beam of *reach* metres can meet a circle."""
    ex, ey, far = circle[0] - x, circle[1] - y, reach + circle[2]
    return ex * ex + ey * ey < far * far
