"""Declarations of internal actions, as the parser, checker, compiler and mind see them."""

from dataclasses import dataclass


@dataclass(frozen=True, slots=True, kw_only=True)
class Declaration:
    """What is known of an internal action without its code.

    Attributes:
        arity: number of arguments, or their minimum and maximum (None: any number).
        suspends: it may suspend the intention, or acts on it; as a condition it is probably a mistake.
        body_only: it acts or waits, so it never holds as a condition; contexts reject those of the language.
        condition: index of the argument that is a condition.
        performative: index of the performative, for actions that send messages; the last argument is the content.
        awaits: its arguments in braces are events that it waits for.
        prints: it only prints its arguments.
        brings_in: it adds plans or agents that do not appear in the program.
        changes_plans: it adds or removes plans.
        result_hint: how its author adds an argument for the result; empty for actions that have one or are not in Python.
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
        """The minimum number of arguments."""
        return self.arity if isinstance(self.arity, int) else self.arity[0]

    @property
    def maximum(self) -> int | None:
        """The maximum number of arguments; None for any number."""
        return self.arity if isinstance(self.arity, int) else self.arity[1]

    def takes(self, count: int) -> bool:
        """Return whether it accepts that number of arguments."""
        if isinstance(self.arity, int):
            return count == self.arity
        least, most = self.arity
        return least <= count and (most is None or count <= most)


UNDECLARED = Declaration()
"""Declaration of a name that nothing declares."""
