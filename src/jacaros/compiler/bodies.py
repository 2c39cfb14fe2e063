"""Code for plan bodies: one step function per formula.

``step(agent, frame)`` reads from the frame what it uses, does its formula, stores what it bound and sets ``frame[0]`` to
the next step.  It returns None, or one goal (a tuple that begins with its trigger) to be handled for this intention, or
`SUSPENDED`.  A failing formula raises `Fail` before ``frame[0]`` changes, so it is known which one failed.
"""

from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any

from jacaros.asl import nodes
from jacaros.compiler.annotations import own_annotations
from jacaros.compiler.building import annotation_parts, build, functor_of_literal, resolved, tuple_of, written
from jacaros.compiler.conditions import condition, question
from jacaros.compiler.constant import Constant
from jacaros.compiler.function import Frame, FunctionBuilder, Unit
from jacaros.compiler.internal_actions import accepts
from jacaros.compiler.triggers import trigger
from jacaros.compiler.variables import names_in, nodes_in
from jacaros.terms.unifier import ATOMIC
from jacaros.terms.values import Term, functor


@dataclass
class StepInfo:
    """What is known of a step function: for failure events, inspection and copies of running plans.

    Attributes:
        node: the formula.
        next: name of the step that follows, ``"None"`` at the end.
        failure: the terms of its plain failure, once it has failed so.
    """

    node: nodes.Node
    next: str
    failure: tuple[Term, ...] | None = None


@dataclass
class BodyCompiler:
    """Writes the steps of one plan body.

    Attributes:
        infos: what is known of each step function, by its name.
    """

    unit: Unit
    frame: Frame
    prefix: str
    infos: dict[str, StepInfo] = field(default_factory=dict)
    _count: int = 0

    def body(self, steps: tuple[nodes.Step, ...], after: str) -> str:
        """Write the steps; returns the name of the first, or *after* when there are none."""
        if not steps:
            return after
        names = [self.name() for _ in steps]
        following = [*names[1:], after]
        for step, name, next_name in zip(steps, names, following, strict=True):
            self.infos[name] = StepInfo(step, next_name)
            _STEPS[type(step)](self, step, name, next_name)
        return names[0]

    def name(self) -> str:
        """A name for a step function."""
        self._count += 1
        return f"{self.prefix}_{self._count}"

    def begin(self, step: nodes.Node, *parts: nodes.Node | None) -> FunctionBuilder:
        """A builder for the function of a step; *parts* are what it evaluates."""
        fn = FunctionBuilder(self.unit)
        fn.at(step)
        return fn


def _finish(compiler: BodyCompiler, fn: FunctionBuilder) -> None:
    fn.mark_stored(compiler.frame)
    compiler.unit.add(fn.writer)


def _head(name: str) -> str:
    return f"def {name}(agent, frame):"


def _goal_expression(fn: FunctionBuilder, operator: str, kind: str, literal: nodes.Literal) -> str:
    symbol = functor_of_literal(literal)
    arguments = [build(fn, a) for a in literal.arguments]
    return tuple_of([fn.constant(trigger(operator, kind, symbol)), *arguments])


def _is_fixed(literal: nodes.Node) -> bool:
    """Whether the functor of a literal is known when the plan is compiled."""
    return isinstance(literal, nodes.Literal) and not isinstance(literal.namespace, nodes.Variable)


def _achieve(compiler: BodyCompiler, step: nodes.Achieve, name: str, next_name: str) -> None:
    fn = compiler.begin(step)
    with fn.writer.block(_head(name)):
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
    _finish(compiler, fn)


def _test(compiler: BodyCompiler, step: nodes.Test, name: str, next_name: str) -> None:
    fn = compiler.begin(step)
    formula = step.formula
    asked = isinstance(formula, (nodes.Literal, nodes.Variable))
    with fn.writer.block(_head(name)):
        fn.line("t = agent.trail")
        fn.load(compiler.frame, names_in(step))
        bound = _success(compiler, fn, formula, next_name)
        if isinstance(formula, nodes.Literal) and _is_fixed(formula):
            _test_goal(compiler, fn, formula, next_name)
        elif asked:
            fn.line(f"posted = agent.test_goal_from({build(fn, formula)})")
            fn.store(compiler.frame)
            fn.line(f"frame[0] = {next_name}")
            fn.line("return posted")
        else:
            fn.line("raise Fail")
    _learn(compiler, bound)
    if asked:
        _learn(compiler, [n for n in names_in(step) if n not in bound], "maybe")
    compiler.unit.add(fn.writer)


def _test_goal(compiler: BodyCompiler, fn: FunctionBuilder, formula: nodes.Literal, next_name: str) -> None:
    """No answer in the belief base: a plan for the test goal may find one."""
    symbol = functor_of_literal(formula)
    fn.line(f"if not agent.may_handle({fn.constant(trigger('+', '?', symbol))}): raise Fail")
    goal = _goal_expression(fn, "+", "?", formula)
    if formula.annotations is not None:
        items, tail = annotation_parts(fn, formula.annotations)
        goal = f"agent.annotated_goal({goal}, {items}, {tail})"
    fn.line(f"posted = {goal}")
    fn.store(compiler.frame)
    fn.line(f"frame[0] = {next_name}")
    fn.line("return posted")


def _success(compiler: BodyCompiler, fn: FunctionBuilder, formula: nodes.Node, next_name: str) -> list[str]:
    """Write a test whose first answer goes on to *next_name*; gives the variables that it binds."""
    bound: list[str] = []

    def then() -> None:
        fn.store(compiler.frame)
        fn.line(f"frame[0] = {next_name}")
        fn.line("return None")
        bound.extend(fn.fresh)

    condition(fn, formula, then)
    return bound


def _learn(compiler: BodyCompiler, names: list[str], state: str = "set") -> None:
    for variable in names:
        if compiler.frame.counts.get(variable, 0) > 1:
            compiler.frame.slot(variable)
            if compiler.frame.states.get(variable) != "set":
                compiler.frame.states[variable] = state


def _constraint(compiler: BodyCompiler, step: nodes.Constraint, name: str, next_name: str) -> None:
    if isinstance(step.formula, nodes.InternalAction) and _is_called(compiler, step.formula):
        _call(compiler, step.formula, name, next_name)
        return
    fn = compiler.begin(step)
    fn.quiet = not isinstance(step.formula, nodes.InternalAction)
    with fn.writer.block(_head(name)):
        fn.line("t = agent.trail")
        fn.load(compiler.frame, names_in(step))
        bound = _success(compiler, fn, step.formula, next_name)
        fn.line("raise Fail")
    _learn(compiler, bound)
    compiler.unit.add(fn.writer)


def _is_called(compiler: BodyCompiler, node: nodes.InternalAction) -> bool:
    """Whether an internal action is simply called, without a search."""
    action = compiler.unit.actions.get(node.name)
    if node.name in (".findall", ".setof", ".count"):
        return False
    return action is None or (not action.backtracks and accepts(action, len(node.arguments)))


def _call(compiler: BodyCompiler, node: nodes.InternalAction, name: str, next_name: str) -> None:
    fn = compiler.begin(node)
    action = compiler.unit.actions.get(node.name)
    direct = (
        None
        if action is None or action.direct is None
        else action.direct(tuple(map(written, node.arguments)))
    )
    with fn.writer.block(_head(name)):
        fn.load(compiler.frame, names_in(node))
        if direct is not None:
            fn.line(f"{fn.constant(direct)}({', '.join(['agent', *(build(fn, a) for a in node.arguments)])})")
            fn.store(compiler.frame)
            fn.line(f"frame[0] = {next_name}")
            _finish(compiler, fn)
            return
        arguments = [resolved(fn, build(fn, a)) for a in node.arguments]
        if action is None:
            symbol = fn.constant(functor(node.name, len(node.arguments)))
            fn.store(compiler.frame)
            fn.line(f"return agent.begin_act({symbol}, {tuple_of(arguments)}, (), {next_name})")
        else:
            call = ", ".join(["agent.context", *arguments])
            if action.suspends:
                fn.store(compiler.frame)
                fn.line(
                    f"return agent.finish_call({fn.constant(action.function)}({call}), frame, {next_name})"
                )
            else:
                fn.line(f"if {fn.constant(action.function)}({call}) is False: raise Fail")
                fn.store(compiler.frame)
                fn.line(f"frame[0] = {next_name}")
    _finish(compiler, fn)


_ADDITIONS = {
    "+": "add_belief",
    "+<": "add_belief",
    "+>": "add_belief_last",
    "++": "add_belief_apart",
    "-+": "replace_belief",
    "-++": "add_belief_apart",
}


def _belief_change(compiler: BodyCompiler, step: nodes.BeliefChange, name: str, next_name: str) -> None:
    fn = compiler.begin(step)
    operand = step.operand
    with fn.writer.block(_head(name)):
        fn.load(compiler.frame, names_in(step))
        if not (isinstance(operand, nodes.Literal) and _is_fixed(operand)):
            fn.line(f"posted = agent.change_mind({step.operator!r}, {build(fn, operand)})")
        else:
            _literal_change(fn, step.operator, operand)
        fn.store(compiler.frame)
        fn.line(f"frame[0] = {next_name}")
        fn.line("return posted")
    _finish(compiler, fn)


def _literal_change(fn: FunctionBuilder, operator: str, operand: nodes.Literal) -> None:
    symbol = fn.constant(functor_of_literal(operand))
    annotations = "BY_SELF"
    if operand.annotations is not None:
        annotations = own_annotations(fn, operand.annotations)
    if operator in ("-", "--"):
        arguments = tuple_of([build(fn, a) for a in operand.arguments]) if operand.arguments else "()"
        fn.line(f"posted = agent.delete_belief({symbol}, {arguments}, {annotations}, {operator == '--'})")
        return
    row = tuple_of([resolved(fn, build(fn, a)) for a in operand.arguments]) if operand.arguments else "()"
    if operator == "-++":
        fn.line(f"row = {row}")
        fn.line(f"agent.delete_any({symbol}, {annotations})")
        row = "row"
    method = _ADDITIONS[operator]
    fn.line(f"posted = agent.{method}({symbol}, {row}, {annotations})")


def _external(compiler: BodyCompiler, step: nodes.ExternalAction, name: str, next_name: str) -> None:
    fn = compiler.begin(step)
    action = step.action
    with fn.writer.block(_head(name)):
        fn.load(compiler.frame, names_in(step))
        if isinstance(action, nodes.Literal):
            symbol = fn.constant(functor_of_literal(action))
            arguments = [resolved(fn, build(fn, a)) for a in action.arguments]
            annotations = "()"
            if action.annotations is not None:
                annotations = f"resolve_all({annotation_parts(fn, action.annotations)[0]})"
            fn.store(compiler.frame)
            call = f"agent.begin_act({symbol}, {tuple_of(arguments) if arguments else '()'}, {annotations}, {next_name})"
        else:
            value = build(fn, action)
            fn.store(compiler.frame)
            call = f"agent.run_value({value}, frame, {next_name})"
        fn.line(f"return {call}")
    _finish(compiler, fn)


# --- control statements ------------------------------------------------------------------------------------


def _if(compiler: BodyCompiler, step: nodes.If, name: str, next_name: str) -> None:
    then_name, else_name = compiler.name(), compiler.name()
    has_else = step.otherwise is not None and bool(step.otherwise.steps)
    fn = compiler.begin(step)
    first_then = then_name if step.then.steps else next_name
    first_else = else_name if has_else else next_name
    with fn.writer.block(_head(name)):
        fn.line("t = agent.trail")
        fn.load(compiler.frame, names_in(step.condition))
        bound = _success(compiler, fn, step.condition, first_then)
        fn.line("if t: undo(t, 0)")
        fn.line(f"frame[0] = {first_else}")
    compiler.unit.add(fn.writer)
    before = dict(compiler.frame.states)
    _learn(compiler, bound)
    _branch_body(compiler, step.then, then_name, next_name)
    after_then = dict(compiler.frame.states)
    compiler.frame.states = dict(before)
    if has_else:
        assert step.otherwise is not None
        _branch_body(compiler, step.otherwise, else_name, next_name)
    compiler.frame.states = _joined(after_then, compiler.frame.states)


def _clear_inner(
    compiler: BodyCompiler, fn: FunctionBuilder, step: nodes.Node, entry: dict[str, str]
) -> None:
    """Variables that get their first value inside a loop have none at the beginning of a round nor after the loop."""
    for variable in names_in(step):
        if variable not in entry and compiler.frame.counts.get(variable, 0) > 1:
            fn.line(f"frame[{compiler.frame.slot(variable)}] = None")


def _joined(left: dict[str, str], right: dict[str, str]) -> dict[str, str]:
    """What is known after either of two branches."""
    return {
        name: "set" if left.get(name) == right.get(name) == "set" else "maybe"
        for name in dict.fromkeys([*left, *right])
    }


def _branch_body(compiler: BodyCompiler, body: nodes.Body, first: str, after: str) -> None:
    """Write the steps of a branch, the first one under a name that is already used."""
    if not body.steps:
        return
    rest = [compiler.name() for _ in body.steps[1:]]
    names = [first, *rest]
    for step, name, next_name in zip(body.steps, names, [*rest, after], strict=True):
        compiler.infos[name] = StepInfo(step, next_name)
        _STEPS[type(step)](compiler, step, name, next_name)


def _free_at_entry(compiler: BodyCompiler) -> list[str]:
    """Variables that a loop has to give back as they were: those that may hold a `Var` at its beginning."""
    return [name for name, state in compiler.frame.states.items() if state]


def _enter_loop(compiler: BodyCompiler, fn: FunctionBuilder, step: nodes.Node) -> int:
    """Remember which variables are free before a loop; returns the slot where."""
    frame = compiler.frame
    names = _free_at_entry(compiler)
    fn.load(frame, names)
    slot = frame.hidden_slot()
    # `free_variables` takes the first element of a tuple for a functor.
    # Variables that a body made at run time shares with its plan.
    shared = [fn.constant(c.value) for c in nodes_in(Constant, step) if c.value.__class__ not in ATOMIC]
    values = tuple_of(["None", *(f"frame[{frame.slot(n)}]" for n in names), *shared])
    test = "True" if shared else _any_open(frame, names)
    fn.line(f"frame[{slot}] = free_variables({values}) if {test} else None")
    return slot


def _any_open(frame: Frame, names: list[str]) -> str:
    """A test whether any of the variables may hold something unbound."""
    tests = [f"frame[{frame.slot(n)}].__class__ not in ATOMIC" for n in names]
    return " or ".join(tests) if tests else "False"


def _while(compiler: BodyCompiler, step: nodes.While, name: str, next_name: str) -> None:
    frame = compiler.frame
    test_name, first = compiler.name(), compiler.name()
    enter = compiler.begin(step)
    with enter.writer.block(_head(name)):
        slot = _enter_loop(compiler, enter, step)
        enter.line(f"return {test_name}(agent, frame)")
    compiler.unit.add(enter.writer)
    entry = dict(frame.states)
    compiler.infos[test_name] = StepInfo(step, next_name)
    fn = compiler.begin(step)
    with fn.writer.block(_head(test_name)):
        fn.line("t = agent.trail")
        fn.line(f"if frame[{slot}]: release(frame[{slot}])")
        _clear_inner(compiler, fn, step, entry)
        fn.load(frame, names_in(step.condition))
        bound = _success(compiler, fn, step.condition, first if step.body.steps else test_name)
        fn.line("if t: undo(t, 0)")
        fn.line(f"frame[0] = {next_name}")
    compiler.unit.add(fn.writer)
    _learn(compiler, bound)
    _branch_body(compiler, step.body, first, test_name)
    frame.states = entry


def _for(compiler: BodyCompiler, step: nodes.For, name: str, next_name: str) -> None:
    frame = compiler.frame
    round_name, first = compiler.name(), compiler.name()
    answers = frame.hidden_slot()
    enter = compiler.begin(step)
    enter.snapshot = True
    with enter.writer.block(_head(name)):
        slot = _enter_loop(compiler, enter, step)
        enter.line("t = Trail()")
        enter.line("t.serial = agent.trail.serial")
        new = [n for n in names_in(step.condition) if n not in enter.values]
        used = [n for n in new if frame.counts.get(n, 0) > 1]
        call = question(enter, step.condition, used)
        enter.line(f"frame[{answers}] = Remaining({call})")
        enter.line(f"return {round_name}(agent, frame)")
    compiler.unit.add(enter.writer)
    entry = dict(frame.states)
    compiler.infos[round_name] = StepInfo(step, next_name)
    fn = compiler.begin(step)
    with fn.writer.block(_head(round_name)):
        fn.line(f"if frame[{slot}]: release(frame[{slot}])")
        _clear_inner(compiler, fn, step, entry)
        own = frame.hidden_slot() if used else None
        if own is not None:
            fn.line(f"if frame[{own}]: release(frame[{own}])")
        targets = tuple_of([f"frame[{frame.slot(n)}]" for n in used]) if used else "_"
        with fn.writer.block(f"for {targets} in frame[{answers}]:"):
            if own is not None:
                values = tuple_of(["None", *(f"frame[{frame.slot(n)}]" for n in used)])
                fn.line(f"frame[{own}] = free_variables({values}) if {_any_open(frame, used)} else None")
            fn.line(f"frame[0] = {first if step.body.steps else round_name}")
            fn.line("return None")
        fn.line(f"frame[{answers}] = None")
        fn.line(f"frame[0] = {next_name}")
    compiler.unit.add(fn.writer)
    _learn(compiler, used)
    _branch_body(compiler, step.body, first, round_name)
    frame.states = entry


def _fork(compiler: BodyCompiler, step: nodes.Fork, name: str, next_name: str) -> None:
    frame = compiler.frame
    names = [compiler.name() for _ in step.branches]
    fn = compiler.begin(step)
    with fn.writer.block(_head(name)):
        firsts = [n if b.steps else "join_branch" for n, b in zip(names, step.branches, strict=True)]
        fn.line(f"return agent.fork({step.operator!r}, frame, {tuple_of(firsts)}, {next_name})")
    compiler.unit.add(fn.writer)
    before = dict(frame.states)
    joined = dict(before)
    for branch_name, branch in zip(names, step.branches, strict=True):
        frame.states = dict(before)
        _branch_body(compiler, branch, branch_name, "join_branch")
        for variable in frame.states:
            joined.setdefault(variable, "maybe")
    frame.states = joined


_STEPS: dict[type, Callable[[BodyCompiler, Any, str, str], None]] = {
    nodes.Achieve: _achieve,
    nodes.Test: _test,
    nodes.Constraint: _constraint,
    nodes.BeliefChange: _belief_change,
    nodes.ExternalAction: _external,
    nodes.If: _if,
    nodes.While: _while,
    nodes.For: _for,
    nodes.Fork: _fork,
}
