"""What a test wants to hear of a mind, and what it may ask of the test."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Protocol

from jacaros.asl.source import Span
from jacaros.terms.values import Term


@dataclass(frozen=True, slots=True)
class Assertion:
    """An assertion that a program made.

    Attributes:
        name: the goal that made it, such as ``assert_equals``.
        passed: whether it held.
        expected, actual: for people; empty where there is nothing to tell.
        span: where the program makes it, None when that is unknown.
    """

    name: str
    passed: bool
    expected: str
    actual: str
    span: Span | None

    def text(self) -> str:
        """The assertion in one line, without its place."""
        if self.passed:
            return f"{self.name} passed"
        told = f"expected {self.expected}" if self.expected else ""
        if self.actual:
            told += f"{', but ' if told else ''}{self.actual}"
        return f"{self.name} failed: {told}"


class OthersInGraph(Protocol):
    """The rest of the ROS graph, as a test plays it; each method raises `ValueError` with what is wrong."""

    def publish(self, topic: str, fields: str, type_name: str) -> None:
        """Publish a message; *type_name* is empty when it is to be that of those who listen."""

    def hear(self, topic: str, type_name: str) -> None:
        """Listen to a topic."""

    def answer(self, service: str, type_name: str, fields: str) -> None:
        """Offer a service that gives this response."""

    def count_published(self, topic: str, fields: str) -> tuple[int, list[str]]:
        """How many messages of the run on a topic had these values, and all of them for people."""

    def count_asked(self, service: str, fields: str) -> tuple[int, list[str]]:
        """How many requests to such a service had these values, and all of them for people."""


class Probe(Protocol):
    """A test that looks on at one agent."""

    def asserted(self, assertion: Assertion) -> None:
        """The program made an assertion."""

    def lost(self, text: str, details: Sequence[str], span: Span | None) -> None:
        """An intention that nobody watches ended in failure; *text* and *details* tell it to people, *span* is the
        place."""

    def fake(self, action: Term, outcome: Term) -> None:
        """From now on the test answers external actions that match *action*.

        Raises:
            ValueError: *outcome* is none.
        """

    def acts(self) -> Sequence[Term]:
        """The external actions (and faked ``.stopMAS``) that the agent has begun, oldest first."""

    def prints(self) -> Sequence[str]:
        """What the agent has printed, oldest first."""

    def others(self) -> OthersInGraph:
        """The rest of the ROS graph."""
