"""Release what an artifact holds, when the last of its operations has ended."""

import asyncio
from collections.abc import Callable
from dataclasses import dataclass, field

from jacaros.env.kernel.faults import is_interruption


@dataclass(slots=True)
class Ending:
    """The callbacks for the end of one artifact, called once.

    Attributes:
        hook: called first, if the artifact was initialised.
        cleanups: called after that, the last one first.
        over: whether all have been called.
    """

    hook: Callable[[], object] | None = None
    cleanups: list[Callable[[], object]] = field(default_factory=list)
    over: bool = False
    _over: "asyncio.Future[None] | None" = None

    def run(self, initialised: bool, complain: Callable[[str, BaseException], None]) -> None:
        """Call all callbacks. *complain* gets the exceptions they raise."""
        if self.over:
            return
        self.over = True
        hooks = (self.hook,) if self.hook is not None and initialised else ()
        for callback in (*hooks, *reversed(self.cleanups)):
            try:
                callback()
            except BaseException as error:
                if is_interruption(error):
                    raise
                complain("error while disposing:", error)
        if self._over is not None and not self._over.done():
            self._over.set_result(None)

    async def over_with(self) -> None:
        """Wait for the end."""
        if not self.over:
            if self._over is None:
                self._over = asyncio.get_running_loop().create_future()
            await asyncio.shield(self._over)  # cancelling one waiting task must not cancel the others
