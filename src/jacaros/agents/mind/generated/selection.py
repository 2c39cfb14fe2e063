"""Code that selects a plan: one function per event kind, containing all its plans in order.

``select(agent, goal, annotations)`` tries the plans in turn: head, then context. It returns the new frame of the first
plan that applies, or None if no plan is applicable (rules RelPl, ApplPl and SelAppl in one).
"""

from collections.abc import Mapping, Sequence
from typing import Any, NamedTuple

from jacaros.agents.language import nodes
from jacaros.agents.language.nodes import names_in
from jacaros.agents.mind.actions.internal_action import InternalAction
from jacaros.agents.mind.generated.bodies import BodyCompiler
from jacaros.agents.mind.generated.conditions import condition
from jacaros.agents.mind.generated.function import CodeUnit, FrameLayout, FunctionBuilder
from jacaros.agents.mind.generated.matching import (
    annotation_parts,
    build,
    first_match,
    match_all,
    patterns_in_order,
    settle_fresh,
    tuple_of,
)
from jacaros.agents.mind.state.plan import ALL_UNIFIERS, Plan, StepInfo
from jacaros.agents.mind.state.triggers import Trigger
from jacaros.agents.terms.values import Functor


class CompiledBody(NamedTuple):
    """The written body of a plan.

    Attributes:
        plan: whose body it is.
        first: name of its first step function, ``"None"`` without any.
        size: number of places of a frame behind the fixed ones.
        steps: what is known of each step, by the name of its function.
    """

    plan: Plan
    first: str
    size: int
    steps: dict[str, StepInfo]

    def install(self, names: Mapping[str, Any]) -> None:
        """Give the plan its steps.  What is known of a step is kept with its function: a frame may still be at a step of an
        earlier unit when the plan is compiled again.
        """
        plan = self.plan
        plan.first = names[self.first] if self.first != "None" else None
        plan.steps, plan.size = self.steps, self.size
        for name, info in self.steps.items():
            function = names[name]
            function.plan, function.info, function.steps = plan, info, self.steps


class CompiledUnit(NamedTuple):
    """A unit that has been written, and what its functions are for.

    Attributes:
        unit: holds the code.
        name: of the function that others call.
        bodies: of the plans that it chooses among.
        conditions: of each plan that has one, the name of the test of its goal condition.
    """

    unit: CodeUnit
    name: str
    bodies: Sequence[CompiledBody] = ()
    conditions: Sequence[tuple[Plan, str]] = ()


# Code that answers questions for a predicate with rules: one generator for its facts and rules in their order.
#
# What a generator is made for is a *pattern of use*: which arguments are given.  ``search(agent, t, d, *given)`` yields a
# row for each answer, whose other arguments are computed and never go through a variable.  Rules call the generators of
# other predicates directly, as loops, down to ``NESTED`` of them inside one another (*d* counts down).  What lies deeper is
# searched by `jacaros.agents.mind.rules.searching.run` without Python recursion, and so is what goes on while beliefs
# change: for both there is a second function, which does not call, but yields the generators that it wants to have run.


def given_positions(pattern: int, arity: int) -> list[int]:
    """The places of the arguments that are given; *pattern* has a bit for each."""
    return [i for i in range(arity) if pattern >> i & 1]


def write_search(
    symbol: Functor,
    pattern: int,
    before: Sequence[nodes.Rule],
    after: Sequence[nodes.Rule],
    actions: Mapping[str, InternalAction],
    trampoline: bool,
) -> CompiledUnit:
    """Write the generator function of a predicate for one pattern of use.

    Args:
        symbol: the predicate.
        pattern: which arguments are given.
        before: the rules that answer before all facts.
        after: those that answer after them.
        actions: the internal actions known at compile time.
        trampoline: write the function that is driven by ``run``.
    """
    unit = CodeUnit(_file_of((*before, *after)[0]), actions)
    name = unit.fresh_function("search")
    fn = FunctionBuilder(unit, trampoline=trampoline, depth="d - 1")
    given = {i: f"a{i}" for i in given_positions(pattern, symbol.arity)}
    fn.at((*before, *after)[0])
    with fn.function(name, "agent", "t", "d", *given.values()):
        if not trampoline:
            fn.line("t.room -= 1")
            fn.line("if t.room < 0: too_many_open(agent.options.rule_depth)")
        for rule in before:
            _rule(fn, rule, given)
        fn.at((*before, *after)[0])
        _facts(fn, symbol, given)
        for rule in after:
            _rule(fn, rule, given)
        if not trampoline:
            fn.line("t.room += 1")
        fn.line("return")
        fn.line("yield")
    return CompiledUnit(unit, name)


def _facts(fn: FunctionBuilder, symbol: Functor, given: dict[int, str]) -> None:
    fn.line(f"b = agent.beliefs[{fn.constant(symbol)}]")
    with fn.block("if len(b.rows) > b.others:"):
        if not given:
            rows = "rows_still_held(b, list(reversed(b.rows)))" if fn.trampoline else "reversed(b.rows)"
            with fn.block(f"for row in {rows}:"):
                fn.line("if row.__class__ is tuple: yield row")
            return
        known = list(given.values())
        if len(given) == symbol.arity:
            rows = f"b.exact({tuple_of(known)})"
        else:
            key = known[0] if len(known) == 1 else tuple_of(known)
            rows = f"b.find({fn.constant(tuple(given))}, {key})"
            rows = f"rows_still_held(b, list({rows}))" if fn.trampoline else rows
        arguments = tuple_of([given.get(i, "Var()") for i in range(symbol.arity)])
        test = " and ".join(f"{value}.__class__ in ATOMIC" for value in known)
        general = f"facts(b, {arguments}, t{', True' if fn.trampoline else ''})"
        fn.line(f"for row in ({rows} if {test} else {general}): yield row")


def _rule(fn: FunctionBuilder, rule: nodes.Rule, given: dict[int, str]) -> None:
    arguments = rule.head.arguments
    mark = fn.local("n")

    def answer() -> None:
        row = [given[i] if i in given else build(fn, a) for i, a in enumerate(arguments)]
        fn.line(f"yield {tuple_of(row)}" if row else "yield ()")

    with fn.branch():
        fn.at(rule)
        fn.line(f"{mark} = len(t)")
        match_all(
            fn,
            [arguments[i] for i in given],
            list(given.values()),
            lambda: condition(fn, rule.body, answer),
        )
        fn.line(f"if len(t) > {mark}: undo(t, {mark})")


class SelectCompiler:
    """Writes the select function of one event kind, and the steps of its plans.

    Attributes:
        every: the function is a generator of the frames of all applicable plans: of each plan the first one, or, when
            its label says ``all_unifs``, one for each answer of its context.
        bodies: for each plan, the names of its step functions and what is known of them.
        firsts: for each plan, the name of the first step function.
    """

    def __init__(self, unit: CodeUnit, arity: int, every: bool = False) -> None:
        self.unit = unit
        self.arity = arity
        self.every = every
        self.bodies: list[tuple[Plan, BodyCompiler, str]] = []

    def select(self, plans: Sequence[Plan], outer: Plan | None = None) -> str:
        """Write the function; returns its name.  Sub-plans see the variables of their *outer* plan's frame."""
        name = self.unit.fresh_function("select")
        fn = FunctionBuilder(self.unit)
        fn.at(plans[0].node)
        with fn.function(name, "agent", "goal", "annotations"):
            fn.line("t = agent.trail")
            if outer is not None:
                _read_outer(fn, outer, plans)
            parts = [fn.local("a") for _ in range(self.arity)]
            if any(map(_looks_at_arguments, plans)):
                fn.line(f"_, {', '.join(parts)} = goal")
            for index, plan in enumerate(plans):
                fn.at(plan.node)
                if index:
                    fn.line("if t: undo(t, 0)")
                with fn.branch(), fn.block("try:"):
                    self._plan(fn, plan, parts)
                fn.line("except InternalError: raise")
                if self.every:
                    fn.line("except NextPlan: pass")
                fn.line(f"except Exception as fault: agent.context.report_plan({fn.constant(plan)}, fault)")
            fn.line("if t: undo(t, 0)")
            fn.line("return" if self.every else "return None")
            if self.every:
                fn.line("yield")
        return name

    def _plan(self, fn: FunctionBuilder, plan: Plan, parts: list[str]) -> None:
        literal = plan.node.trigger.literal
        if isinstance(literal, nodes.Variable):
            self._variable_trigger(fn, plan, literal)
            return
        if isinstance(literal.namespace, nodes.Variable):
            self._variable_namespace(fn, plan, literal, literal.namespace, parts)
            return
        self._arguments(fn, plan, literal, parts)

    def _variable_namespace(
        self,
        fn: FunctionBuilder,
        plan: Plan,
        literal: nodes.Literal,
        namespace: nodes.Variable,
        parts: list[str],
    ) -> None:
        """A trigger ``+!N::g(X)``: the event may be of any namespace."""
        name, arity, negated = literal.functor, len(literal.arguments), literal.negated
        if arity != self.arity:
            fn.line("pass")
            return
        symbol = "goal[0].functor"
        same = f"{symbol}.name == {name!r} and {symbol}.negated is {negated}"
        with fn.block(f"if {same}:"):
            if not namespace.unnamed:
                fn.bind(namespace.name, f"namespace_of({symbol})")
            self._arguments(fn, plan, literal, parts)

    def _arguments(self, fn: FunctionBuilder, plan: Plan, literal: nodes.Literal, parts: list[str]) -> None:
        match_all(
            fn, list(literal.arguments), parts, lambda: self._annotations(fn, plan, literal.annotations)
        )

    def _variable_trigger(self, fn: FunctionBuilder, plan: Plan, variable: nodes.Variable) -> None:
        if variable.unnamed:
            self._annotations(fn, plan, variable.annotations)
            return
        whole = variable.annotations is None
        value = f"literal_of(goal, {'annotations' if whole else '()'})"
        if variable.negated:
            with fn.block("if goal[0].functor.negated:"):
                fn.bind(variable.name, f"positive({value})")
                self._annotations(fn, plan, variable.annotations)
            return
        fn.bind(variable.name, value)
        self._annotations(fn, plan, variable.annotations)

    def _annotations(self, fn: FunctionBuilder, plan: Plan, annotations: nodes.Annotations | None) -> None:
        if annotations is None:
            self._context(fn, plan)
            return
        patterns = patterns_in_order(annotations)
        if patterns is not None:
            held = fn.local("h")
            fn.line(
                f"{held} = annotations if annotations.__class__ is tuple else annotations_of_event(annotations)"
            )
            first_match(fn, patterns, held, lambda: self._context(fn, plan))
            return
        items, tail = annotation_parts(fn, annotations)
        with fn.block(f"if unify_annotations({items}, {tail}, annotations_of_event(annotations), None, t):"):
            settle_fresh(fn, names_in(annotations))
            self._context(fn, plan)

    def _context(self, fn: FunctionBuilder, plan: Plan) -> None:
        if plan.node.context is None:
            self._frame(fn, plan)
        else:
            fn.at(plan.node.context)
            condition(fn, plan.node.context, lambda: self._frame(fn, plan))

    def _frame(self, fn: FunctionBuilder, plan: Plan) -> None:
        """The innermost point: the plan is applicable, its frame is made and given back."""
        node = plan.node
        frame = FrameLayout(plan)
        for variable in fn.values:
            if variable in frame.slots:
                frame.states[variable] = "set"
        prefix = self.unit.fresh_function("step")
        body = BodyCompiler(self.unit, frame, prefix)
        assert isinstance(node.body, nodes.Body)
        first = body.body(node.body.steps, "None")
        self.bodies.append((plan, body, first))
        values = [fn.values.get(v, "None") for v in frame.slots]
        fixed = [
            "begin_guarded" if plan.guards else first,
            "goal",
            "annotations",
            "t.serial",
            fn.constant(plan),
        ]
        made = f"[{', '.join([*fixed, *values, *(['None'] * frame.extra)])}]"
        if not self.every:
            fn.line(f"return {made}")
            return
        fn.line(f"yield {made}")
        if ALL_UNIFIERS not in plan.annotations:
            fn.line("raise NextPlan")


def _looks_at_arguments(plan: Plan) -> bool:
    literal = plan.node.trigger.literal
    return isinstance(literal, nodes.Literal) and any(
        not (isinstance(a, nodes.Variable) and a.unnamed) for a in literal.arguments
    )


def _read_outer(fn: FunctionBuilder, outer: Plan, plans: Sequence[Plan]) -> None:
    names = [n for n in names_in(tuple(p.node for p in plans)) if n in outer.slots]
    if names:
        fn.line("outer = agent.outer_frame")
    for name in names:
        fn.line(f"v_{name} = outer[{outer.slots[name]}]")
        fn.line(f'if v_{name} is None: v_{name} = outer[{outer.slots[name]}] = Var("{name}")')
        fn.values[name] = f"v_{name}"


def _goal_condition(unit: CodeUnit, plan: Plan) -> str:
    """Write the test of a goal condition: ``holds(agent, frame)``; it leaves no bindings behind."""
    name = unit.fresh_function("achieved")
    fn = FunctionBuilder(unit)
    node = plan.node.goal_condition
    assert node is not None
    fn.at(node)

    def then() -> None:
        fn.line("undo(t, n0)")
        fn.line("return True")

    with fn.function(name, "agent", "frame"):
        fn.line("t = agent.trail")
        fn.line("n0 = len(t)")
        for variable in names_in(node):
            if variable in plan.slots:
                fn.line(f"v_{variable} = frame[{plan.slots[variable]}]")
                fn.line(f'if v_{variable} is None: v_{variable} = Var("{variable}")')
                fn.values[variable] = f"v_{variable}"
        condition(fn, node, then)
        fn.line("return False")
    return name


def write_rule(rule: nodes.Rule, actions: Mapping[str, InternalAction]) -> CompiledUnit:
    """Write the generator function of a rule: ``rule(agent, arguments, t)`` yields once per answer."""
    unit = CodeUnit(_file_of(rule), actions)
    name = unit.fresh_function("rule")
    fn = FunctionBuilder(unit, trampoline=True)
    fn.at(rule)
    arguments = rule.head.arguments
    parts = [fn.local("a") for _ in arguments]
    with fn.function(name, "agent", "arguments", "t"):
        fn.line("n0 = len(t)")
        if parts:
            fn.line(f"{tuple_of(parts)} = arguments")

        def answer() -> None:
            if rule.head.annotations is None:
                fn.line("yield ()")
            else:
                items, _ = annotation_parts(fn, rule.head.annotations)
                fn.line(f"yield (resolve_all({items}),)")

        def matched() -> None:
            condition(fn, rule.body, answer)

        match_all(fn, list(arguments), parts, matched)
        fn.line("if len(t) > n0: undo(t, n0)")
        fn.line("return")
        fn.line("yield")
    return CompiledUnit(unit, name)


def _file_of(rule: nodes.Rule) -> str:
    return rule.span.file.name if rule.span is not None else "<run time>"


def write_select(
    trigger: Trigger,
    plans: Sequence[Plan],
    actions: Mapping[str, InternalAction],
    outer: Plan | None = None,
    every: bool = False,
) -> CompiledUnit:
    """Write the select function of an event kind; *outer* is the plan that sub-plans belong to.

    With *every* it is a generator of the frames of all applicable plans.
    """
    unit = CodeUnit(plans[0].file, actions)
    compiler = SelectCompiler(unit, trigger.functor.arity, every)
    name = compiler.select(plans, outer)
    conditions = [
        (plan, _goal_condition(unit, plan)) for plan in plans if plan.node.goal_condition is not None
    ]
    bodies = [CompiledBody(plan, first, body.frame.size, body.infos) for plan, body, first in compiler.bodies]
    return CompiledUnit(unit, name, bodies, conditions)


def write_body(plan: Plan, actions: Mapping[str, InternalAction]) -> CompiledUnit:
    """Write the steps of a plan that stands for a body made at run time."""
    unit = CodeUnit("<body>", actions)
    compiler = BodyCompiler(unit, FrameLayout(plan), "step")
    body = plan.node.body
    assert isinstance(body, nodes.Body)
    first = compiler.body(body.steps, "None")
    return CompiledUnit(unit, first, [CompiledBody(plan, first, compiler.frame.size, compiler.infos)])
