"""An external action as the body reads it: its name, arguments and direction.

Actions that reach no artifact fail as in CArtAgO's bridge to Jason (`Undelivered`).
"""

from dataclasses import dataclass

from jacaros.bdi.state.act import Act
from jacaros.body.values import symbol_name, unquoted
from jacaros.env.errors import OperationFailed
from jacaros.env.ids import ArtifactId
from jacaros.env.ports import Workspace
from jacaros.env.presence.presence import ANYWHERE, Direction, UnknownOperation
from jacaros.env.values import Atom, Structure
from jacaros.suggestions import aside
from jacaros.terms.text import text
from jacaros.terms.values import Annotated, Functor, Reference, String, Term, Var, atom, bare, deref, functor

_BY_ARTIFACT = {"artifact_id": "artifact", "aid": "artifact", "artifact_name": "artifact", "art": "artifact"}
_BY_WORKSPACE = {"wid": "workspace", "wsp": "workspace"}
_TIMEOUT = "timeout"
_DIRECTIONS = (*_BY_ARTIFACT, *_BY_WORKSPACE, _TIMEOUT)
_DIRECTING = ", ".join(_DIRECTIONS)


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
        if len(annotation) != 2 or (name not in _BY_ARTIFACT and name not in _BY_WORKSPACE):
            message = f"unknown annotation `{text(annotation)}` of action `{act.functor}`"
            help = aside(name, _DIRECTIONS)
            raise unknown_annotation(
                act, annotation, f"{message}{help or f'; the annotations of actions are {_DIRECTING}'}"
            )
        try:
            if name in _BY_ARTIFACT:
                direction.artifact = artifact_argument(annotation[1], name)
            else:
                direction.workspace = workspace_argument(annotation[1], name)
        except OperationFailed as failure:
            raise undelivered(act, failure) from None
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


def artifact_argument(term: Term, where: str) -> ArtifactId | str:
    """Return the artifact, or its name, in a term.

    Raises:
        OperationFailed: it is neither.
    """
    term = bare(term)
    if term.__class__ is Reference and isinstance(term.value, ArtifactId):
        return term.value
    name = name_of(term)
    if name is None:
        raise _not_a("n artifact (from makeArtifact or lookupArtifact)", term, where)
    return name


def workspace_argument(term: Term, where: str) -> Workspace | str:
    """Return the workspace, or its name or path, in a term.

    Raises:
        OperationFailed: it is neither.
    """
    term = bare(term)
    if term.__class__ is Reference and isinstance(term.value, Workspace):
        return term.value
    name = name_of(term)
    if name is None:
        raise _not_a(" workspace (from joinWorkspace)", term, where)
    return name


def name_of(term: Term) -> str | None:
    """Return the text of a string or atom, without quotes; None for other terms."""
    if term.__class__ is String:
        return str(term)
    return symbol_name(term) if term.__class__ is Functor else None


def _not_a(what: str, term: Term, where: str) -> OperationFailed:
    return OperationFailed(
        f"{where}: expected a{what} or its name, found {text(term)}",
        Structure("wrong_op_arguments", (where,)),
    )


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
