"""Run plans and rules with code generated for them. What cannot be compiled is interpreted."""

from collections.abc import Iterator, Mapping, Sequence
from contextlib import suppress
from itertools import islice
from typing import Any

from jacaros.asl.walk import walk
from jacaros.bdi.actions.internal_action import InternalAction
from jacaros.bdi.fast.generated.unit import write_body
from jacaros.bdi.fast.plan_by_plan import PlanByPlan
from jacaros.bdi.fast.searches import Searches
from jacaros.bdi.fast.units import Units, executed
from jacaros.bdi.rules.interpreter import Interpreter
from jacaros.bdi.state.circumstance import Circumstance
from jacaros.bdi.state.engine import Every, Select
from jacaros.bdi.state.intention import NextStep
from jacaros.bdi.state.plan import Plan
from jacaros.bdi.state.plan_library import ProgramPlans
from jacaros.bdi.state.rule import Answers, Rule
from jacaros.bdi.state.triggers import Trigger
from jacaros.bdi.state.triggers import trigger as trigger_of_kind
from jacaros.terms.unifier import Trail
from jacaros.terms.values import Term, functor

FEW = 4
"""Up to this number of plans for one kind of event become one function, at the latest at their first event."""
TOO_LARGE = (SyntaxError, RecursionError, MemoryError)
"""What Python raises for code that exceeds its limits for one function."""


class Compiler(Interpreter):
    """Runs plans and rules with generated code, see `jacaros.bdi.state.engine.Engine`.

    Args:
        actions: the internal actions that plans may call.
    """

    def __init__(self, actions: Mapping[str, InternalAction]) -> None:
        super().__init__(actions)
        self._units = Units(actions)
        self._functions: dict[Any, Any] = {}
        self._begun = False
        self._one_by_one: dict[Trigger, PlanByPlan] = {}

    def select(self, trigger: Trigger, plans: Sequence[Plan], outer: Plan | None = None) -> Select:
        """What chooses among plans for one kind of event."""

        def compiled(some: Sequence[Plan], outer: Plan | None) -> Select:
            try:
                return self._units.select(trigger, some, outer)
            except TOO_LARGE:
                if len(some) > 1:
                    raise
                return Interpreter.select(self, trigger, some, outer)

        if len(plans) <= FEW:
            with suppress(*TOO_LARGE):
                return compiled(plans, outer)
        one_by_one = PlanByPlan(plans, outer, compiled)
        if outer is None:
            self._one_by_one[trigger] = one_by_one
        return one_by_one.select()

    def every(self, trigger: Trigger, plans: Sequence[Plan]) -> Every:
        """The same for all applicable plans."""
        try:
            return self._units.select(trigger, plans, every=True)
        except TOO_LARGE:
            return super().every(trigger, plans)

    def give_steps(self, plan: Plan) -> None:
        """Give a plan that stands for a body made at run time its steps."""
        try:
            executed(write_body(plan, self.actions))
        except TOO_LARGE:
            super().give_steps(plan)

    def step_at(self, plan: Plan, position: str) -> NextStep:
        """The step at a position of a plan; the plan is compiled if that has not been done."""
        if position[0] == "i":
            return super().step_at(plan, position)
        if not hasattr(plan.first, "__globals__"):
            if plan.body_term is not None:
                self.give_steps(plan)
            else:
                head = plan.node.trigger
                symbol = plan.trigger_functor() or functor("plan", 0)
                self.select(trigger_of_kind(head.operator, head.kind, symbol), [plan], plan.scope)
        first: Any = plan.first
        step: NextStep = first.__globals__[f"{first.__name__.rpartition('_')[0]}_{position[1:]}"]
        return step

    def begin(self, agent: Circumstance) -> None:
        """Compile the urgent part before an agent starts, and warn of plans that are too large. Done for the first
        agent.
        """
        if self._begun:
            return
        self._begun = True
        program = agent.library.program
        for _, told in too_large(program.plans, self._units):
            agent.architecture.log("warning", f"{told}: it runs slower")
        urgencies = agent.selections.urgencies
        if urgencies is not None:
            for kind in filter(urgencies.__getitem__, program.kinds()):
                while self._compile_ahead(program, kind):
                    pass

    def compile_ahead(self, program: ProgramPlans) -> bool:
        """Compile something that no event has needed yet; return False if there is nothing left."""
        return any(self._compile_ahead(program, kind) for kind in program.kinds())

    def _compile_ahead(self, program: ProgramPlans, kind: Trigger) -> bool:
        is_new = kind not in program.selects
        program.selects[kind]  # made when it is looked up
        return (kind in self._one_by_one and self._one_by_one[kind].compile_next()) or is_new

    def answers(self, agent: Any, rule: Rule, arguments: tuple[Term, ...], trail: Trail) -> Answers:
        """The answers of a rule."""
        if rule.made is None:
            rule.made = self._rule_function(rule)
        found: Answers = rule.made(agent, arguments, trail)
        return found

    def _rule_function(self, rule: Rule) -> Any:
        functions = self._functions if rule.of_program else {}
        key = (id(rule.written),)
        if key not in functions:
            # Hold the syntax, so that no other object can get the same id.
            functions[key] = (self._units.rule(rule), rule.written)
        return functions[key][0]

    def searches(self, predicate: Any) -> tuple[Any, Any] | None:
        """Functions that answer questions for a predicate with rules, and those for deep searches."""
        return (
            Searches(predicate, self._units, self._functions),
            Searches(predicate, self._units, self._functions, deep=True),
        )


_LARGE = 100
"""Parts of a plan from which on it is looked at whether it can be compiled."""


def too_large(plans: Sequence[Plan], units: Units) -> Iterator[tuple[Plan, str]]:
    """Yield the plans that are too large to compile, each with a description."""
    for plan in plans:
        if sum(1 for _ in islice(walk(plan.node), _LARGE)) < _LARGE:
            continue
        head = plan.node.trigger
        symbol = plan.trigger_functor()
        kind = trigger_of_kind(head.operator, head.kind, symbol or functor("plan", 0))
        try:
            units.select(kind, [plan])
        except TOO_LARGE as fault:
            name = f"{head.operator}{head.kind}{'_' if symbol is None else repr(symbol)}"
            span = plan.node.span
            place = "" if span is None else f" ({span.file.name}:{span.line})"
            yield plan, f"plan {name}{place} is too large to compile ({fault})"
