"""An operation that a session has asked for, from its beginning to its end."""

import asyncio
from collections.abc import Callable, Generator, Sequence
from typing import Any

from jacaros.env.errors import OperationFailed
from jacaros.env.operation import OperationOutcome
from jacaros.env.ports import UnderWay
from jacaros.env.values import Atom, Out


class SessionOperation:
    """The handle of an operation; it can be awaited, by several tasks too.

    It ends once: the operation succeeded or failed, its time was over, or it was cancelled.  A task that is
    cancelled while it awaits the operation cancels the operation, as with the tasks of asyncio.

    Args:
        operation: name of the operation.
        arguments: what it is given.
        complain: told of callbacks that raise.

    Attributes:
        operation: name of the operation.
        outcome: what came of it, None while it is under way.
    """

    def __init__(
        self, operation: str, arguments: Sequence[object], complain: Callable[[str, Exception], None]
    ) -> None:
        self.operation = operation
        self._complain = complain
        self.outcome: OperationOutcome | None = None
        self._outs = tuple(each for each in arguments if isinstance(each, Out))
        self._execution: UnderWay | None = None
        self._on_end: list[Callable[[SessionOperation], object]] = []
        self._waiting: list[asyncio.Future[None]] = []

    @property
    def done(self) -> bool:
        """True when it has ended."""
        return self.outcome is not None

    @property
    def result(self) -> Any:
        """The values of the `Out` arguments: None without any, the value of the one, a tuple of several.

        None stands for a value that the operation has not set.

        Raises:
            OperationFailed: it failed, its time was over, or it was cancelled.
            asyncio.InvalidStateError: it is under way.
        """
        if self.outcome is None:
            raise asyncio.InvalidStateError(f"operation {self.operation} has not ended")
        if not self.outcome.ok:
            raise OperationFailed(self.outcome.message or "", self.outcome.reason)
        values = tuple(out.value if out.is_set else None for out in self._outs)
        return values if len(values) > 1 else values[0] if values else None

    def cancel(self) -> None:
        """End it, with the reason ``cancelled``: its ``finally`` runs, a motion ends; nothing if it has ended."""
        if not self.done:
            if self._execution is not None:
                self._execution.cancel()
            self.end(OperationOutcome(False, f"operation {self.operation} was cancelled", Atom("cancelled")))

    def pause(self) -> None:
        """Ask it to rest, which it does if it is pausable."""
        if self._execution is not None and not self.done:
            self._execution.pause()

    def resume(self) -> None:
        """Let it go on after `pause`."""
        if self._execution is not None and not self.done:
            self._execution.resume()

    def on_end(self, callback: "Callable[[SessionOperation], object]") -> None:
        """Call *callback* with this handle at the end, at once if that is past; it should return soon."""
        if self.done:
            self._call(callback)
        else:
            self._on_end.append(callback)

    def __await__(self) -> Generator[Any, None, Any]:
        if not self.done:
            ended = asyncio.get_running_loop().create_future()
            self._waiting.append(ended)
            try:
                yield from ended
            except asyncio.CancelledError:
                self.cancel()
                raise
        return self.result

    # ---- for the session

    def began(self, execution: UnderWay) -> None:
        """Be told what carries it out."""
        if not self.done:
            self._execution = execution

    def end(self, outcome: OperationOutcome) -> None:
        """Be told what came of it; what comes later is not heard any more."""
        if self.done:
            return
        self.outcome = outcome
        waiting, self._waiting = self._waiting, []
        for ended in waiting:
            if not ended.done():
                ended.set_result(None)
        callbacks, self._on_end = self._on_end, []
        for callback in callbacks:
            self._call(callback)

    def _call(self, callback: "Callable[[SessionOperation], object]") -> None:
        try:
            callback(self)
        except Exception as error:
            self._complain(f"a callback at the end of operation {self.operation} failed:", error)

    def __repr__(self) -> str:
        state = "under way" if self.outcome is None else "succeeded" if self.outcome.ok else "failed"
        return f"<operation {self.operation}: {state}>"
