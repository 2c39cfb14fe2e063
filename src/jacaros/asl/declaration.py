"""What parser, checker, compiler and mind know of an internal action, apart from its code."""

from dataclasses import dataclass


@dataclass(frozen=True, slots=True, kw_only=True)
class Declaration:
    """What is declared of an internal action for readers of programs.

    Attributes:
        arity: number of arguments, or least and most of them (None: any number).
        suspends: it may suspend the intention, or acts on it: as a condition it is probably a mistake.
        body_only: it acts or waits: it never holds as a condition, and contexts refuse those of the language.
        condition: place of the argument that is a condition, counted from 0.
        performative: place of the performative, for those that send messages; what they say is the last argument.
        awaits: its arguments in braces are events that it waits for.
        prints: it only shows its arguments.
        brings_in: it brings in plans or agents that do not appear in the program.
        changes_plans: it adds plans or removes them.
        result_hint: how its author gives it one argument more, for the result; empty when it has all or is not in Python.
    """

    arity: int | tuple[int, int | None] = (0, None)
    suspends: bool = False
    body_only: bool = False
    condition: int | None = None
    performative: int | None = None
    awaits: bool = False
    prints: bool = False
    brings_in: bool = False
    changes_plans: bool = False
    result_hint: str = ""

    @property
    def minimum(self) -> int:
        """The least number of arguments."""
        return self.arity if isinstance(self.arity, int) else self.arity[0]

    @property
    def maximum(self) -> int | None:
        """The greatest number of arguments; None for any number."""
        return self.arity if isinstance(self.arity, int) else self.arity[1]

    def takes(self, count: int) -> bool:
        """Return whether it may have that number of arguments."""
        if isinstance(self.arity, int):
            return count == self.arity
        least, most = self.arity
        return least <= count and (most is None or count <= most)


UNDECLARED = Declaration()
"""What is known of a name that is not declared."""
