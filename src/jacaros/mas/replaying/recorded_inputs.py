"""The inputs of an agent in a recorded run: percepts, signals, messages and beliefs from outside."""

from collections.abc import Iterable, Iterator
from dataclasses import dataclass

from jacaros.agents.language import nodes
from jacaros.agents.language.diagnostics import AslError, SourceFile
from jacaros.agents.language.loader import parse_literal, read_program
from jacaros.mas.history.patterns import name_of
from jacaros.mas.history.records import Data, Record


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
    """Return the initial beliefs and goals of a program, each by name and arity."""
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
