"""Sequences of events, and their absence."""

import math
from collections.abc import Sequence

from jacaros.streams.operator import Emit, Operator, Values


class Chain(Operator):
    """A sequence of events; occurs with the last one, if the first was less than *within* seconds before.

    Of all chains that end with an event, the one with the latest start counts; events can be used repeatedly. Therefore
    only the latest start of each prefix of the chain is stored.

    Args:
        steps: numbers of the streams, in the order of the chain.
        within: maximum duration in seconds.
    """

    __slots__ = ("_begun", "_steps", "_within")

    def __init__(self, emit: Emit, steps: Sequence[int], within: float) -> None:
        super().__init__(emit)
        self._steps, self._within = tuple(steps), within
        self._begun = [-math.inf] * len(self._steps)

    def take(self, source: int, time: float, values: Values | None) -> None:
        if values is None:
            return
        begun, last = self._begun, len(self._steps) - 1
        for step in range(last, -1, -1):  # from the end, so that an event does not follow itself
            if self._steps[step] == source:
                begun[step] = begun[step - 1] if step else time
                if step == last and begun[step] + self._within > time:
                    self.occur()

    def advance(self, time: float) -> None:
        self.deadline = math.inf


class Absent(Operator):
    """Holds while the newest event, or the start of the pattern, is *lasting* seconds or longer ago."""

    __slots__ = ("_lasting",)

    def __init__(self, emit: Emit, lasting: float) -> None:
        super().__init__(emit)
        self._lasting = lasting
        self.deadline = lasting

    def take(self, source: int, time: float, values: Values | None) -> None:
        if values is not None:
            self.deadline = time + self._lasting
            self.hide()

    def advance(self, time: float) -> None:
        self.deadline = math.inf
        self.show(())
