"""Arguments of operations that come from the blackboard, and results that go there."""

from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class FromBlackboard:
    """An argument that is read from the blackboard whenever the operation begins.

    Attributes:
        key: of the blackboard, such as ``goal``, or an attribute of what is there, such as ``goal.x``.
    """

    key: str

    def __str__(self) -> str:
        return self.key


@dataclass(frozen=True, slots=True)
class ToBlackboard:
    """An output parameter: its value goes to the blackboard when the operation has succeeded.

    Attributes:
        key: of the blackboard.
    """

    key: str

    def __str__(self) -> str:
        return f"-> {self.key}"
