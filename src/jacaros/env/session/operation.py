"""An operation that a session has requested, from begin to end."""

import asyncio
from collections.abc import Callable, Generator, Sequence
from typing import Any

from jacaros.env.operation import OperationOutcome
from jacaros.env.ports import ENDED, UnderWay
from jacaros.env.values import Atom, Out


class SessionOperation:
    """The handle of an operation. It can be awaited, also by several tasks.

    It ends once: it succeeds, fails, exceeds its time limit or is cancelled. As with asyncio's tasks, cancelling a task
    that awaits the operation cancels the operation.

    Args:
        operation: name of the operation.
        arguments: its arguments.
        complain: called when a callback raises.

    Attributes:
        operation: name of the operation.
        outcome: its outcome. None while it runs.
    """

    def __init__(
        self, operation: str, arguments: Sequence[object], complain: Callable[[str, Exception], None]
    ) -> None:
        self.operation = operation
        self._complain = complain
        self.outcome: OperationOutcome | None = None
        self._outs = tuple(each for each in arguments if isinstance(each, Out))
        self._execution: UnderWay = ENDED
        self._on_end: list[Callable[[SessionOperation], object]] = []
        self._waiting: list[asyncio.Future[None]] = []

    @property
    def done(self) -> bool:
        """Whether it has ended."""
        return self.outcome is not None

    @property
    def result(self) -> Any:
        """Return the values of the `Out` arguments: None without any, the value of a single one, a tuple of several.

        An output that the operation has not set is None.

        Raises:
            OperationFailed: it failed, exceeded its time limit, or was cancelled.
            asyncio.InvalidStateError: it has not ended.
        """
        if self.outcome is None:
            raise asyncio.InvalidStateError(f"operation {self.operation} has not ended")
        if not self.outcome.ok:
            raise self.outcome.failure
        values = tuple(out.value if out.is_set else None for out in self._outs)
        return values if len(values) > 1 else values[0] if values else None

    def cancel(self) -> None:
        """End it with the reason ``cancelled``: its ``finally`` blocks run, a motion ends. No effect after its end."""
        if not self.done:
            self._execution.cancel()
            self.end(OperationOutcome(False, f"operation {self.operation} was cancelled", Atom("cancelled")))

    def pause(self) -> None:
        """Pause it, if it is pausable."""
        if not self.done:
            self._execution.pause()

    def resume(self) -> None:
        """Let it continue after `pause`."""
        if not self.done:
            self._execution.resume()

    def on_end(self, callback: "Callable[[SessionOperation], object]") -> None:
        """Call *callback* with this handle at the end, immediately if it has ended. The callback should return soon."""
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

    # ---- called by the session

    def began(self, execution: UnderWay) -> None:
        """Set the execution."""
        if not self.done:
            self._execution = execution

    def end(self, outcome: OperationOutcome) -> None:
        """Set the outcome. Later outcomes are ignored."""
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
            self._complain(f"an on_end callback of operation {self.operation} raised:", error)

    def __repr__(self) -> str:
        state = "under way" if self.outcome is None else "succeeded" if self.outcome.ok else "failed"
        return f"<operation {self.operation}: {state}>"
