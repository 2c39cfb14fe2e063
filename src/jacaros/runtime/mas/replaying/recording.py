"""What a recording says of an agent: its inputs, and how its external actions ended."""

from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from typing import Final

from jacaros.agents.body.body import keys
from jacaros.agents.language import nodes
from jacaros.agents.language.diagnostics import AslError, SourceFile
from jacaros.agents.language.loader import parse_literal, parse_term, read_program
from jacaros.agents.language.lowering import lower_value
from jacaros.agents.mind.state.act import Act, Completion
from jacaros.agents.terms.text import text
from jacaros.agents.terms.values import String, Term, Var, deref, functor
from jacaros.look.records.records import Data, OperationRecord, Record
from jacaros.look.why.chains import shown
from jacaros.look.why.past import Past
from jacaros.look.why.patterns import name_of


@dataclass(frozen=True, slots=True)
class Input:
    """One input of an agent.

    Attributes:
        t: seconds since the run began.
        order: number of its record.
        kind: ``perceive``, ``perceive_no_more``, ``signal``, ``add_belief``, ``remove_belief``, ``post_goal`` or
            ``message``.
        text: the literal, or the content of the message.
        message: the record of the message; empty for others.
        question: the record of the message that it answers; empty unless it is an answer.
    """

    t: float
    order: int
    kind: str
    text: str
    message: Data
    question: Data


def inputs_of(records: Iterable[Record], agent: str) -> list[Input]:
    """Return the inputs of an agent, the oldest first."""
    reader = _Reader(agent)
    return [each for order, record in enumerate(records) for each in reader.read(order, *record)]


class _Reader:
    def __init__(self, agent: str) -> None:
        self._agent = agent
        self._written: set[str] = set()
        self._began: float | None = None
        self._focused: set[str] = set()
        self._messages: dict[object, Data] = {}

    def read(self, order: int, t: float, event: str, data: Data) -> Iterator[Input]:
        if event == "source":
            self._written |= _initial(str(data.get("file", "")), str(data.get("text", "")))
        elif event == "focus" and data.get("agent") == self._agent:
            (self._focused.add if data.get("on") else self._focused.discard)(str(data.get("artifact")))
        elif event == "message":
            yield from self._message(order, t, data)
        elif event == "signal" and data.get("artifact") in self._focused:
            yield Input(t, order, "signal", str(data.get("signal", "")), {}, {})
        elif event == "belief" and data.get("agent") == self._agent:
            yield from self._belief(order, t, data)
        elif event == "deliberation" and data.get("agent") == self._agent:
            yield from self._goal(order, t, data)

    def _message(self, order: int, t: float, data: Data) -> Iterator[Input]:
        if data.get("state") != "sent":
            return
        self._messages[data.get("id")] = data
        if data.get("to") == self._agent != data.get("from"):
            question = self._messages.get(data.get("reply_to"), {})
            yield Input(t, order, "message", str(data.get("content", "")), data, question)

    def _belief(self, order: int, t: float, data: Data) -> Iterator[Input]:
        if self._began is None:
            self._began = t
        belief, added = str(data.get("belief", "")), data.get("op") == "+"
        if data.get("file") or data.get("intention"):
            return  # a step of a plan changed it
        if "source(percept)" in belief:
            yield Input(t, order, "perceive" if added else "perceive_no_more", belief, {}, {})
        elif not data.get("cause") and "source(self)" in belief and not self._is_written(t, belief):
            yield Input(t, order, "add_belief" if added else "remove_belief", belief, {}, {})

    def _goal(self, order: int, t: float, data: Data) -> Iterator[Input]:
        """Return a goal without a cause in the run that is not in the program: from the project file, or from outside."""
        trigger = str(data.get("trigger", ""))
        if trigger.startswith("+!") and not data.get("parent") and not self._is_written(t, trigger[1:]):
            yield Input(t, order, "post_goal", trigger[2:], {}, {})

    def _is_written(self, t: float, told: str) -> bool:
        """Return whether an initial belief or goal comes from the program, not from the project file."""
        return t <= (self._began or t) and _key(told) in self._written


def _initial(file: str, text: str) -> set[str]:
    program, _ = read_program(SourceFile(file, text))
    beliefs = {_literal_key(each) for each in program.beliefs if isinstance(each, nodes.Literal)}
    return beliefs | {f"!{_literal_key(each)}" for each in program.goals}


def _literal_key(literal: nodes.Literal) -> str:
    return f"{literal.functor}/{len(literal.arguments)}"


def _key(told: str) -> str:
    """Return name and arity of a recorded belief or goal, with ``!`` before a goal."""
    sign = "!" if told.startswith("!") else ""
    try:
        return f"{sign}{_literal_key(parse_literal(told.removeprefix('!')))}"
    except AslError:
        return f"{sign}{name_of(told)}"


_ERROR_MSG = functor("error_msg", 1)
_REASON = functor("env_failure_reason", 1)
CANCELLED: Final = "cancelled"
"""The reason of a cancelled operation: its own end is unknown."""


@dataclass(slots=True)
class RecordedAction:
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
    end: OperationRecord | None = None


class RecordedActs:
    """Gives each action of a rerun the end of the same action in the recording, each end once.

    The same action has the same name and arguments; if none is left, the same name and arity. Actions on workspaces and
    artifacts, such as ``makeArtifact`` and ``focus``, are not recorded: they succeed immediately.
    """

    def __init__(self, records: Iterable[Record], agent: str) -> None:
        past = Past.of(records)
        operations = [each for each in past.operations.values() if each.agent == agent]
        self._left = [
            RecordedAction(
                _operation_key(each.text),
                shown(each.text),
                each.began,
                None if each.why == CANCELLED else each.ended,
                each.end,
            )
            for each in operations
        ]
        known = {past.links[each.link].cause.parent for each in operations}
        self._left += [
            RecordedAction(link.what.rpartition(" ")[2], "", t, t)
            for number, (t, link, _) in past.links.items()
            if link.sort == "act" and link.agent == agent and number not in known
        ]
        self._left.sort(key=lambda each: each.began)

    def ends(self) -> list[RecordedAction]:
        """Return the actions whose end is known."""
        return [each for each in self._left if each.end and each.ended is not None]

    def take(self, act: Act, now: float) -> RecordedAction | None:
        """Return the recorded action for an action that begins *now*, or None if none is left."""
        key = f"{act.functor.name}/{act.functor.arity}"
        written = shown(text((act.functor, *act.arguments) if act.arguments else act.functor))
        same = [each for each in self._left if each.key == key]
        found = next((each for each in same if each.written == written), same[0] if same else None)
        if found is not None:
            self._left.remove(found)
        elif key in keys():
            return RecordedAction(key, written, now, now)
        return found


def completion(recorded: RecordedAction, act: Act) -> Completion:
    """Return how an action ended, for its agent."""
    end = recorded.end
    if end is None or end.state != "failed":
        return Completion(True, tuple(_outputs(recorded, act)))
    message: Term = (_ERROR_MSG, String(end.reason or ""))
    term = _term(end.term)
    return Completion(False, (), (message,) if term is None else (message, (_REASON, term)))


def _outputs(recorded: RecordedAction, act: Act) -> Iterator[tuple[Term, Term]]:
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


def _operation_key(operation: str) -> str:
    try:
        term = lower_value(parse_term(operation))
    except AslError:
        return operation.partition("(")[0]
    return f"{term[0].name}/{term[0].arity}" if term.__class__ is tuple else f"{operation}/0"
