"""What every artifact of an environment is given: time, the log, and who is told of defects."""

import asyncio
import sys
import threading
import traceback
from collections.abc import Callable, Mapping
from contextlib import suppress
from dataclasses import dataclass, field
from typing import Any

from jacaros.clock import Clock
from jacaros.env.resources.arbiter import Arbiter
from jacaros.errors import InternalError
from jacaros.trace import Cause, Tracer


def log_to_stderr(text: str) -> None:
    """Write *text* as a line on the standard error output."""
    print(text, file=sys.stderr)


@dataclass(slots=True)
class Setting:
    """The surroundings of the artifacts of one environment.

    Attributes:
        clock: where they take time from.
        resources: what the host lends to artifacts, such as ``ros`` and ``console``, by name.
        log: takes a line for people, such as ``[lamp] on``.
        tracer: told of every cause, None while nobody watches.
        listener: a `jacaros.env.listener.EnvironmentListener`, None while nobody watches.
        told: what authors have been told once.
        arbiter: decides who has what operations and plans use.
        loop: where the operations run, None before the first one.
        on_internal_error: told of defects of JaCaROS itself; None lets them escape.
    """

    clock: Clock
    resources: Mapping[str, object] = field(default_factory=dict)
    log: Callable[[str], None] = log_to_stderr
    tracer: Tracer | None = None
    on_internal_error: Callable[[BaseException], None] | None = None
    listener: Any = None
    told: set[object] = field(default_factory=set, init=False)
    arbiter: Arbiter = field(init=False)
    loop: asyncio.AbstractEventLoop | None = field(default=None, init=False)
    _loop_thread: int = field(default=0, init=False)

    def __post_init__(self) -> None:
        self.arbiter = Arbiter(self.clock, lambda text: self.log(f"warning: {text}"))

    def know_loop(self) -> None:
        """Learn from the caller which loop runs the operations."""
        if self.loop is None:
            with suppress(RuntimeError):
                self.loop = asyncio.get_running_loop()
                self._loop_thread = threading.get_ident()

    def elsewhere(self) -> bool:
        """True when called from another thread than the loop's."""
        return self.loop is not None and self._loop_thread != threading.get_ident()

    def hand_over(self, callback: Callable[[], object]) -> bool:
        """Call *callback* on the loop, from another thread; False when the loop has ended."""
        if self.loop is not None:
            with suppress(RuntimeError):
                self.loop.call_soon_threadsafe(callback)
                return True
        return False

    def log_error(self, who: str, what: str, error: BaseException) -> None:
        """Log that *what* went wrong in *who*, with the trace of *error* below the kernel."""
        self.log(f"[{who}] {what}")
        frames = error.__traceback__.tb_next if error.__traceback__ is not None else None
        for line in "".join(traceback.format_exception(type(error), error, frames)).splitlines():
            self.log(f"[{who}]   {line}")

    def report(self, error: BaseException) -> None:
        """Tell of a defect of JaCaROS itself.

        Raises:
            InternalError: nobody is there to be told.
        """
        if self.on_internal_error is not None:
            self.on_internal_error(error)
        elif isinstance(error, InternalError):
            raise error
        else:
            raise InternalError(f"{type(error).__name__}: {error}") from error

    def trace(self, kind: str, what: str, parent: Cause | None, about: object = None) -> Cause | None:
        """The next link after *parent*; *parent* itself while nobody watches."""
        return parent if self.tracer is None else self.tracer.link(kind, what, parent, about)
