"""What all artifacts of an environment share: clock, log, and the handling of internal errors."""

import asyncio
import sys
import threading
import traceback
from collections.abc import Callable, Mapping
from contextlib import suppress
from dataclasses import dataclass, field

from jacaros.clock import Clock
from jacaros.env.listener import EnvironmentListener
from jacaros.env.resources.arbiter import Arbiter
from jacaros.errors import InternalError
from jacaros.trace import Cause, Tracer


def log_to_stderr(text: str) -> None:
    """Write *text* as a line to standard error."""
    print(text, file=sys.stderr)


@dataclass(slots=True, eq=False, repr=False)
class Setting:
    """What the artifacts of one environment share.

    Attributes:
        clock: clock of the run.
        resources: services of the host for artifacts, such as ``ros`` and ``console``, by name.
        log: takes a line of the log, such as ``[lamp] on``.
        tracer: receives every cause. None if no tracer is set.
        listener: receives what happens in the artifacts. None if no listener is set.
        told: advice to authors that has been logged once.
        arbiter: assigns resources to operations and plans.
        loop: event loop of the operations. None before the first one.
        on_internal_error: called with defects of JaCaROS itself. None lets them propagate.
    """

    clock: Clock
    resources: Mapping[str, object] = field(default_factory=dict)
    log: Callable[[str], None] = log_to_stderr
    tracer: Tracer | None = None
    on_internal_error: Callable[[BaseException], None] | None = None
    listener: EnvironmentListener | None = None
    told: set[object] = field(default_factory=set, init=False)
    arbiter: Arbiter = field(init=False)
    loop: asyncio.AbstractEventLoop | None = field(default=None, init=False)
    _loop_thread: int = field(default=0, init=False)

    def __post_init__(self) -> None:
        self.arbiter = Arbiter(self.clock, lambda text: self.log(f"warning: {text}"))

    def know_loop(self) -> None:
        """Remember the running event loop as that of the operations."""
        if self.loop is None:
            with suppress(RuntimeError):
                self.loop = asyncio.get_running_loop()
                self._loop_thread = threading.get_ident()

    def elsewhere(self) -> bool:
        """Return whether the caller is in another thread than that of the event loop."""
        return self.loop is not None and self._loop_thread != threading.get_ident()

    def call_on_loop(self, callback: Callable[[], object]) -> bool:
        """Call *callback* on the event loop, from another thread. Return False if the loop has ended."""
        if self.loop is not None:
            with suppress(RuntimeError):
                self.loop.call_soon_threadsafe(callback)
                return True
        return False

    def log_error(self, who: str, what: str, error: BaseException) -> None:
        """Log that *what* failed in *who*, with the traceback of *error* below the kernel."""
        self.log(f"[{who}] {what}")
        frames = error.__traceback__.tb_next if error.__traceback__ is not None else None
        for line in "".join(traceback.format_exception(type(error), error, frames)).splitlines():
            self.log(f"[{who}]   {line}")

    def report(self, error: BaseException) -> None:
        """Report a defect of JaCaROS itself.

        Raises:
            InternalError: `on_internal_error` is not set.
        """
        if self.on_internal_error is not None:
            self.on_internal_error(error)
        elif isinstance(error, InternalError):
            raise error
        else:
            raise InternalError(f"{type(error).__name__}: {error}") from error

    def trace(self, kind: str, what: str, parent: Cause | None, about: object = None) -> Cause | None:
        """Return the next cause after *parent*; *parent* itself if no tracer is set."""
        return parent if self.tracer is None else self.tracer.link(kind, what, parent, about)
