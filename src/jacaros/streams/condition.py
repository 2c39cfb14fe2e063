"""Conditions on one value."""

from dataclasses import dataclass
from typing import Final


class _Anything:
    """Marks that no value is required."""


ANYTHING: Final = _Anything()


@dataclass(frozen=True, slots=True)
class Condition:
    """A condition on a value; all given parts must hold.

    Attributes:
        above, below: exclusive limits; None for no limit.
        equals: required value.
    """

    above: float | None = None
    below: float | None = None
    equals: object = ANYTHING

    @property
    def is_open(self) -> bool:
        """Whether every value satisfies the condition."""
        return self.above is None and self.below is None and self.equals is ANYTHING

    def holds(self, value: object) -> bool:
        """Return whether *value* satisfies the condition; values that are not numbers never exceed a limit."""
        if self.equals is not ANYTHING and value != self.equals:
            return False
        if self.above is None and self.below is None:
            return True
        if not isinstance(value, int | float):
            return False
        return (self.above is None or value > self.above) and (self.below is None or value < self.below)
