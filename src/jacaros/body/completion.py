"""How actions end, as the mind is told."""

from collections.abc import Iterable

from jacaros.bdi.state.act import Completion
from jacaros.body.undelivered import Undelivered
from jacaros.body.values import Outputs, References, to_term
from jacaros.env.errors import OperationFailed
from jacaros.env.operation import OperationOutcome
from jacaros.env.values import Atom, Structure
from jacaros.terms.values import String, Term, functor

SUCCEEDED = Completion(True)

_ERROR_MSG = functor("error_msg", 1)
_ENV_FAILURE_REASON = functor("env_failure_reason", 1)
_ENV_FAILURE_DETAIL = functor("env_failure_detail", 1)


def succeeded(*outputs: tuple[Term, Term]) -> Completion:
    """An action that succeeded and gives these values to these variables."""
    return Completion(True, outputs) if outputs else SUCCEEDED


def failed(message: str, reason: Structure | Atom | None, references: References) -> Completion:
    """An action that failed: ``error_msg`` for people, and ``env_failure_reason`` if there is a reason."""
    annotations: tuple[Term, ...] = ((_ERROR_MSG, String(message)),)
    if reason is not None:
        annotations += ((_ENV_FAILURE_REASON, to_term(reason, references)),)
    return Completion(False, (), annotations)


def refused(failure: OperationFailed, references: References) -> Completion:
    """An action that failed before or outside of an operation."""
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
    """The end of an operation, with the values that it left in its output parameters."""
    if not outcome.ok:
        return failed(outcome.message or "", outcome.reason, references)
    if not outputs:
        return SUCCEEDED
    return Completion(True, tuple(_values(outputs, references)))


def _values(outputs: Outputs, references: References) -> Iterable[tuple[Term, Term]]:
    for variable, out in outputs:
        if out.is_set and out.value is not None:
            yield variable, to_term(out.value, references)
