"""The external actions of a recorded run: how long each took, and how it ended."""

from collections.abc import Iterable
from dataclasses import dataclass
from typing import Final

from jacaros.asl.diagnostics import AslError
from jacaros.asl.loader import parse_term
from jacaros.asl.lowering import lower_value
from jacaros.bdi.state.act import Act, Completion
from jacaros.body.actions import keys
from jacaros.mas.history.chains import shown
from jacaros.mas.history.past import Past, Record
from jacaros.terms.text import text
from jacaros.terms.values import String, Term, functor

_ERROR_MSG = functor("error_msg", 1)
_REASON = functor("env_failure_reason", 1)
CANCELLED: Final = "cancelled"
"""The reason of an operation that was given up: how it would have ended is unknown."""


@dataclass(slots=True)
class RecordedAct:
    """One action that an agent did.

    Attributes:
        key: name and number of arguments, such as ``driveTo/2``.
        written: with its arguments; empty if they were not recorded.
        began: seconds since the run began.
        duration: seconds; None if its end is unknown.
        reason: of a failure; None if it succeeded.
    """

    key: str
    written: str
    began: float
    duration: float | None
    reason: str | None


class RecordedActs:
    """Gives each action of a rerun the end that the same action had in the recording, each end once.

    The same action has the same name and arguments; if none is left, one with the same name and number of arguments.
    Actions on workspaces and artifacts, such as ``makeArtifact`` and ``focus``, are not recorded: they succeed immediately.
    """

    def __init__(self, records: Iterable[Record], agent: str) -> None:
        past = Past.of(records)
        operations = [each for each in past.operations.values() if each.data.get("agent") == agent]
        self._left = [
            RecordedAct(
                _key(str(each.data["operation"])),
                shown(each.data["operation"]),
                each.began,
                None if each.ended is None or each.reason == CANCELLED else each.ended - each.began,
                each.reason if each.outcome == "failed" else None,
            )
            for each in operations
        ]
        known = {each.data.get("cause") for each in operations}
        self._left += [
            RecordedAct(str(link.get("what", "")).rpartition(" ")[2], "", t, 0.0, None)
            for number, (t, link) in past.links.items()
            if link.get("kind") == "act" and link.get("agent") == agent and number not in known
        ]
        self._left.sort(key=lambda each: each.began)

    def take(self, act: Act) -> RecordedAct | None:
        """The recorded action for an action of the rerun; None if there is none left."""
        key = f"{act.functor.name}/{act.functor.arity}"
        written = shown(text((act.functor, *act.arguments) if act.arguments else act.functor))
        same = [each for each in self._left if each.key == key]
        found = next((each for each in same if each.written == written), same[0] if same else None)
        if found is not None:
            self._left.remove(found)
        elif key in keys():
            return RecordedAct(key, written, 0.0, 0.0, None)
        return found


def completion(act: RecordedAct) -> Completion:
    """How an action ended, as its agent learns it."""
    if act.reason is None:
        return Completion(True)
    message: Term = (_ERROR_MSG, String(act.reason))
    try:
        return Completion(False, (), (message, (_REASON, lower_value(parse_term(act.reason)))))
    except AslError:
        return Completion(False, (), (message,))


def _key(operation: str) -> str:
    try:
        term = lower_value(parse_term(operation))
    except AslError:
        return operation.partition("(")[0]
    return f"{term[0].name}/{term[0].arity}" if term.__class__ is tuple else f"{operation}/0"
