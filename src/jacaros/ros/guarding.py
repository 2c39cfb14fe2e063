"""When a guard stops the robot: a state machine without input, output or clock.

idle      no agents, nothing to stop
watching  heartbeats arrive
tripped   they ceased: the robot is stopped until the agents return and release it
"""

from collections.abc import Callable

LEAVING = 5.0
"""Seconds without a heartbeat that agents may take to end."""


class Watch:
    """Decides from heartbeats whether the robot must be stopped. Times are seconds of one monotonic clock.

    Args:
        timeout: seconds without a heartbeat after which the guard trips.
        on_trip: called with the reason when the guard trips.
        on_release: called when the agents may drive again.

    Attributes:
        agents: whether agents are connected.
        armed: whether they drive anything; otherwise there is nothing to stop.
        driving: whether the robot may be moving when heartbeats cease. Only agents on other computers report this:
            one that loses its network while its robot stands must not disturb other drivers of the robot.
        tripped: why the robot is being stopped; empty if it is not.
    """

    def __init__(
        self, timeout: float, on_trip: Callable[[str], None], on_release: Callable[[], None]
    ) -> None:
        self.agents = self.armed = False
        self.driving = True
        self.tripped = ""
        self._timeout = timeout
        self._on_trip, self._on_release = on_trip, on_release
        self._patience = timeout
        self._heard = 0.0

    def connect(self, now: float, timeout: float | None = None) -> None:
        """Note that agents have connected. A tripped guard stays tripped until they release it.

        Args:
            now: the time.
            timeout: seconds without a heartbeat, instead of those of the watch.
        """
        self.agents = self.driving = True
        self._patience = self._timeout if timeout is None else timeout
        self._heard = now

    def beat(self, now: float) -> None:
        """Note a heartbeat, or any other message of the agents."""
        self._heard = now

    def permit(self) -> None:
        """Release the robot: the agents are back and have interrupted their motions."""
        if self.tripped:
            self.tripped = ""
            self._on_release()

    def expect_end(self) -> None:
        """Note that the agents are shutting down and stop their robot themselves: heartbeats may be late."""
        self._patience = LEAVING

    def leave(self) -> None:
        """Note that the agents have ended normally and stopped their robot themselves."""
        self.agents = False
        self.permit()

    def lose(self) -> None:
        """Note that the connection broke without a goodbye: the agents' process has died."""
        self.agents = False
        self._trip("the agents' process died")

    def look(self, now: float) -> float:
        """Trip if heartbeats ceased. Return the seconds until the next check, at most the time-out."""
        if not self.agents or self.tripped or (self.driving and not self.armed):
            return self._timeout
        silence = now - self._heard
        if silence < self._patience:
            return self._patience - silence
        if self.driving:
            self._trip(f"no heartbeat from the agents for {silence:.2f} s")
        else:
            self.leave()
        return self._timeout

    def _trip(self, why: str) -> None:
        if self.armed and not self.tripped:
            self.tripped = why
            self._on_trip(why)
