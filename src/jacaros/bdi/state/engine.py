"""The port of plans and rules to the engine that runs them."""

from collections.abc import Callable, Iterator, Mapping, Sequence
from typing import Any, Protocol

from jacaros.bdi.actions.internal_action import InternalAction
from jacaros.bdi.state.intention import Frame, NextStep
from jacaros.bdi.state.literals import EventAnnotations
from jacaros.bdi.state.plan import Plan
from jacaros.bdi.state.rule import Answers, Rule
from jacaros.bdi.state.triggers import Goal, Trigger
from jacaros.terms.unifier import Trail
from jacaros.terms.values import Term

Select = Callable[[Any, Goal, EventAnnotations], Frame | None]
"""``select(agent, goal, annotations)``: the frame of the first applicable plan."""
Every = Callable[[Any, Goal, EventAnnotations], Iterator[Frame]]
"""The same for the frames of all applicable plans."""


class Engine(Protocol):
    """Runs the plans and rules of a program, for all agents with that program.

    `jacaros.bdi.rules.interpreter.Interpreter` does it as the rules of the language say,
    `jacaros.bdi.fast.compiler.Compiler` with code that it generates.
    """

    @property
    def actions(self) -> Mapping[str, InternalAction]:
        """The internal actions that plans may call."""

    def begin(self, agent: Any) -> None:
        """An agent is about to begin: prepare what cannot wait until it is asked for."""

    def compile_ahead(self, program: Any) -> bool:
        """Prepare a little more of the plans of a program, while there is time; False when nothing is left to prepare."""

    def select(self, trigger: Trigger, plans: Sequence[Plan], outer: Plan | None = None) -> Select:
        """What chooses among plans for one kind of event; *outer* is the plan that they are sub-plans of."""

    def every(self, trigger: Trigger, plans: Sequence[Plan]) -> Every:
        """The same for all applicable plans."""

    def give_steps(self, plan: Plan) -> None:
        """Give a plan that stands for a body made at run time its steps."""

    def step_at(self, plan: Plan, position: str) -> NextStep:
        """The step at a position (`jacaros.bdi.state.plan.position_of`) of a plan, which is compiled if necessary."""

    def answers(self, agent: Any, rule: Rule, arguments: tuple[Term, ...], trail: Trail) -> Answers:
        """The answers of a rule, see `jacaros.bdi.rules.searching.run`."""

    def searches(self, predicate: Any) -> tuple[Any, Any] | None:
        """Functions that answer questions for a predicate with rules, and those for deep searches; None without any."""
