"""Code for plan bodies: one step function per formula.

``step(agent, frame)`` reads the variables that it uses from the frame, runs its formula, stores its bindings and sets
``frame[0]`` to the next step. It returns None, or one goal (a tuple that begins with its trigger) to be handled for this
intention, or `SUSPENDED`. A failing formula returns `FAILED`, or raises `Fail` or another exception, before ``frame[0]``
changes, so the failed step is known.
"""

from jacaros.asl import nodes
from jacaros.asl.walk import names_in
from jacaros.bdi.fast.generated.annotations import own_annotations
from jacaros.bdi.fast.generated.body_compiler import BodyCompiler, StepWriter, head
from jacaros.bdi.fast.generated.building import (
    annotation_parts,
    build,
    functor_of_literal,
    resolved,
    tuple_of,
    written,
)
from jacaros.bdi.fast.generated.control_statements import STATEMENTS
from jacaros.bdi.fast.generated.function import FrameLayout, FunctionBuilder, Unit
from jacaros.bdi.state.triggers import trigger
from jacaros.terms.values import functor


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
    direct = (
        None
        if action is None or action.direct is None
        else action.direct(tuple(map(written, node.arguments)))
    )
    with fn.writer.block(head(name)):
        fn.load(compiler.frame, names_in(node))
        if direct is not None:
            function = fn.constant(direct)
            fn.line(f"{function}({', '.join(['agent', *(build(fn, a) for a in node.arguments)])})")
            fn.store(compiler.frame)
            fn.line(f"frame[0] = {next_name}")
            compiler.finish(fn)
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
                fn.line(f"if {fn.constant(action.function)}({call}) is False: return FAILED")
                fn.store(compiler.frame)
                fn.line(f"frame[0] = {next_name}")
    compiler.finish(fn)


_ADDITIONS = {
    "+": "add_belief(agent, ",
    "+<": "add_belief(agent, ",
    "+>": "agent.add_belief_last(",
    "++": "agent.add_belief_apart(",
    "-+": "replace_belief(agent, ",
}


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
        arguments = tuple_of([build(fn, a) for a in operand.arguments]) if operand.arguments else "()"
        fn.line(f"posted = delete_belief(agent, {symbol}, {arguments}, {annotations}, {operator == '--'})")
        return
    row = tuple_of([resolved(fn, build(fn, a)) for a in operand.arguments]) if operand.arguments else "()"
    fn.line(f"posted = {_ADDITIONS[operator]}{symbol}, {row}, {annotations})")


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
            call = f"agent.begin_act({symbol}, {tuple_of(arguments) if arguments else '()'}, {annotations}, {next_name})"
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
