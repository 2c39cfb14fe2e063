"""The time of the world on ``/clock``, for nodes that live in simulated time (ROS's ``use_sim_time``)."""

from jacaros.clock import Clock, Timer
from jacaros.ros.backend import Backend
from jacaros.ros.message import stamp

PERIOD = 0.01
"""Seconds of the world between two messages."""


class ClockPublisher:
    """Publishes ``rosgraph_msgs/msg/Clock`` on ``/clock``, a hundred times a second.

    Args:
        clock: the clock that the world follows.
        backend: the graph; it is started already.
    """

    def __init__(self, clock: Clock, backend: Backend) -> None:
        self._clock = clock
        self._publisher = backend.publisher("/clock", "rosgraph_msgs/msg/Clock")
        self._timer: Timer | None = None
        self._last = 0.0
        self._tick()

    def _tick(self) -> None:
        self._timer = self._clock.call_later(PERIOD, self._tick)
        # A clock must not run back, whatever the machine's does.
        self._last = max(self._last, self._clock.now())
        message = self._publisher.message()
        stamp(message.clock, self._last)
        self._publisher.publish(message)

    def close(self) -> None:
        """Leave the topic."""
        if self._timer is not None:
            self._timer.cancel()
        self._publisher.close()
