"""The answer to a question about a run, as plain data and as text."""

from collections.abc import Iterable, Iterator
from dataclasses import asdict, dataclass
from typing import Any


@dataclass(frozen=True, slots=True)
class Fact:
    """One line of an answer.

    Attributes:
        kind: ``command``, ``operation``, ``act``, ``event``, ``property``, ``signal``, ``sample``,
            ``message``, ``plan``, ``goal``, ``intention``, ``belief``, ``note``, or ``remote`` for a step of an agent of
            another system.
        text: the text.
        t: seconds since the run began, or None.
        agent: agent it concerns; empty for facts of the environment.
        file, line: location in a program; ``""`` and 0 if unknown.
    """

    kind: str
    text: str
    t: float | None = None
    agent: str = ""
    file: str = ""
    line: int = 0

    @property
    def place(self) -> str:
        """File and line, such as ``robot.asl:14``; empty if unknown."""
        return f"{self.file}:{self.line}" if self.file and self.line else self.file

    def written(self) -> str:
        """Return the text with agent and location."""
        agent = f"{self.agent}: " if self.agent else ""
        return f"{agent}{self.text}{f' ({self.place})' if self.place else ''}"


@dataclass(frozen=True, slots=True)
class Explanation:
    """The answer to one question.

    Attributes:
        question: as it was asked.
        answer: the answer in one line.
        t: seconds since the run began; None if it never happened.
        facts: the evidence, such as each candidate plan with the conjunct that failed.
        because: the causal chain, from the effect back to its beginning.
    """

    question: str
    answer: str
    t: float | None = None
    facts: tuple[Fact, ...] = ()
    because: tuple[Fact, ...] = ()

    def text(self) -> str:
        """Return the answer as lines: its facts, then the causal chain with times."""
        facts = (f"  {each.written()}" for each in self.facts)
        return "\n".join((self.answer, *facts, *_chain(self.because)))

    def data(self) -> dict[str, Any]:
        """Return the answer as JSON data."""
        return asdict(self)


def _chain(facts: Iterable[Fact]) -> list[str]:
    lines = [(each.kind, "" if each.t is None else seconds(each.t), each.written()) for each in facts]
    if not lines:
        return []
    kinds, times = (max(len(line[column]) for line in lines) for column in (0, 1))
    return ["because:", *(f"  {kind:{kinds}}  {time:>{times}}  {text}" for kind, time, text in lines)]


def earlier(times_of: Iterable[float]) -> Iterator[Fact]:
    """Return how often something happened before its last time, from all times, the oldest first."""
    *before, _ = times_of
    if before:
        yield Fact("note", f"it happened {times(len(before))} before, last at {seconds(before[-1])}")


def times(count: int) -> str:
    """Return a number of times as text."""
    return {1: "once", 2: "twice"}.get(count, f"{count} times")


def seconds(t: float) -> str:
    """Return a time as text, such as ``12.300 s``."""
    return f"{t:.3f} s"
