"""The time that an agent gives an action of its body: ``focusWhenAvailable(door)[timeout(500)]``.

Operations of artifacts are given their time in the request (`jacaros.env.operation.OperationRequest`).
"""

from collections.abc import Callable

from jacaros.bdi.state.act import Completion
from jacaros.body.call import Call
from jacaros.body.completion import failed
from jacaros.body.values import References
from jacaros.clock import Clock
from jacaros.env.ports import UnderWay
from jacaros.env.values import Structure

Finish = Callable[[Completion], None]


class Deadline:
    """Gives an action up when its time is over.

    Args:
        call: the action, with its time.
        clock: of the run.
        finish: told how it ended.
        references: for the reason of the failure.
    """

    def __init__(self, call: Call, clock: Clock, finish: Finish, references: References) -> None:
        self._call, self._finish, self._references = call, finish, references
        self._under_way: UnderWay | None = None
        self._timer = clock.call_later(call.direction.timeout or 0.0, self._late)

    def ended(self, completion: Completion) -> None:
        """Be told that the action has ended in time."""
        self._timer.cancel()
        self._finish(completion)

    def watch(self, under_way: UnderWay | None) -> UnderWay:
        """Know what is to be given up; what this gives takes its place."""
        self._under_way = under_way
        return self

    def _late(self) -> None:
        if self._under_way is not None:
            self._under_way.cancel()
        milliseconds = round((self._call.direction.timeout or 0.0) * 1000, 3)
        message = f"{self._call.key} did not end within {milliseconds:g} ms"
        reason = Structure("operation_timeout", (self._call.key, milliseconds))
        self._finish(failed(message, reason, self._references))

    def cancel(self) -> None:
        """Give the action up; its end is not told."""
        self._timer.cancel()
        if self._under_way is not None:
            self._under_way.cancel()

    def pause(self) -> None:
        """Let the action rest, if it can; its time goes on."""
        if self._under_way is not None:
            self._under_way.pause()

    def resume(self) -> None:
        """Let it go on."""
        if self._under_way is not None:
            self._under_way.resume()
