"""Code for plan bodies: one step function per formula.

``step(agent, frame)`` reads the variables that it uses from the frame, runs its formula, stores its bindings and sets
``frame[0]`` to the next step. It returns None, or one goal (a tuple that begins with its trigger) to be handled for this
intention, or `SUSPENDED`. A failing formula returns `FAILED`, or raises `Fail` or another exception, before ``frame[0]``
changes, so the failed step is known.
"""

from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from typing import Any, TypeGuard

from jacaros.agents.language import nodes
from jacaros.agents.language.nodes import names_in, nodes_in
from jacaros.agents.mind.actions.internal_action import InternalAction
from jacaros.agents.mind.generated.conditions import condition, question
from jacaros.agents.mind.generated.function import CodeUnit, FrameLayout, FunctionBuilder
from jacaros.agents.mind.generated.matching import (
    annotation_parts,
    build,
    functor_of_literal,
    own_annotations,
    resolved,
    tuple_of,
    written,
)
from jacaros.agents.mind.state.plan import StepInfo
from jacaros.agents.mind.state.triggers import trigger
from jacaros.agents.terms.substitution import ATOMIC
from jacaros.agents.terms.values import functor


class BodyCompiler:
    """Writes the steps of one plan body; *prefix* is how the names of its step functions begin.

    Attributes:
        infos: what is known of each step function, by its name.
    """

    def __init__(self, unit: CodeUnit, frame: FrameLayout, prefix: str) -> None:
        self.unit, self.frame, self.prefix = unit, frame, prefix
        self.infos: dict[str, StepInfo] = {}
        self._count = 0

    def body(self, steps: Sequence[nodes.Step], after: str) -> str:
        """Write the steps; return the name of the first, or *after* without any."""
        if not steps:
            return after
        first = self._name()
        self._branch(steps, first, after)
        return first

    def _branch(self, steps: Sequence[nodes.Step], first: str, after: str) -> None:
        """Write the steps, the first one under a name that is already used."""
        if not steps:
            return
        rest = [self._name() for _ in steps[1:]]
        for step, name, next_name in zip(steps, [first, *rest], [*rest, after], strict=True):
            self.infos[name] = StepInfo(step, next_name)
            _WRITERS[type(step)](self, step, name, next_name)

    def _name(self) -> str:
        self._count += 1
        return f"{self.prefix}_{self._count}"

    @contextmanager
    def _function(self, name: str, step: nodes.Node) -> Iterator[FunctionBuilder]:
        fn = FunctionBuilder(self.unit)
        fn.at(step)
        with fn.function(name, "agent", "frame"):
            yield fn

    def _go_on(self, fn: FunctionBuilder, next_name: str) -> None:
        """Write what follows a success: bindings are stored, and the next step is set."""
        fn.store(self.frame)
        fn.line(f"frame[0] = {next_name}")

    def _success(self, fn: FunctionBuilder, formula: nodes.Node, next_name: str) -> list[str]:
        """Write a test whose first answer continues with *next_name*; return the variables that it binds."""
        bound: list[str] = []

        def then() -> None:
            self._go_on(fn, next_name)
            fn.line("return None")
            bound.extend(fn.fresh)

        condition(fn, formula, then)
        return bound

    def _learn(self, names: Sequence[str], state: str = "set") -> None:
        """Take note that variables have a value from now on, or ``maybe`` have one."""
        for variable in names:
            if variable in self.frame.slots and self.frame.states.get(variable) != "set":
                self.frame.states[variable] = state

    # --- control statements: ``if``, ``while``, ``for`` and the two ways to fork ---------------------------------
    # A variable that gets its value on one branch only may have none afterwards; what a round of a loop binds, the next
    # round finds unbound.

    def if_(self, step: nodes.If, name: str, next_name: str) -> None:
        """``if (c) {..} else {..}``."""
        then_name, else_name = self._name(), self._name()
        otherwise = () if step.otherwise is None else step.otherwise.steps
        with self._function(name, step) as fn:
            fn.line("t = agent.trail")
            fn.load(self.frame, names_in(step.condition))
            bound = self._success(fn, step.condition, then_name if step.then.steps else next_name)
            fn.line("if t: undo(t, 0)")
            fn.line(f"frame[0] = {else_name if otherwise else next_name}")
        before = dict(self.frame.states)
        self._learn(bound)
        self._branch(step.then.steps, then_name, next_name)
        after_then, self.frame.states = self.frame.states, before
        self._branch(otherwise, else_name, next_name)
        self.frame.states = _joined(after_then, self.frame.states)

    def while_(self, step: nodes.While, name: str, next_name: str) -> None:
        """``while (c) {..}``."""
        frame = self.frame
        test_name, first = self._name(), self._name()
        with self._function(name, step) as fn:
            loop = self._enter_loop(fn, step)
            fn.line(f"return {test_name}(agent, frame)")
        entry = dict(frame.states)
        self.infos[test_name] = StepInfo(step, next_name)
        with self._function(test_name, step) as fn:
            fn.line("t = agent.trail")
            self._begin_round(fn, step, loop)
            fn.load(frame, names_in(step.condition))
            bound = self._success(fn, step.condition, first if step.body.steps else test_name)
            fn.line("if t: undo(t, 0)")
            fn.line(f"frame[0] = {next_name}")
        self._learn(bound)
        self._branch(step.body.steps, first, test_name)
        frame.states = entry

    def for_(self, step: nodes.For, name: str, next_name: str) -> None:
        """``for (c) {..}``."""
        frame = self.frame
        round_name, first = self._name(), self._name()
        with self._function(name, step) as fn:
            fn.snapshot = True
            loop = self._enter_loop(fn, step)
            fn.line("t = Trail()")
            fn.line("t.serial = agent.trail.serial")
            used = [n for n in names_in(step.condition) if n not in fn.values and n in frame.slots]
            fn.line(f"frame[{loop}].answers = Remaining({question(fn, step.condition, used)})")
            fn.line(f"return {round_name}(agent, frame)")
        entry = dict(frame.states)
        self.infos[round_name] = StepInfo(step, next_name)
        with self._function(round_name, step) as fn:
            self._begin_round(fn, step, loop)
            if used:
                fn.line("if loop.round: release(loop.round)")
            targets = tuple_of([f"frame[{frame.slots[n]}]" for n in used]) if used else "_"
            with fn.block(f"for {targets} in loop.answers:"):
                if used:
                    values = tuple_of(["None", *(f"frame[{frame.slots[n]}]" for n in used)])
                    fn.line(f"loop.round = free_variables({values}) if {_any_open(frame, used)} else ()")
                fn.line(f"frame[0] = {first if step.body.steps else round_name}")
                fn.line("return None")
            fn.line(f"frame[{loop}] = None")
            fn.line(f"frame[0] = {next_name}")
        self._learn(used)
        self._branch(step.body.steps, first, round_name)
        frame.states = entry

    def _begin_round(self, fn: FunctionBuilder, step: nodes.Node, loop: int) -> None:
        """What `Loop.begin_round` does, but for the variables that the last round of a ``for`` brought."""
        fn.line(f"loop = frame[{loop}]")
        fn.line("if loop.free: release(loop.free)")
        for place in self._inner(step):
            fn.line(f"frame[{place}] = None")

    def _inner(self, step: nodes.Node) -> list[int]:
        """Places of the variables that get their first value inside a loop: they have none when a round begins."""
        frame = self.frame
        return [frame.slots[n] for n in names_in(step) if n not in frame.states and n in frame.slots]

    def _enter_loop(self, fn: FunctionBuilder, step: nodes.Node) -> int:
        """Remember which variables are free before a loop; returns the place of the `Loop`."""
        frame = self.frame
        names = [name for name, state in frame.states.items() if state]  # those that may hold a `Var`
        fn.load(frame, names)
        loop = frame.hidden_slot()
        # `free_variables` takes the first element of a tuple for a functor.
        # Variables that a body made at run time shares with its plan.
        shared = [
            fn.constant(c.value) for c in nodes_in(nodes.Constant, step) if c.value.__class__ not in ATOMIC
        ]
        values = tuple_of(["None", *(f"frame[{frame.slots[n]}]" for n in names), *shared])
        test = "True" if shared else _any_open(frame, names)
        inner = tuple_of([str(place) for place in self._inner(step)])
        fn.line(f"frame[{loop}] = Loop(free_variables({values}) if {test} else (), {inner})")
        return loop

    def fork(self, step: nodes.Fork, name: str, next_name: str) -> None:
        """``a |&| b`` and ``a ||| b``."""
        frame = self.frame
        names = [self._name() for _ in step.branches]
        with self._function(name, step) as fn:
            firsts = [n if b.steps else "join_branch" for n, b in zip(names, step.branches, strict=True)]
            fn.line(f"return agent.fork({step.operator!r}, frame, {tuple_of(firsts)}, {next_name})")
        before = dict(frame.states)
        joined = dict(before)
        for branch_name, branch in zip(names, step.branches, strict=True):
            frame.states = dict(before)
            self._branch(branch.steps, branch_name, "join_branch")
            for variable in frame.states:
                joined.setdefault(variable, "maybe")
        frame.states = joined

    # --- other steps ---------------------------------------------------------------------------------------------

    def achieve(self, step: nodes.Achieve, name: str, next_name: str) -> None:
        """``!g`` and ``!!g``."""
        goal = step.goal
        with self._function(name, step) as fn:
            fn.load(self.frame, names_in(step))
            if _is_fixed(goal):
                posted = _goal(fn, "!", goal, step.separate)
            else:
                posted = f'agent.goal_from("+", "!", {build(fn, goal)}, {step.separate})'
            if step.separate:
                fn.line(f"agent.post_separate({posted})")
            elif "agent." in posted:
                fn.line(f"posted = {posted}")
            self._go_on(fn, next_name)
            if not step.separate:
                fn.line(f"return {'posted' if 'agent.' in posted else posted}")
        self._learn(fn.fresh)

    def test(self, step: nodes.Test, name: str, next_name: str) -> None:
        """``?g``: without an answer in the belief base, a plan for the test goal may find one."""
        formula = step.formula
        asked = isinstance(formula, (nodes.Literal, nodes.Variable))
        with self._function(name, step) as fn:
            fn.line("t = agent.trail")
            fn.load(self.frame, names_in(step))
            if isinstance(formula, nodes.Variable):
                goal = build(fn, formula)
                fn.line(
                    f"if bare({goal}).__class__ is Var: agent.test_goal_from({goal})  # raises the failure"
                )
            bound = self._success(fn, formula, next_name)
            if asked and _is_fixed(formula):
                kind = fn.constant(trigger("+", "?", functor_of_literal(formula)))
                fn.line(f"if not agent.may_test({kind}): return FAILED")
                fn.line(f"posted = {_goal(fn, '?', formula)}")
            elif asked:
                fn.line(f"posted = agent.test_goal_from({build(fn, formula)})")
            if asked:
                self._go_on(fn, next_name)
            fn.line("return posted" if asked else "return FAILED")
        self._learn(bound)
        if asked:
            self._learn([n for n in names_in(step) if n not in bound], "maybe")

    def constraint(self, step: nodes.Constraint, name: str, next_name: str) -> None:
        """A condition, or an internal action."""
        formula = step.formula
        if isinstance(formula, nodes.InternalAction):
            action = self.unit.actions.get(formula.name)
            searches = action is not None and (
                action.backtracks or action.collects or not action.takes(len(formula.arguments))
            )
            if not searches:
                self._call(formula, action, name, next_name)
                return
        with self._function(name, step) as fn:
            fn.quiet = not isinstance(formula, nodes.InternalAction)
            fn.line("t = agent.trail")
            fn.load(self.frame, names_in(step))
            bound = self._success(fn, formula, next_name)
            fn.line("return FAILED")
        self._learn(bound)

    def _call(
        self, node: nodes.InternalAction, action: InternalAction | None, name: str, next_name: str
    ) -> None:
        """Call an internal action, without a search."""
        direct = None
        if action is not None and action.direct is not None:
            direct = action.direct(tuple(map(written, node.arguments)))
        with self._function(name, node) as fn:
            fn.load(self.frame, names_in(node))
            if node.name == ".fail" and not node.arguments:
                fn.line("return FAILED")
            elif direct is not None:
                arguments = ["agent", *(build(fn, a) for a in node.arguments)]
                fn.line(f"{fn.constant(direct)}({', '.join(arguments)})")
                self._go_on(fn, next_name)
            else:
                self._call_by_value(fn, node, action, next_name)
        self._learn(fn.fresh)

    def _call_by_value(
        self, fn: FunctionBuilder, node: nodes.InternalAction, action: InternalAction | None, next_name: str
    ) -> None:
        arguments = [resolved(fn, build(fn, a)) for a in node.arguments]
        if action is None:
            fn.store(self.frame)
            symbol = fn.constant(functor(node.name, len(arguments)))
            fn.line(f"return agent.begin_act({symbol}, {tuple_of(arguments)}, (), {next_name})")
            return
        call = f"{fn.constant(action.function)}({', '.join(['agent.context', *arguments])})"
        if action.suspends:
            fn.store(self.frame)
            fn.line(f"return agent.finish_call({call}, frame, {next_name})")
        else:
            fn.line(f"if {call} is False: return FAILED")
            self._go_on(fn, next_name)

    def belief_change(self, step: nodes.BeliefChange, name: str, next_name: str) -> None:
        """``+b``, ``-b``, ``-+b`` and the like."""
        operand = step.operand
        with self._function(name, step) as fn:
            fn.load(self.frame, names_in(step))
            if _is_fixed(operand):
                fn.line(f"posted = {_literal_change(fn, step.operator, operand)}")
            else:
                fn.line(f"posted = agent.change_mind({step.operator!r}, {build(fn, operand)})")
            self._go_on(fn, next_name)
            fn.line("return posted")
        self._learn(fn.fresh)

    def external(self, step: nodes.ExternalAction, name: str, next_name: str) -> None:
        """An action of the environment, or what a variable stands for."""
        action = step.action
        with self._function(name, step) as fn:
            fn.load(self.frame, names_in(step))
            if _is_fixed(action):
                symbol = fn.constant(functor_of_literal(action))
                arguments = tuple_of([resolved(fn, build(fn, a)) for a in action.arguments])
                annotations = "()"
                if action.annotations is not None:
                    annotations = f"resolve_all({annotation_parts(fn, action.annotations)[0]})"
                call = f"begin_act({symbol}, {arguments}, {annotations}, {next_name})"
            else:
                call = f"run_value({build(fn, action)}, frame, {next_name})"
            fn.store(self.frame)
            fn.line(f"return agent.{call}")
        self._learn(fn.fresh)


def _joined(left: dict[str, str], right: dict[str, str]) -> dict[str, str]:
    """What is known after either of two branches."""
    return {
        name: "set" if left.get(name) == right.get(name) == "set" else "maybe"
        for name in dict.fromkeys([*left, *right])
    }


def _any_open(frame: FrameLayout, names: list[str]) -> str:
    """A test whether any of the variables may hold something unbound."""
    tests = [f"frame[{frame.slots[n]}].__class__ not in ATOMIC" for n in names]
    return " or ".join(tests) if tests else "False"


def _is_fixed(literal: nodes.Node) -> TypeGuard[nodes.Literal]:
    """Whether the functor of a literal is known when the plan is compiled."""
    return isinstance(literal, nodes.Literal) and not isinstance(literal.namespace, nodes.Variable)


def _goal(fn: FunctionBuilder, kind: str, literal: nodes.Literal, separate: bool = False) -> str:
    symbol = fn.constant(trigger("+", kind, functor_of_literal(literal)))
    goal = tuple_of([symbol, *(build(fn, a) for a in literal.arguments)])
    if literal.annotations is None:
        return goal
    items, tail = annotation_parts(fn, literal.annotations)
    return f"agent.annotated_goal({goal}, {items}, {tail}, {separate})"


_HOW_ADDED = {"+>": ", True", "++": ", False, False"}


def _literal_change(fn: FunctionBuilder, operator: str, operand: nodes.Literal) -> str:
    symbol = fn.constant(functor_of_literal(operand))
    annotations = "BY_SELF" if operand.annotations is None else own_annotations(fn, operand.annotations)
    if operator in ("-", "--"):
        arguments = tuple_of([build(fn, a) for a in operand.arguments])
        return f"delete_belief(agent, {symbol}, {arguments}, {annotations}, {operator == '--'})"
    row = tuple_of([resolved(fn, build(fn, a)) for a in operand.arguments])
    function = "replace_belief" if operator == "-+" else "add_belief"
    return f"{function}(agent, {symbol}, {row}, {annotations}{_HOW_ADDED.get(operator, '')})"


_WRITERS: dict[type, Callable[[BodyCompiler, Any, str, str], None]] = {
    nodes.Achieve: BodyCompiler.achieve,
    nodes.Test: BodyCompiler.test,
    nodes.Constraint: BodyCompiler.constraint,
    nodes.BeliefChange: BodyCompiler.belief_change,
    nodes.ExternalAction: BodyCompiler.external,
    nodes.If: BodyCompiler.if_,
    nodes.While: BodyCompiler.while_,
    nodes.For: BodyCompiler.for_,
    nodes.Fork: BodyCompiler.fork,
}
"""Writes one step: given the step, the name of its function and the name of the next one."""
