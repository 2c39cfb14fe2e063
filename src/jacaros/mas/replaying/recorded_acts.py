"""The external actions of a recorded run: how long each took, and how it ended."""

from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from typing import Final

from jacaros.agents.body.body import keys
from jacaros.agents.language.diagnostics import AslError
from jacaros.agents.language.loader import parse_term
from jacaros.agents.language.lowering import lower_value
from jacaros.agents.mind.state.act import Act, Completion
from jacaros.agents.terms.text import text
from jacaros.agents.terms.values import String, Term, Var, deref, functor
from jacaros.mas.history.chains import shown
from jacaros.mas.history.past import Past
from jacaros.mas.history.records import Operation, Record

_ERROR_MSG = functor("error_msg", 1)
_REASON = functor("env_failure_reason", 1)
CANCELLED: Final = "cancelled"
"""The reason of a cancelled operation: its own end is unknown."""


@dataclass(slots=True)
class RecordedAct:
    """One action of an agent.

    Attributes:
        key: name and arity, such as ``driveTo/2``.
        written: with its arguments; empty if they were not recorded.
        began: seconds since the run began.
        ended: seconds since the run began; None if its end is unknown.
        end: the record of its end; None for an action that succeeded without one.
    """

    key: str
    written: str
    began: float
    ended: float | None
    end: Operation | None = None


class RecordedActs:
    """Gives each action of a rerun the end of the same action in the recording, each end once.

    The same action has the same name and arguments; if none is left, the same name and arity. Actions on workspaces and
    artifacts, such as ``makeArtifact`` and ``focus``, are not recorded: they succeed immediately.
    """

    def __init__(self, records: Iterable[Record], agent: str) -> None:
        past = Past.of(records)
        operations = [each for each in past.operations.values() if each.data.agent == agent]
        self._left = [
            RecordedAct(
                _key(each.data.operation),
                shown(each.data.operation),
                each.began,
                None if each.reason == CANCELLED else each.ended,
                each.last,
            )
            for each in operations
        ]
        known = {each.data.cause for each in operations}
        self._left += [
            RecordedAct(link.what.rpartition(" ")[2], "", t, t)
            for number, (t, link, _) in past.links.items()
            if link.sort == "act" and link.agent == agent and number not in known
        ]
        self._left.sort(key=lambda each: each.began)

    def ends(self) -> list[RecordedAct]:
        """Return the actions whose end is known."""
        return [each for each in self._left if each.end and each.ended is not None]

    def take(self, act: Act, now: float) -> RecordedAct | None:
        """Return the recorded action for an action that begins *now*, or None if none is left."""
        key = f"{act.functor.name}/{act.functor.arity}"
        written = shown(text((act.functor, *act.arguments) if act.arguments else act.functor))
        same = [each for each in self._left if each.key == key]
        found = next((each for each in same if each.written == written), same[0] if same else None)
        if found is not None:
            self._left.remove(found)
        elif key in keys():
            return RecordedAct(key, written, now, now)
        return found


def completion(recorded: RecordedAct, act: Act) -> Completion:
    """Return how an action ended, for its agent."""
    end = recorded.end
    if end is None or end.state != "failed":
        return Completion(True, tuple(_outputs(recorded, act)))
    message: Term = (_ERROR_MSG, String(end.reason or ""))
    term = _term(end.term)
    return Completion(False, (), (message,) if term is None else (message, (_REASON, term)))


def _outputs(recorded: RecordedAct, act: Act) -> Iterator[tuple[Term, Term]]:
    """Return the output variables of an action with the recorded values."""
    variables = [each for each in act.arguments if deref(each).__class__ is Var]
    outputs = (recorded.end.outputs if recorded.end is not None else None) or ()
    for variable, written in zip(variables, outputs, strict=False):
        value = _term(written)
        if value is not None:
            yield variable, value


def _term(written: str | None) -> Term | None:
    """Parse a recorded text. Return None without one, or if it is truncated."""
    if written is None:
        return None
    try:
        return lower_value(parse_term(written))
    except AslError:
        return None


def _key(operation: str) -> str:
    try:
        term = lower_value(parse_term(operation))
    except AslError:
        return operation.partition("(")[0]
    return f"{term[0].name}/{term[0].arity}" if term.__class__ is tuple else f"{operation}/0"
