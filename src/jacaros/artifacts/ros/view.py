"""The range of view (thesis, section 6.3): of all that a message holds, what lies near the robot."""

import math
from collections.abc import Callable, Iterable

from jacaros.artifacts.ros.reading import Values
from jacaros.trace import Cause

MOVED = 0.01
"""Metres that a robot must have moved before what is in view is looked at anew."""

Place = Callable[[Values], tuple[float, float]]
"""Where an element lies: x and y in metres, in the frame of the robot's position."""


def first_two(element: Values) -> tuple[float, float]:
    """The place of an element whose first two values are x and y."""
    x, y = element[:2]
    assert isinstance(x, int | float)
    assert isinstance(y, int | float)
    return float(x), float(y)


class RangeOfView:
    """The elements of the newest message that lie within a range of the robot.

    Until the robot's position is known nothing is in view.

    Args:
        reach: metres; an element just so far away is in view.
        show: takes the elements in view, in the order of the message, whenever they have changed.
        place: where an element lies.
    """

    def __init__(
        self, reach: float, show: Callable[[list[Values], Cause | None], None], place: Place = first_two
    ) -> None:
        self._reach, self._show, self._place = reach, show, place
        self._elements: list[tuple[float, float, Values]] = []
        self._here: tuple[float, float] | None = None
        self._shown: list[Values] = []

    def take(self, elements: Iterable[Values], cause: Cause | None = None) -> None:
        """Take the elements of a message; one whose place is not finite is never in view."""
        self._elements = [(*self._place(each), each) for each in elements]
        self._look(cause)

    def stand(self, x: float, y: float, cause: Cause | None = None) -> None:
        """Be told where the robot is."""
        before = self._here
        if before is None or math.dist(before, (x, y)) > MOVED:
            self._here = (x, y)
            self._look(cause)

    def _look(self, cause: Cause | None) -> None:
        if self._here is None:
            return
        here_x, here_y = self._here
        seen = [
            element for x, y, element in self._elements if math.hypot(x - here_x, y - here_y) <= self._reach
        ]
        if seen != self._shown:
            self._shown = seen
            self._show(seen, cause)
