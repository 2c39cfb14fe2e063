"""A unit of generated code: the functions of one event kind or rule, before they are executed."""

from collections.abc import Mapping, Sequence
from itertools import groupby
from types import CodeType
from typing import Any, NamedTuple

from jacaros.agents.language import nodes
from jacaros.agents.mind.actions.internal_action import InternalAction
from jacaros.agents.mind.generated import runtime
from jacaros.agents.mind.generated.bodies import body_compiler
from jacaros.agents.mind.generated.function import FrameLayout, Writer, compile_all
from jacaros.agents.mind.generated.selection import (
    SelectCompiler,
    compile_goal_condition,
    compile_rule,
    compile_search,
)
from jacaros.agents.mind.state.plan import Plan, StepInfo
from jacaros.agents.mind.state.triggers import Trigger
from jacaros.agents.terms.values import Functor, String, Term


class CodeUnit:
    """Collects functions and constants.

    Attributes:
        actions: the internal actions known at compile time.
        globals: the names that the functions use.
        writers: the functions.
    """

    def __init__(self, filename: str, actions: Mapping[str, InternalAction]) -> None:
        self.filename = filename
        self.actions = actions
        self.globals: dict[str, Any] = dict(runtime.NAMES)
        self.writers: list[Writer] = []
        self._constants: dict[Any, str] = {}
        self._count = 0

    def constant(self, value: Term) -> str:
        """A global name for a value; equal values share it."""
        key: Any = value if value.__class__ in (Functor, Trigger) else (value.__class__, id(value))
        if value.__class__ in (String, float, int):
            key = (value.__class__, value)
        name = self._constants.get(key)
        if name is None:
            name = self._constants[key] = f"{_prefix(value)}_{len(self._constants)}"
            self.globals[name] = value
        return name

    def add(self, writer: Writer) -> None:
        """Make a finished function part of the unit."""
        writer.prune()
        self.writers.append(writer)

    def fresh_function(self, prefix: str) -> str:
        """A name for another function."""
        self._count += 1
        return f"{prefix}{self._count}"

    def code(self) -> list[CodeType]:
        """Compile what has been written.  A code object has but one file, and plans may be included."""
        return [compile_all(writers, filename) for filename, writers in groupby(self.writers, self._file_of)]

    def _file_of(self, writer: Writer) -> str:
        file = writer.files[0]
        return self.filename if file is None else file.name


def _prefix(value: Term) -> str:
    name = getattr(value, "name", None) or getattr(value, "__name__", None) or value.__class__.__name__
    text = "".join(c if c.isalnum() and c.isascii() else "_" for c in str(name))
    return f"K_{text}"


class Body(NamedTuple):
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


class Written(NamedTuple):
    """A unit that has been written, and what its functions are for.

    Attributes:
        unit: holds the code.
        name: of the function that others call.
        bodies: of the plans that it chooses among.
        conditions: of each plan that has one, the name of the test of its goal condition.
    """

    unit: CodeUnit
    name: str
    bodies: Sequence[Body] = ()
    conditions: Sequence[tuple[Plan, str]] = ()


def write_select(
    trigger: Trigger,
    plans: Sequence[Plan],
    actions: Mapping[str, InternalAction],
    outer: Plan | None = None,
    every: bool = False,
) -> Written:
    """Write the select function of an event kind; *outer* is the plan that sub-plans belong to.

    With *every* it is a generator of the frames of all applicable plans.
    """
    unit = CodeUnit(plans[0].file, actions)
    compiler = SelectCompiler(unit, trigger.functor.arity, every)
    name = compiler.select(plans, outer)
    conditions = [
        (plan, compile_goal_condition(unit, plan)) for plan in plans if plan.node.goal_condition is not None
    ]
    bodies = [Body(plan, first, body.frame.size, body.infos) for plan, body, first in compiler.bodies]
    return Written(unit, name, bodies, conditions)


def write_body(plan: Plan, actions: Mapping[str, InternalAction]) -> Written:
    """Write the steps of a plan that stands for a body made at run time."""
    unit = CodeUnit("<body>", actions)
    compiler = body_compiler(unit, FrameLayout(plan), "step")
    body = plan.node.body
    assert isinstance(body, nodes.Body)
    first = compiler.body(body.steps, "None")
    return Written(unit, first, [Body(plan, first, compiler.frame.size, compiler.infos)])


def write_search(
    symbol: Functor,
    pattern: int,
    before: Sequence[nodes.Rule],
    after: Sequence[nodes.Rule],
    actions: Mapping[str, InternalAction],
    trampoline: bool,
) -> Written:
    """Write the generator function of a predicate for one pattern of use, see `jacaros.agents.mind.generated.selection`."""
    unit = CodeUnit(_file_of((*before, *after)[0]), actions)
    return Written(unit, compile_search(unit, symbol, pattern, before, after, trampoline))


def write_rule(rule: nodes.Rule, actions: Mapping[str, InternalAction]) -> Written:
    """Write the generator function of a rule."""
    unit = CodeUnit(_file_of(rule), actions)
    return Written(unit, compile_rule(unit, rule))


def _file_of(rule: nodes.Rule) -> str:
    return rule.span.file.name if rule.span is not None else "<run time>"
