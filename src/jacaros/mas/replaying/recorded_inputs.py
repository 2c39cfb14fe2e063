"""What an agent was given in a recorded run: percepts, signals, messages and beliefs from outside."""

from collections.abc import Iterable, Iterator
from dataclasses import dataclass

from jacaros.mas.history.past import Data, Record
from jacaros.mas.history.patterns import name_of


@dataclass(frozen=True, slots=True)
class Input:
    """One thing that an agent was given.

    Attributes:
        t: seconds since the run began.
        kind: ``perceive``, ``perceive_no_more``, ``signal``, ``add_belief``, ``remove_belief`` or ``message``.
        text: the literal, or the content of the message.
        message: the record of the message; empty for others.
        question: the record of the message that it answers; empty unless it is an answer.
    """

    t: float
    kind: str
    text: str
    message: Data
    question: Data


def inputs_of(records: Iterable[Record], agent: str) -> list[Input]:
    """What an agent was given, the oldest first."""
    reader = _Reader(agent)
    return [each for record in records for each in reader.read(*record)]


class _Reader:
    def __init__(self, agent: str) -> None:
        self._agent = agent
        self._sources: list[str] = []
        self._began: float | None = None
        self._focused: set[str] = set()
        self._messages: dict[object, Data] = {}

    def read(self, t: float, event: str, data: Data) -> Iterator[Input]:
        if event == "source":
            self._sources.append(str(data.get("text", "")))
        elif event == "focus" and data.get("agent") == self._agent:
            (self._focused.add if data.get("on") else self._focused.discard)(str(data.get("artifact")))
        elif event == "message":
            yield from self._message(t, data)
        elif event == "signal" and data.get("artifact") in self._focused:
            yield Input(t, "signal", str(data.get("signal", "")), {}, {})
        elif event == "belief" and data.get("agent") == self._agent:
            yield from self._belief(t, data)

    def _message(self, t: float, data: Data) -> Iterator[Input]:
        if data.get("state") != "sent":
            return
        self._messages[data.get("id")] = data
        if data.get("to") == self._agent != data.get("from"):
            question = self._messages.get(data.get("reply_to"), {})
            yield Input(t, "message", str(data.get("content", "")), data, question)

    def _belief(self, t: float, data: Data) -> Iterator[Input]:
        if self._began is None:
            self._began = t
        belief, added = str(data.get("belief", "")), data.get("op") == "+"
        if data.get("file") or data.get("intention"):
            return  # a step of a plan changed it
        if "source(percept)" in belief:
            yield Input(t, "perceive" if added else "perceive_no_more", belief, {}, {})
        elif not data.get("cause") and "source(self)" in belief and not self._is_written(t, belief):
            yield Input(t, "add_belief" if added else "remove_belief", belief, {}, {})

    def _is_written(self, t: float, belief: str) -> bool:
        """Whether an initial belief comes from the program, not from the project file."""
        return t == self._began and any(name_of(belief) in source for source in self._sources)
