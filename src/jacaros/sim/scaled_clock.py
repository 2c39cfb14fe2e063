"""A clock that runs faster or slower than the time of day."""

import asyncio
import time
from collections.abc import Callable

from jacaros.clock import Timer


class ScaledClock:
    """Real time, *speed* times as fast; it begins at the time of day.

    Args:
        speed: seconds of this clock in a second of real time.
    """

    virtual = False

    def __init__(self, speed: float) -> None:
        self.speed = speed
        self._epoch, self._began = time.time(), time.monotonic()

    @property
    def elapsed(self) -> float:
        """Seconds of this clock since it was made."""
        return (time.monotonic() - self._began) * self.speed

    def now(self) -> float:
        """Seconds since the Unix epoch, as far as this clock has come."""
        return self._epoch + self.elapsed

    def call_later(self, delay: float, callback: Callable[[], None]) -> Timer:
        """Call *callback* on the running loop after *delay* seconds of this clock."""
        return asyncio.get_running_loop().call_later(delay / self.speed, callback)

    async def sleep(self, delay: float) -> None:
        """Wait for *delay* seconds of this clock."""
        await asyncio.sleep(max(0.0, delay) / self.speed)

    def busy(self, cycles: int) -> None:
        """Nothing: real time moves by itself."""
