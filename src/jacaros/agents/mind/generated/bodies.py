"""Code for plan bodies: one step function per formula.

``step(agent, frame)`` reads the variables that it uses from the frame, runs its formula, stores its bindings and sets
``frame[0]`` to the next step. It returns None, or one goal (a tuple that begins with its trigger) to be handled for this
intention, or `SUSPENDED`. A failing formula returns `FAILED`, or raises `Fail` or another exception, before ``frame[0]``
changes, so the failed step is known.
"""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

from jacaros.agents.language import nodes
from jacaros.agents.language.nodes import names_in, nodes_in
from jacaros.agents.mind.generated.building import (
    annotation_parts,
    build,
    functor_of_literal,
    resolved,
    tuple_of,
    written,
)
from jacaros.agents.mind.generated.conditions import condition, question
from jacaros.agents.mind.generated.function import FrameLayout, FunctionBuilder, Unit
from jacaros.agents.mind.generated.matching import own_annotations
from jacaros.agents.mind.state.plan import StepInfo
from jacaros.agents.mind.state.triggers import trigger
from jacaros.agents.terms.substitution import ATOMIC
from jacaros.agents.terms.values import functor

# The body of a plan while its steps are written: what is known of them, and what writers of all kinds of steps share.


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


# Code for the control statements of plan bodies: ``if``, ``while``, ``for`` and the two ways to fork.
#
# A variable that gets its value on one branch only may have none afterwards; what a round of a loop binds, the next round
# finds unbound.


def _if(compiler: BodyCompiler, step: nodes.If, name: str, next_name: str) -> None:
    then_name, else_name = compiler.name(), compiler.name()
    has_else = step.otherwise is not None and bool(step.otherwise.steps)
    fn = compiler.begin(step)
    first_then = then_name if step.then.steps else next_name
    first_else = else_name if has_else else next_name
    with fn.writer.block(head(name)):
        fn.line("t = agent.trail")
        fn.load(compiler.frame, names_in(step.condition))
        bound = compiler.success(fn, step.condition, first_then)
        fn.line("if t: undo(t, 0)")
        fn.line(f"frame[0] = {first_else}")
    compiler.unit.add(fn.writer)
    before = dict(compiler.frame.states)
    compiler.learn(bound)
    compiler.branch(step.then.steps, then_name, next_name)
    after_then = dict(compiler.frame.states)
    compiler.frame.states = dict(before)
    if has_else:
        assert step.otherwise is not None
        compiler.branch(step.otherwise.steps, else_name, next_name)
    compiler.frame.states = _joined(after_then, compiler.frame.states)


def _joined(left: dict[str, str], right: dict[str, str]) -> dict[str, str]:
    """What is known after either of two branches."""
    return {
        name: "set" if left.get(name) == right.get(name) == "set" else "maybe"
        for name in dict.fromkeys([*left, *right])
    }


def _while(compiler: BodyCompiler, step: nodes.While, name: str, next_name: str) -> None:
    frame = compiler.frame
    test_name, first = compiler.name(), compiler.name()
    enter = compiler.begin(step)
    with enter.writer.block(head(name)):
        loop = _enter_loop(compiler, enter, step)
        enter.line(f"return {test_name}(agent, frame)")
    compiler.unit.add(enter.writer)
    entry = dict(frame.states)
    compiler.infos[test_name] = StepInfo(step, next_name)
    fn = compiler.begin(step)
    with fn.writer.block(head(test_name)):
        fn.line("t = agent.trail")
        _begin_round(compiler, fn, step, loop)
        fn.load(frame, names_in(step.condition))
        bound = compiler.success(fn, step.condition, first if step.body.steps else test_name)
        fn.line("if t: undo(t, 0)")
        fn.line(f"frame[0] = {next_name}")
    compiler.unit.add(fn.writer)
    compiler.learn(bound)
    compiler.branch(step.body.steps, first, test_name)
    frame.states = entry


def _for(compiler: BodyCompiler, step: nodes.For, name: str, next_name: str) -> None:
    frame = compiler.frame
    round_name, first = compiler.name(), compiler.name()
    enter = compiler.begin(step)
    enter.snapshot = True
    with enter.writer.block(head(name)):
        loop = _enter_loop(compiler, enter, step)
        enter.line("t = Trail()")
        enter.line("t.serial = agent.trail.serial")
        new = [n for n in names_in(step.condition) if n not in enter.values]
        used = [n for n in new if n in frame.slots]
        call = question(enter, step.condition, used)
        enter.line(f"frame[{loop}].answers = Remaining({call})")
        enter.line(f"return {round_name}(agent, frame)")
    compiler.unit.add(enter.writer)
    entry = dict(frame.states)
    compiler.infos[round_name] = StepInfo(step, next_name)
    fn = compiler.begin(step)
    with fn.writer.block(head(round_name)):
        _begin_round(compiler, fn, step, loop)
        if used:
            fn.line("if loop.round: release(loop.round)")
        targets = tuple_of([f"frame[{frame.slots[n]}]" for n in used]) if used else "_"
        with fn.writer.block(f"for {targets} in loop.answers:"):
            if used:
                values = tuple_of(["None", *(f"frame[{frame.slots[n]}]" for n in used)])
                fn.line(f"loop.round = free_variables({values}) if {_any_open(frame, used)} else ()")
            fn.line(f"frame[0] = {first if step.body.steps else round_name}")
            fn.line("return None")
        fn.line(f"frame[{loop}] = None")
        fn.line(f"frame[0] = {next_name}")
    compiler.unit.add(fn.writer)
    compiler.learn(used)
    compiler.branch(step.body.steps, first, round_name)
    frame.states = entry


def _begin_round(compiler: BodyCompiler, fn: FunctionBuilder, step: nodes.Node, loop: int) -> None:
    """What `Loop.begin_round` does, but for the variables that the last round of a ``for`` brought."""
    fn.line(f"loop = frame[{loop}]")
    fn.line("if loop.free: release(loop.free)")
    for place in _inner(compiler, step):
        fn.line(f"frame[{place}] = None")


def _inner(compiler: BodyCompiler, step: nodes.Node) -> list[int]:
    """Places of the variables that get their first value inside a loop: they have none when a round begins."""
    frame = compiler.frame
    return [frame.slots[n] for n in names_in(step) if n not in frame.states and n in frame.slots]


def _enter_loop(compiler: BodyCompiler, fn: FunctionBuilder, step: nodes.Node) -> int:
    """Remember which variables are free before a loop; returns the place of the `Loop`."""
    frame = compiler.frame
    names = [name for name, state in frame.states.items() if state]  # those that may hold a `Var`
    fn.load(frame, names)
    loop = frame.hidden_slot()
    # `free_variables` takes the first element of a tuple for a functor.
    # Variables that a body made at run time shares with its plan.
    shared = [fn.constant(c.value) for c in nodes_in(nodes.Constant, step) if c.value.__class__ not in ATOMIC]
    values = tuple_of(["None", *(f"frame[{frame.slots[n]}]" for n in names), *shared])
    test = "True" if shared else _any_open(frame, names)
    inner = tuple_of([str(place) for place in _inner(compiler, step)])
    fn.line(f"frame[{loop}] = Loop(free_variables({values}) if {test} else (), {inner})")
    return loop


def _any_open(frame: FrameLayout, names: list[str]) -> str:
    """A test whether any of the variables may hold something unbound."""
    tests = [f"frame[{frame.slots[n]}].__class__ not in ATOMIC" for n in names]
    return " or ".join(tests) if tests else "False"


def _fork(compiler: BodyCompiler, step: nodes.Fork, name: str, next_name: str) -> None:
    frame = compiler.frame
    names = [compiler.name() for _ in step.branches]
    fn = compiler.begin(step)
    with fn.writer.block(head(name)):
        firsts = [n if b.steps else "join_branch" for n, b in zip(names, step.branches, strict=True)]
        fn.line(f"return agent.fork({step.operator!r}, frame, {tuple_of(firsts)}, {next_name})")
    compiler.unit.add(fn.writer)
    before = dict(frame.states)
    joined = dict(before)
    for branch_name, branch in zip(names, step.branches, strict=True):
        frame.states = dict(before)
        compiler.branch(branch.steps, branch_name, "join_branch")
        for variable in frame.states:
            joined.setdefault(variable, "maybe")
    frame.states = joined


STATEMENTS: dict[type, StepWriter] = {
    nodes.If: _if,
    nodes.While: _while,
    nodes.For: _for,
    nodes.Fork: _fork,
}


def body_compiler(unit: Unit, frame: FrameLayout, prefix: str) -> BodyCompiler:
    """What writes a plan body; *prefix* is how the names of its step functions begin."""
    return BodyCompiler(unit, frame, prefix, _STEPS)


def _goal_expression(fn: FunctionBuilder, operator: str, kind: str, literal: nodes.Literal) -> str:
    symbol = functor_of_literal(literal)
    arguments = [build(fn, a) for a in literal.arguments]
    return tuple_of([fn.constant(trigger(operator, kind, symbol)), *arguments])


def _is_fixed(literal: nodes.Node) -> bool:
    """Whether the functor of a literal is known when the plan is compiled."""
    return isinstance(literal, nodes.Literal) and not isinstance(literal.namespace, nodes.Variable)


def _achieve(compiler: BodyCompiler, step: nodes.Achieve, name: str, next_name: str) -> None:
    fn = compiler.begin(step)
    with fn.writer.block(head(name)):
        fn.load(compiler.frame, names_in(step))
        goal = step.goal
        if _is_fixed(goal):
            assert isinstance(goal, nodes.Literal)
            posted = _goal_expression(fn, "+", "!", goal)
            if goal.annotations is not None:
                items, tail = annotation_parts(fn, goal.annotations)
                posted = f"agent.annotated_goal({posted}, {items}, {tail}, {step.separate})"
        else:
            posted = f'agent.goal_from("+", "!", {build(fn, goal)}, {step.separate})'
        if step.separate:
            fn.line(f"agent.post_separate({posted})")
        elif "agent." in posted:
            fn.line(f"posted = {posted}")
        fn.store(compiler.frame)
        fn.line(f"frame[0] = {next_name}")
        if not step.separate:
            fn.line(f"return {'posted' if 'agent.' in posted else posted}")
    compiler.finish(fn)


def _test(compiler: BodyCompiler, step: nodes.Test, name: str, next_name: str) -> None:
    fn = compiler.begin(step)
    formula = step.formula
    asked = isinstance(formula, (nodes.Literal, nodes.Variable))
    with fn.writer.block(head(name)):
        fn.line("t = agent.trail")
        fn.load(compiler.frame, names_in(step))
        if isinstance(formula, nodes.Variable):
            wanted = build(fn, formula)
            fn.line(
                f"if bare({wanted}).__class__ is Var: agent.test_goal_from({wanted})  # raises the failure"
            )
        bound = compiler.success(fn, formula, next_name)
        if isinstance(formula, nodes.Literal) and _is_fixed(formula):
            _test_goal(compiler, fn, formula, next_name)
        elif asked:
            fn.line(f"posted = agent.test_goal_from({build(fn, formula)})")
            fn.store(compiler.frame)
            fn.line(f"frame[0] = {next_name}")
            fn.line("return posted")
        else:
            fn.line("return FAILED")
    compiler.learn(bound)
    if asked:
        compiler.learn([n for n in names_in(step) if n not in bound], "maybe")
    compiler.unit.add(fn.writer)


def _test_goal(compiler: BodyCompiler, fn: FunctionBuilder, formula: nodes.Literal, next_name: str) -> None:
    """No answer in the belief base: a plan for the test goal may find one."""
    symbol = functor_of_literal(formula)
    fn.line(f"if not agent.may_test({fn.constant(trigger('+', '?', symbol))}): return FAILED")
    goal = _goal_expression(fn, "+", "?", formula)
    if formula.annotations is not None:
        items, tail = annotation_parts(fn, formula.annotations)
        goal = f"agent.annotated_goal({goal}, {items}, {tail})"
    fn.line(f"posted = {goal}")
    fn.store(compiler.frame)
    fn.line(f"frame[0] = {next_name}")
    fn.line("return posted")


def _constraint(compiler: BodyCompiler, step: nodes.Constraint, name: str, next_name: str) -> None:
    if isinstance(step.formula, nodes.InternalAction) and _is_called(compiler, step.formula):
        _call(compiler, step.formula, name, next_name)
        return
    fn = compiler.begin(step)
    fn.quiet = not isinstance(step.formula, nodes.InternalAction)
    with fn.writer.block(head(name)):
        fn.line("t = agent.trail")
        fn.load(compiler.frame, names_in(step))
        bound = compiler.success(fn, step.formula, next_name)
        fn.line("return FAILED")
    compiler.learn(bound)
    compiler.unit.add(fn.writer)


def _is_called(compiler: BodyCompiler, node: nodes.InternalAction) -> bool:
    """Whether an internal action is simply called, without a search."""
    action = compiler.unit.actions.get(node.name)
    return action is None or not (
        action.backtracks or action.collects or not action.takes(len(node.arguments))
    )


def _call(compiler: BodyCompiler, node: nodes.InternalAction, name: str, next_name: str) -> None:
    fn = compiler.begin(node)
    action = compiler.unit.actions.get(node.name)
    direct = None
    if action is not None and action.direct is not None:
        direct = action.direct(tuple(map(written, node.arguments)))
    with fn.writer.block(head(name)):
        fn.load(compiler.frame, names_in(node))
        if node.name == ".fail" and not node.arguments:
            fn.line("return FAILED")
        elif direct is not None:
            fn.line(f"{fn.constant(direct)}({', '.join(['agent', *(build(fn, a) for a in node.arguments)])})")
            fn.store(compiler.frame)
            fn.line(f"frame[0] = {next_name}")
        else:
            _call_by_value(compiler, fn, node, next_name)
    compiler.finish(fn)


def _call_by_value(
    compiler: BodyCompiler, fn: FunctionBuilder, node: nodes.InternalAction, next_name: str
) -> None:
    action = compiler.unit.actions.get(node.name)
    arguments = [resolved(fn, build(fn, a)) for a in node.arguments]
    call = ", ".join(["agent.context", *arguments])
    if action is not None and not action.suspends:
        fn.line(f"if {fn.constant(action.function)}({call}) is False: return FAILED")
        fn.store(compiler.frame)
        fn.line(f"frame[0] = {next_name}")
        return
    fn.store(compiler.frame)
    if action is None:
        symbol = fn.constant(functor(node.name, len(node.arguments)))
        fn.line(f"return agent.begin_act({symbol}, {tuple_of(arguments)}, (), {next_name})")
    else:
        fn.line(f"return agent.finish_call({fn.constant(action.function)}({call}), frame, {next_name})")


_HOW_ADDED = {"+>": ", True", "++": ", False, False"}


def _belief_change(compiler: BodyCompiler, step: nodes.BeliefChange, name: str, next_name: str) -> None:
    fn = compiler.begin(step)
    operand = step.operand
    with fn.writer.block(head(name)):
        fn.load(compiler.frame, names_in(step))
        if not (isinstance(operand, nodes.Literal) and _is_fixed(operand)):
            fn.line(f"posted = agent.change_mind({step.operator!r}, {build(fn, operand)})")
        else:
            _literal_change(fn, step.operator, operand)
        fn.store(compiler.frame)
        fn.line(f"frame[0] = {next_name}")
        fn.line("return posted")
    compiler.finish(fn)


def _literal_change(fn: FunctionBuilder, operator: str, operand: nodes.Literal) -> None:
    symbol = fn.constant(functor_of_literal(operand))
    annotations = "BY_SELF"
    if operand.annotations is not None:
        annotations = own_annotations(fn, operand.annotations)
    if operator in ("-", "--"):
        arguments = tuple_of([build(fn, a) for a in operand.arguments])
        fn.line(f"posted = delete_belief(agent, {symbol}, {arguments}, {annotations}, {operator == '--'})")
        return
    row = tuple_of([resolved(fn, build(fn, a)) for a in operand.arguments])
    function = "replace_belief" if operator == "-+" else "add_belief"
    fn.line(f"posted = {function}(agent, {symbol}, {row}, {annotations}{_HOW_ADDED.get(operator, '')})")


def _external(compiler: BodyCompiler, step: nodes.ExternalAction, name: str, next_name: str) -> None:
    fn = compiler.begin(step)
    action = step.action
    with fn.writer.block(head(name)):
        fn.load(compiler.frame, names_in(step))
        if isinstance(action, nodes.Literal):
            symbol = fn.constant(functor_of_literal(action))
            arguments = [resolved(fn, build(fn, a)) for a in action.arguments]
            annotations = "()"
            if action.annotations is not None:
                annotations = f"resolve_all({annotation_parts(fn, action.annotations)[0]})"
            fn.store(compiler.frame)
            call = f"agent.begin_act({symbol}, {tuple_of(arguments)}, {annotations}, {next_name})"
        else:
            value = build(fn, action)
            fn.store(compiler.frame)
            call = f"agent.run_value({value}, frame, {next_name})"
        fn.line(f"return {call}")
    compiler.finish(fn)


_STEPS: dict[type, StepWriter] = {
    nodes.Achieve: _achieve,
    nodes.Test: _test,
    nodes.Constraint: _constraint,
    nodes.BeliefChange: _belief_change,
    nodes.ExternalAction: _external,
    **STATEMENTS,
}
