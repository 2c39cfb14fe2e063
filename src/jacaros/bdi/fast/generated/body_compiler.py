"""The body of a plan while its steps are written: what is known of them, and what writers of all kinds of steps share."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

from jacaros.asl import nodes
from jacaros.bdi.fast.generated.conditions import condition
from jacaros.bdi.fast.generated.function import FrameLayout, FunctionBuilder, Unit
from jacaros.bdi.state.plan import StepInfo

StepWriter = Callable[["BodyCompiler", Any, str, str], None]
"""Writes one step: it is given the step, the name of its function and the name of the next one."""


@dataclass
class BodyCompiler:
    """Writes the steps of one plan body.

    Attributes:
        writers: who writes which kind of step.
        infos: what is known of each step function, by its name.
    """

    unit: Unit
    frame: FrameLayout
    prefix: str
    writers: Mapping[type, StepWriter]
    infos: dict[str, StepInfo] = field(default_factory=dict)
    _count: int = 0

    def body(self, steps: Sequence[nodes.Step], after: str) -> str:
        """Write the steps; return the name of the first, or *after* without any."""
        if not steps:
            return after
        first = self.name()
        self.branch(steps, first, after)
        return first

    def branch(self, steps: Sequence[nodes.Step], first: str, after: str) -> None:
        """Write the steps, the first one under a name that is already used."""
        if not steps:
            return
        rest = [self.name() for _ in steps[1:]]
        for step, name, next_name in zip(steps, [first, *rest], [*rest, after], strict=True):
            self.infos[name] = StepInfo(step, next_name)
            self.writers[type(step)](self, step, name, next_name)

    def name(self) -> str:
        """A name for a step function."""
        self._count += 1
        return f"{self.prefix}_{self._count}"

    def begin(self, step: nodes.Node) -> FunctionBuilder:
        """A builder for the function of a step."""
        fn = FunctionBuilder(self.unit)
        fn.at(step)
        return fn

    def finish(self, fn: FunctionBuilder) -> None:
        """The function of a step is written, and what it binds is kept in the frame."""
        fn.mark_stored(self.frame)
        self.unit.add(fn.writer)

    def success(self, fn: FunctionBuilder, formula: nodes.Node, next_name: str) -> list[str]:
        """Write a test whose first answer continues with *next_name*; return the variables that it binds."""
        bound: list[str] = []

        def then() -> None:
            fn.store(self.frame)
            fn.line(f"frame[0] = {next_name}")
            fn.line("return None")
            bound.extend(fn.fresh)

        condition(fn, formula, then)
        return bound

    def learn(self, names: Sequence[str], state: str = "set") -> None:
        """Take note that variables have a value from now on, or ``maybe`` have one."""
        for variable in names:
            if variable in self.frame.slots and self.frame.states.get(variable) != "set":
                self.frame.states[variable] = state


def head(name: str) -> str:
    """The head of a step function."""
    return f"def {name}(agent, frame):"
