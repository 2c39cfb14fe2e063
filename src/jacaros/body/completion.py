"""Outcomes of actions, as reported to the mind.

One of them is the time-out of an action: ``focusWhenAvailable(door)[timeout(500)]``.
"""

from collections.abc import Callable, Iterable

from jacaros.bdi.state.act import Completion
from jacaros.body.call import Call, Undelivered
from jacaros.body.values import Outputs, References, to_term
from jacaros.clock import Clock
from jacaros.env.errors import OperationFailed
from jacaros.env.operation import OperationOutcome
from jacaros.env.ports import ENDED, UnderWay
from jacaros.env.values import Atom, Structure
from jacaros.terms.values import String, Term, functor

SUCCEEDED = Completion(True)

_ERROR_MSG = functor("error_msg", 1)
_ENV_FAILURE_REASON = functor("env_failure_reason", 1)
_ENV_FAILURE_DETAIL = functor("env_failure_detail", 1)


def succeeded(*outputs: tuple[Term, Term]) -> Completion:
    """Return the outcome of an action that succeeded, with values for its output variables."""
    return Completion(True, outputs) if outputs else SUCCEEDED


def failed(message: str, reason: Structure | Atom | None, references: References) -> Completion:
    """Return the outcome of a failed action: ``error_msg``, and ``env_failure_reason`` if there is a reason."""
    annotations: tuple[Term, ...] = ((_ERROR_MSG, String(message)),)
    if reason is not None:
        annotations += ((_ENV_FAILURE_REASON, to_term(reason, references)),)
    return Completion(False, (), annotations)


def refused(failure: OperationFailed, references: References) -> Completion:
    """Return the outcome of an action that failed before or outside of an operation."""
    if not isinstance(failure, Undelivered):
        return failed(failure.message, failure.reason, references)
    annotations: tuple[Term, ...] = (
        (_ERROR_MSG, String(failure.message)),
        (_ENV_FAILURE_REASON, failure.term),
    )
    if failure.reason is not None:
        annotations += ((_ENV_FAILURE_DETAIL, to_term(failure.reason, references)),)
    return Completion(False, (), annotations)


def of_operation(outcome: OperationOutcome, outputs: Outputs, references: References) -> Completion:
    """Return the outcome of an operation, with the values of its output parameters."""
    if not outcome.ok:
        return failed(outcome.message or "", outcome.reason, references)
    if not outputs:
        return SUCCEEDED
    return Completion(True, tuple(_values(outputs, references)))


def _values(outputs: Outputs, references: References) -> Iterable[tuple[Term, Term]]:
    for variable, out in outputs:
        if out.is_set and out.value is not None:
            yield variable, to_term(out.value, references)


Finish = Callable[[Completion], None]


class Deadline:
    """Cancels an action when its time is over.

    Args:
        call: the action, with its time limit.
        clock: clock of the run.
        finish: called with the outcome.
        references: for the failure reason.
    """

    def __init__(self, call: Call, clock: Clock, finish: Finish, references: References) -> None:
        self._call, self._finish, self._references = call, finish, references
        self._under_way: UnderWay = ENDED
        self._timer = clock.call_later(call.direction.timeout or 0.0, self._late)

    def ended(self, completion: Completion) -> None:
        """Note that the action has ended in time."""
        self._timer.cancel()
        self._finish(completion)

    def watch(self, under_way: UnderWay) -> UnderWay:
        """Set the handle to cancel; the returned one replaces it."""
        self._under_way = under_way
        return self

    def _late(self) -> None:
        self._under_way.cancel()
        milliseconds = round((self._call.direction.timeout or 0.0) * 1000, 3)
        message = f"{self._call.key} did not end within {milliseconds:g} ms"
        reason = Structure("operation_timeout", (self._call.key, milliseconds))
        self._finish(failed(message, reason, self._references))

    def cancel(self) -> None:
        """Cancel the action without reporting its end."""
        self._timer.cancel()
        self._under_way.cancel()

    def pause(self) -> None:
        """Pause the action, if possible; its time continues."""
        self._under_way.pause()

    def resume(self) -> None:
        """Resume the action."""
        self._under_way.resume()
