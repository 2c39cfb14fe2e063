"""Run plans and rules with code generated for them. What cannot be compiled is interpreted."""

from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import suppress
from itertools import islice
from typing import Any, cast

from jacaros.agents.language import nodes
from jacaros.agents.language.nodes import walk
from jacaros.agents.mind.actions.internal_action import InternalAction
from jacaros.agents.mind.generated.matching import functor_of_literal
from jacaros.agents.mind.generated.selection import (
    CompiledUnit,
    given_positions,
    write_body,
    write_rule,
    write_search,
    write_select,
)
from jacaros.agents.mind.rules.add_im import Interpreter, Selection
from jacaros.agents.mind.rules.searching import run, solve
from jacaros.agents.mind.state.belief_base import Table
from jacaros.agents.mind.state.circumstance import Circumstance
from jacaros.agents.mind.state.intention import STEP, Frame, NextStep
from jacaros.agents.mind.state.plan import Answers, Every, Plan, Rule, Select
from jacaros.agents.mind.state.plan_library import ProgramPlans
from jacaros.agents.mind.state.triggers import EventAnnotations, Goal, Trigger
from jacaros.agents.mind.state.triggers import trigger as trigger_of_kind
from jacaros.agents.terms.substitution import ATOMIC
from jacaros.agents.terms.unifier import Trail
from jacaros.agents.terms.values import CONS, NIL, List, String, Term, Var, functor


def executed(made: CompiledUnit) -> Callable[..., Any]:
    """The function of a unit, which is executed; its plans have their steps afterwards."""
    names = made.unit.globals
    for part in made.unit.code():
        exec(part, names)  # only ever made from a syntax tree
    for plan, achieved in made.conditions:
        plan.goal_condition = names[achieved]
    for body in made.bodies:
        body.install(names)
    return cast("Callable[..., Any]", names.get(made.name))  # None for a body without steps


# Functions that answer questions for a predicate with rules, in the place of its rules asked one by one.
#
# Stands for `jacaros.agents.mind.rules.searching.solve`.


Search = Callable[..., Iterator[tuple[Term, ...]]]
"""``search(agent, trail, depth, *given)``, see `jacaros.agents.mind.generated.selection`."""
_TIMES_ASKED = 10


class Searches(dict[int, Search]):
    """The generator functions of a predicate with rules, by pattern of use, each made when it is first wanted.

    Args:
        actions: the internal actions that they may call.
        functions: where functions are kept that all agents of a program share.

    Attributes:
        deep: they are driven by `run`.
        before: functions were made of which some rule answers before the facts.
    """

    def __init__(
        self,
        predicate: Table,
        actions: Mapping[str, InternalAction],
        functions: dict[Any, Any],
        deep: bool = False,
    ) -> None:
        super().__init__()
        self.predicate = predicate
        self._actions, self._functions = actions, functions
        self.deep = deep
        self.before = False

    def __missing__(self, pattern: int) -> Search:
        around = self.predicate.around()
        # Rules that do not stem from the program came at run time, and others may follow.
        new = 0 if around is None else sum(not entry.of_program for side in around for entry in side)
        search = None if new else self._compiled(pattern)
        self[pattern] = search = search or self._by_unification(pattern, _TIMES_ASKED * new)
        return search

    def _by_unification(self, pattern: int, patience: int) -> Search:
        """The general way: facts, rules and beliefs with variables in any order.

        Rules that came at run time are worth a function of their own when it has been gone *patience* times.
        """
        predicate, deep = self.predicate, self.deep
        arity = predicate.functor.arity
        places = given_positions(pattern, arity)

        def search(agent: Any, trail: Trail, depth: int, *given: Term) -> Iterator[tuple[Term, ...]]:
            nonlocal patience
            del depth
            patience -= 1
            if patience == 0:
                self[pattern] = self._compiled(pattern) or search
            arguments: list[Term] = [Var() for _ in range(arity)]
            for place, value in zip(places, given, strict=True):
                arguments[place] = value
            found = solve(agent, predicate, tuple(arguments), trail, lasting=deep)
            return found if deep else run(found, agent.options.rule_depth)

        return search

    def _compiled(self, pattern: int) -> Search | None:
        """The function written for these rules; None when it takes the general way."""
        around = self.predicate.around()
        if around is None or any(entry.node is None for side in around for entry in side):
            return None
        before, after = around
        if not before and not after:
            return None
        self.before = bool(before)
        entries = (*before, *after)
        functions = self._functions if all(entry.of_program for entry in entries) else {}
        symbol = self.predicate.functor
        names = tuple(id(r.written) for r in before), tuple(id(r.written) for r in after)
        key = (symbol, pattern, names, self.deep)
        if key not in functions:
            try:
                first, last = [rule.node for rule in before], [rule.node for rule in after]
                search = executed(write_search(symbol, pattern, first, last, self._actions, self.deep))
            except (SyntaxError, RecursionError):
                return None  # Python's limits for one function
            # What was written is held, so that nothing else can be at its place in memory.
            functions[key] = (search, [entry.written for entry in entries])
        found: Search = functions[key][0]
        return found


# Many plans for one kind of event, each compiled separately.
#
# Compiling fifty plans takes a tenth of a second, too long while
# a robot waits for the reaction to an event. The host compiles them ahead when it is idle (`compile_next`). A plan that is
# tried before that is interpreted the first few times; it is compiled immediately only if it applies, as its body may have
# much to do.


_INTERPRETED = 2
"""Number of times a plan is tried before it is compiled."""

_WORTH_A_TABLE = 6
"""With this number of different first arguments, a lookup is cheaper than trying one plan after another."""

Compile = Callable[[Sequence[Plan], Plan | None], Select]
"""Gives what tries plans, one at least, and gives them their steps."""


class PlanByPlan:
    """The plans for one kind of event.

    Args:
        plans: in the order in which they are tried.
        outer: the plan that they are sub-plans of.
        compiled: compiles one of them.
    """

    __slots__ = ("_by_key", "_compiled", "_outer", "_parts", "_plans", "_rest")

    def __init__(self, plans: Sequence[Plan], outer: Plan | None, compiled: Compile) -> None:
        self._plans, self._outer, self._compiled = plans, outer, compiled
        self._parts: list[Select] = [_Waiting(self, place) for place in range(len(plans))]
        self._by_key: dict[Any, list[Select]] | None = None
        self._rest: list[Select] = []
        groups = None if outer is not None else _grouped(plans)
        if groups is not None:
            self._make_table([key for key, group in groups for _ in group])

    def _make_table(self, keys: list[Any]) -> None:
        """Note for each first argument which plans may be relevant for it; None stands for any."""
        parts = list(zip(keys, self._parts, strict=True))
        self._rest = [part for key, part in parts if key is None]
        self._by_key = {
            key: [part for own, part in parts if own is None or own is key or own == key]
            for key in dict.fromkeys(keys)
            if key is not None
        }

    def select(self) -> Select:
        """The function that chooses among the plans: one with nothing to look up but what it is given."""
        every, by_key, rest = self._parts, self._by_key, self._rest

        def select(agent: Any, goal: Goal, annotations: EventAnnotations) -> Frame | None:
            parts = every
            if by_key is not None:
                # Only the plans that may be relevant for the first argument.
                key = goal[1]
                if key.__class__ is tuple:
                    key = None if key[0].kind else key[0]  # pyright: ignore[reportIndexIssue]
                elif key.__class__ is List:
                    key = CONS
                if key.__class__ in ATOMIC:
                    parts = by_key.get(key, rest)
            for part in parts:
                frame = part(agent, goal, annotations)
                if frame is not None:
                    return frame
            return None

        return select

    def compile_next(self) -> bool:
        """Compile one more plan; False when none is left."""
        for place, part in enumerate(self._parts):
            if part.__class__ is _Waiting:
                self.compile(place)
                return True
        return False

    def compile(self, place: int) -> Select:
        """Compile one of the plans."""
        old, new = self._parts[place], self._compiled(self._plans[place : place + 1], self._outer)
        for parts in (self._parts, self._rest, *(self._by_key or {}).values()):
            parts[:] = [new if part is old else part for part in parts]
        return new

    def interpreted(self, place: int) -> Selection:
        """One of the plans, not compiled."""
        return Selection(self._plans[place : place + 1], self._outer)


class _Waiting:
    """One plan as long as it is not compiled."""

    __slots__ = ("_asked", "_place", "_plans", "_selection")

    def __init__(self, plans: PlanByPlan, place: int) -> None:
        self._plans, self._place, self._asked = plans, place, 0
        self._selection: Selection | None = None

    def __call__(self, agent: Any, goal: Goal, annotations: EventAnnotations) -> Frame | None:
        """Its frame, if it is applicable."""
        self._asked += 1
        if self._asked > _INTERPRETED:
            return self._plans.compile(self._place)(agent, goal, annotations)
        if self._selection is None:
            self._selection = self._plans.interpreted(self._place)
        frame = self._selection(agent, goal, annotations)
        if frame is not None and self._plans.compile(self._place).__class__ is not Selection:
            plan = self._selection.plans[0]
            if not plan.guards:  # a plan with guards finds its first step itself
                frame[STEP] = plan.first
        return frame


def _grouped(plans: Sequence[Plan]) -> list[tuple[Term, list[Plan]]] | None:
    """Group the plans, in order, with neighbours that have the same first argument; return None if that is not
    worthwhile.

    The first argument is represented by a key: the atom, number or string itself, or the functor of a structure or list.
    None stands for plans that may be relevant for any argument.
    """
    groups: list[tuple[Term, list[Plan]]] = []
    for plan in plans:
        key = _first_argument(plan)
        if groups and groups[-1][0] == key and groups[-1][0].__class__ is key.__class__:
            groups[-1][1].append(plan)
        else:
            groups.append((key, [plan]))
    keys = [key for key, _ in groups if key is not None]
    return groups if len(set(keys)) >= _WORTH_A_TABLE and len(groups) <= 2 * len(keys) else None


def _first_argument(plan: Plan) -> Term:
    literal = plan.node.trigger.literal
    if isinstance(literal, nodes.Variable) or isinstance(literal.namespace, nodes.Variable):
        return None
    if not literal.arguments:
        return None
    argument = literal.arguments[0]
    if isinstance(argument, nodes.Number):
        return argument.value
    if isinstance(argument, nodes.String):
        return String(argument.value)
    if isinstance(argument, nodes.ListTerm):
        return CONS if argument.items else NIL if argument.tail is None else None
    if not isinstance(argument, nodes.Literal) or isinstance(argument.namespace, nodes.Variable):
        return None
    return None if argument.annotations is not None else functor_of_literal(argument)


FEW = 4
"""Up to this number of plans for one kind of event become one function, at the latest at their first event."""
TOO_LARGE = (SyntaxError, RecursionError, MemoryError)
"""What Python raises for code that exceeds its limits for one function."""


class Compiler(Interpreter):
    """Runs plans and rules with generated code, see `jacaros.agents.mind.state.plan.Engine`.

    Args:
        actions: the internal actions that plans may call.
    """

    def __init__(self, actions: Mapping[str, InternalAction]) -> None:
        super().__init__(actions)
        self._functions: dict[Any, Any] = {}
        self._begun = False
        self._one_by_one: dict[Trigger, PlanByPlan] = {}

    def select(self, trigger: Trigger, plans: Sequence[Plan], outer: Plan | None = None) -> Select:
        """What chooses among plans for one kind of event."""

        def compiled(some: Sequence[Plan], outer: Plan | None) -> Select:
            try:
                return executed(write_select(trigger, some, self.actions, outer))
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
            return executed(write_select(trigger, plans, self.actions, every=True))
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
        for _, told in too_large(program.plans, self.actions):
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
            functions[key] = (executed(write_rule(rule.node, self.actions)), rule.written)
        return functions[key][0]

    def searches(self, predicate: Table) -> tuple[Any, Any] | None:
        """Functions that answer questions for a predicate with rules, and those for deep searches."""
        return (
            Searches(predicate, self.actions, self._functions),
            Searches(predicate, self.actions, self._functions, deep=True),
        )


_LARGE = 100
"""Parts of a plan from which on it is looked at whether it can be compiled."""


def too_large(plans: Sequence[Plan], actions: Mapping[str, InternalAction]) -> Iterator[tuple[Plan, str]]:
    """Yield the plans that are too large to compile, each with a description."""
    for plan in plans:
        if sum(1 for _ in islice(walk(plan.node), _LARGE)) < _LARGE:
            continue
        head = plan.node.trigger
        symbol = plan.trigger_functor()
        kind = trigger_of_kind(head.operator, head.kind, symbol or functor("plan", 0))
        try:
            executed(write_select(kind, [plan], actions))
        except TOO_LARGE as fault:
            name = f"{head.operator}{head.kind}{'_' if symbol is None else repr(symbol)}"
            span = plan.node.span
            place = "" if span is None else f" ({span.file.name}:{span.line})"
            yield plan, f"plan {name}{place} is too large to compile ({fault})"
