"""The interface of all operators to their pattern."""

import math
from collections.abc import Callable

Values = tuple[object, ...]

SHOW, HIDE, OCCUR = "show", "hide", "occur"
"""Kinds of output: the derived state begins or changes its values; it ends; an occurrence."""

Emit = Callable[[str, Values], None]
"""Takes the kind of an output and its values (empty for `HIDE`)."""


class Operator:
    """Takes events in time order and emits their consequences.

    The pattern calls `advance` at each deadline before it passes a later event.

    Args:
        emit: takes the outputs.

    Attributes:
        ordered: whether events must arrive in time order; otherwise the operator orders them itself.
        deadline: time in seconds at which the output may change without an event; infinite for never.
        shown: values of the current state, None without one.
    """

    ordered = True

    __slots__ = ("_emit", "deadline", "shown")

    def __init__(self, emit: Emit) -> None:
        self._emit = emit
        self.deadline = math.inf
        self.shown: Values | None = None

    def take(self, source: int, time: float, values: Values | None) -> None:
        """Process an event.

        Args:
            source: number of its stream.
            time: seconds since the start of the pattern.
            values: values of the event; None if the state shown by the stream ended.
        """
        raise NotImplementedError

    def advance(self, time: float) -> None:
        """Advance to *time*, at which `deadline` is reached."""
        raise NotImplementedError

    def show(self, values: Values) -> None:
        """Emit that the state holds with *values*, unless it already does."""
        if values != self.shown:
            self.shown = values
            self._emit(SHOW, values)

    def hide(self) -> None:
        """Emit that the state ended, if it held."""
        if self.shown is not None:
            self.shown = None
            self._emit(HIDE, ())

    def occur(self, values: Values = ()) -> None:
        """Emit an occurrence."""
        self._emit(OCCUR, values)

    def hold(self, holds: bool) -> None:
        """Show or hide a state without values."""
        if holds:
            self.show(())
        else:
            self.hide()


def number_at(values: Values | None, place: int) -> float | None:
    """Return the finite number at *place*; None otherwise."""
    if values is None or place >= len(values):
        return None
    value = values[place]
    return float(value) if isinstance(value, int | float) and math.isfinite(value) else None
