"""An external action as the body reads it: its name, arguments and direction.

Actions that reach no artifact fail as in CArtAgO's bridge to Jason (`Undelivered`).
"""

from collections.abc import Callable, Iterable
from dataclasses import dataclass

from jacaros.agents.body.values import Outputs, References, symbol_name, to_term, unquoted
from jacaros.agents.mind.state.act import Act, Completion
from jacaros.agents.terms.text import text
from jacaros.agents.terms.values import (
    Annotated,
    Functor,
    Reference,
    String,
    Term,
    Var,
    atom,
    bare,
    deref,
    functor,
)
from jacaros.artifacts.env.errors import ArtifactId, OperationFailed
from jacaros.artifacts.env.operation import OperationOutcome
from jacaros.artifacts.env.ports import ENDED, UnderWay, Workspace
from jacaros.artifacts.env.values import Atom, Structure
from jacaros.artifacts.presence.presence import ANYWHERE, Direction, UnknownOperation
from jacaros.files.texts import aside
from jacaros.runtime.clock import Clock

_ARTIFACT = ("artifact", ArtifactId, "an artifact (from makeArtifact or lookupArtifact)")
_WORKSPACE = ("workspace", Workspace, "a workspace (from joinWorkspace)")
_TARGETS: dict[str, tuple[str, type, str]] = {
    **dict.fromkeys(("artifact_id", "aid", "artifact_name", "art"), _ARTIFACT),
    **dict.fromkeys(("wid", "wsp"), _WORKSPACE),
}
"""Annotations that direct an action: the part of `Direction` that they give, its class, and words for it."""
_TIMEOUT = "timeout"
_DIRECTIONS = (*_TARGETS, _TIMEOUT)


@dataclass(slots=True)
class Call:
    """One external action.

    Attributes:
        act: the request of the mind.
        name: name of the action, without quotes.
        namespace: namespace of the name, None without.
        arguments: dereferenced terms.
        direction: content of the annotations.
    """

    act: Act
    name: str
    namespace: str | None
    arguments: tuple[Term, ...]
    direction: Direction

    @property
    def key(self) -> str:
        """Name and number of arguments, such as ``inc/1``."""
        return f"{self.name}/{len(self.arguments)}"


def read(act: Act) -> Call:
    """Read an act.

    Raises:
        Undelivered: an annotation is invalid.
    """
    symbol, arguments = act.functor, act.arguments
    name = unquoted(symbol.name) if symbol.name[0] == "'" else symbol.name
    for argument in arguments:
        if argument.__class__ is Var:
            arguments = tuple(map(deref, arguments))
            break
    return Call(act, name, symbol.namespace, arguments, _direction(act) if act.annotations else ANYWHERE)


def _direction(act: Act) -> Direction:
    direction = Direction()
    # An id takes precedence over a name, in whatever order they are written.
    for annotation in sorted(act.annotations, key=lambda a: _name(a) in ("artifact_id", "aid", "wid")):
        name = _name(annotation)
        if annotation.__class__ is not tuple or name == "source":
            continue
        if len(annotation) == 2 and name == _TIMEOUT:
            direction.timeout = _seconds(act, annotation)
            continue
        if len(annotation) != 2 or name not in _TARGETS:
            message = f"unknown annotation `{text(annotation)}` of action `{act.functor}`"
            help = aside(name, _DIRECTIONS) or f"; the annotations of actions are {', '.join(_DIRECTIONS)}"
            raise unknown_annotation(act, annotation, message + help)
        setattr(direction, _TARGETS[name][0], _target(act, annotation[1], name))
    return direction


def _seconds(act: Act, annotation: Term) -> float:
    """Return the time in ``timeout(Milliseconds)``."""
    milliseconds = deref(annotation[1])
    if milliseconds.__class__ is not float or not 0 <= milliseconds < float("inf"):
        wanted = f"timeout: expected a number of milliseconds, found {text(milliseconds)}"
        raise unknown_annotation(act, annotation, f"{act.functor!r}: {wanted}")
    return float(milliseconds) / 1000


def _name(annotation: Term) -> str:
    return annotation[0].name if annotation.__class__ is tuple else ""


def _target(act: Act, term: Term, annotation: str) -> object:
    """Return the artifact or workspace in an annotation, or its name.

    Raises:
        Undelivered: it is neither.
    """
    _, kind, what = _TARGETS[annotation]
    term = bare(term)
    if term.__class__ is Reference and isinstance(term.value, kind):
        return term.value
    name = name_of(term)
    if name is None:
        message = f"{annotation}: expected {what} or its name, found {text(term)}"
        reason = Structure("wrong_op_arguments", (annotation,))
        raise undelivered(act, OperationFailed(message, reason))
    return name


def name_of(term: Term) -> str | None:
    """Return the text of a string or atom, without quotes; None for other terms."""
    if term.__class__ is String:
        return str(term)
    return symbol_name(term) if term.__class__ is Functor else None


_ENV_FAILURE = functor("env_failure", 1)
_ACTION_FAILED = functor("action_failed", 2)
_OP = functor("op", 2)
_GENERIC_ERROR, _UNKNOWN_ANNOTATION = atom("generic_error"), atom("unknown_annotation")


class Undelivered(OperationFailed):
    """Raised for an action that reaches no artifact.

    Attributes:
        term: the content of ``env_failure_reason``.
        reason: the content of ``env_failure_detail``.
    """

    def __init__(self, message: str, term: Term, reason: Structure | Atom | None) -> None:
        super().__init__(message, reason)
        self.term = term


def undelivered(act: Act, failure: OperationFailed) -> Undelivered:
    """Return the failure of an action that no artifact offers, or that is directed to where the agent cannot act."""
    symbol = act.functor
    why: Term = _GENERIC_ERROR
    if isinstance(failure, UnknownOperation):
        words = " ".join(("(", unquoted(symbol.name), *map(_words, act.arguments), ")"))
        why = (_OP, atom(symbol.namespace or "default"), String(words))
    term = (_ENV_FAILURE, (_ACTION_FAILED, atom(symbol.name), why))
    return Undelivered(failure.message, term, failure.reason)


def _words(term: Term) -> str:
    term = deref(term)
    return str(term) if term.__class__ is String else text(term)


def unknown_annotation(act: Act, annotation: Term, message: str) -> Undelivered:
    """Return the failure of an action with an unknown annotation."""
    symbol = act.functor
    action = Annotated((symbol, *act.arguments) if act.arguments else symbol, act.annotations)
    reason = Structure("unknown_annotation", (text(annotation),))
    return Undelivered(message, (_ACTION_FAILED, action, _UNKNOWN_ANNOTATION), reason)


# Outcomes of actions, as reported to the mind.
#
# One of them is the time-out of an action: ``focusWhenAvailable(door)[timeout(500)]``.


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
