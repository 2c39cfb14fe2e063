"""The part of an artifact that updates properties from sensors: readings, and the elements in a robot's range of
view."""

import math
from collections.abc import Callable, Iterable
from functools import partial

from jacaros.artifacts.env.artifact import internal_operation
from jacaros.artifacts.kit.connected_artifact import ConnectedArtifact
from jacaros.artifacts.kit.reading import Outlet, Reading, ReadingPolicy, Values
from jacaros.runtime.trace import Cause

FIRST_MESSAGE = 5.0
"""Seconds that an operation waits for the first message of a sensor."""


class SensingArtifact(ConnectedArtifact):
    """An artifact with sensor readings; see `jacaros.artifacts.kit.ros_artifact.RosArtifact`."""

    def reading(self, name: str, policy: ReadingPolicy, *initial: object, topic: str = "") -> Reading:
        """Update the property *name* from a sensor according to *policy*, until the artifact is disposed.

        The callback of the sensor passes its values to `Reading.take`; an operation that updates the property on
        request calls `refresh`. If the property does not exist, the next values define it.

        Args:
            name: name of the property.
            policy: when the property is updated.
            initial: values before the first message; not shown if the policy makes values expire.
            topic: topic of the robot under which messages with NaN or infinite numbers are reported; default: *name*.
        """
        if initial and policy.expire is None:
            self.define_property(name, *initial)
        faults = self.faults_of(topic) if topic else self.faults_at(name)

        def deliver(values: Values, cause: Cause | None) -> None:
            self._tell_readings([(name, values)], cause)

        behind = partial(self._steps.publication.has_untaken, name)
        outlet = Outlet(
            partial(self.start, self.withdraw_reading, name), partial(faults.not_finite, name), behind
        )
        return self.kept(Reading(policy, self.clock, deliver, outlet, name))

    def take_together(self, cause: Cause | None, *taken: tuple[Reading, Values]) -> None:
        """Pass the values of one message, whose numbers are known to be finite, to several readings; all updates are
        published in one step."""
        shown = [(reading.name, values) for reading, values in taken if reading.offer(values, cause)]
        if shown:
            self._tell_readings(shown, cause)

    def _tell_readings(self, shown: list[tuple[str, Values]], cause: Cause | None) -> None:
        """Update properties now, or as soon as the artifact is free."""
        if not self._steps.tell(self._show_values, shown, cause):
            self._steps.publication.coming.update(name for name, _ in shown)
            self.start(self.show_readings, shown, cause=cause)

    @internal_operation
    def show_readings(self, shown: object) -> None:
        """Update properties from a sensor: pairs of name and values."""
        assert isinstance(shown, list)
        self._steps.publication.coming.difference_update(name for name, _ in shown)
        for name, values in shown:
            self._show_values(name, values)

    @internal_operation
    def withdraw_reading(self, name: str) -> None:
        """Remove the property *name*: its values have expired."""
        if self.has_property(name):
            self.remove_property(name)

    def _show_values(self, name: str, values: Values) -> None:
        self._steps.publication.properties.put(name, values)

    @internal_operation
    def show_elements(self, name: str, elements: object) -> None:
        """Show one property *name* for each tuple of values, and remove the others; see `RangeOfView`.

        An element that was already shown causes no event.
        """
        assert isinstance(elements, list)
        wanted = dict.fromkeys(elements)
        shown = [each.values for each in self.find_properties(name)]
        for old in shown:
            if old not in wanted:
                self.remove_property(name, *old)
        for new in wanted:
            if new not in shown:
                self.define_property(name, *new)

    async def newest(self, reading: Reading, missing: str) -> Values:
        """Return the newest values of a sensor to an operation; wait for its first message if necessary.

        A step boundary only if it waits.

        Raises:
            OperationFailed: no message arrived within `FIRST_MESSAGE` seconds; *missing* names the reason, such as
                ``no_odometry(5)``.
        """
        if reading.newest is None:
            try:
                await self.step(reading.first(FIRST_MESSAGE))
            except TimeoutError:
                self.fail(f"no message arrived within {FIRST_MESSAGE:g} s", missing, FIRST_MESSAGE)
        assert reading.newest is not None
        return reading.newest

    async def refresh(self, name: str, reading: Reading, missing: str) -> None:
        """Update the property *name* to the `newest` values, even if they are equal."""
        await self.newest(reading, missing)
        self._show_values(name, reading.passed())


MOVED = 0.01
"""Metres that a robot must move before the elements in view are computed again."""

Place = Callable[[Values], tuple[float, float]]
"""Return the position of an element: x and y in metres, in the frame of the robot's position."""


def first_two(element: Values) -> tuple[float, float]:
    """Return the position of an element whose first two values are x and y."""
    x, y = element[:2]
    assert isinstance(x, int | float)
    assert isinstance(y, int | float)
    return float(x), float(y)


class RangeOfView:
    """The elements of the newest message within a range of the robot.

    Until the robot's position is known, nothing is in view.

    Args:
        reach: metres, inclusive.
        show: called with the elements in view, in the order of the message, whenever they change.
        place: returns the position of an element.
    """

    def __init__(
        self, reach: float, show: Callable[[list[Values], Cause | None], None], place: Place = first_two
    ) -> None:
        self._reach, self._show, self._place = reach, show, place
        self._elements: list[tuple[float, float, Values]] = []
        self._here: tuple[float, float] | None = None
        self._shown: list[Values] = []

    def take(self, elements: Iterable[Values], cause: Cause | None = None) -> None:
        """Take the elements of a message; an element whose position is not finite is never in view."""
        self._elements = [(*self._place(each), each) for each in elements]
        self._look(cause)

    def stand(self, x: float, y: float, cause: Cause | None = None) -> None:
        """Update the position of the robot."""
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
