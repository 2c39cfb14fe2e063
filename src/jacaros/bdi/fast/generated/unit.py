"""A unit of generated code: the functions of one event kind or rule, made real."""

from collections.abc import Mapping, Sequence
from itertools import groupby
from types import FunctionType
from typing import Any, NamedTuple

from jacaros.asl import nodes
from jacaros.bdi.actions.internal_action import InternalAction
from jacaros.bdi.fast.generated import runtime
from jacaros.bdi.fast.generated.body_compiler import BodyCompiler
from jacaros.bdi.fast.generated.predicates import compile_search
from jacaros.bdi.fast.generated.selection import SelectCompiler, compile_goal_condition, compile_rule
from jacaros.bdi.fast.generated.writer import Writer, compile_all
from jacaros.bdi.state.engine import Select
from jacaros.bdi.state.plan import Plan
from jacaros.bdi.state.triggers import Trigger
from jacaros.terms.values import Functor, String, Term


class CodeUnit:
    """Collects functions and constants, and executes the code.

    Attributes:
        actions: the internal actions known at compile time.
        source: the text of everything generated, for people.
        writers: what has been written and not been executed yet.
    """

    def __init__(self, filename: str, actions: Mapping[str, InternalAction]) -> None:
        self.filename = filename
        self.actions = actions
        self.globals: dict[str, Any] = dict(runtime.NAMES)
        self.source: list[str] = []
        self.writers: list[Writer] = []
        self._constants: dict[Any, str] = {}
        self._count = 0

    def constant(self, value: Term) -> str:
        """A global name for a value; equal values share it."""
        key: Any = value if value.__class__ in (Functor, Trigger) else (value.__class__, id(value))
        if value.__class__ in (String, float):
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
        self.source.append(writer.text())

    def fresh_function(self, prefix: str) -> str:
        """A name for another function."""
        self._count += 1
        return f"{prefix}{self._count}"

    def execute(self) -> None:
        """Make the functions: afterwards they are in `globals`."""
        # A code object has but one file, and plans may be included.
        for filename, writers in groupby(self.writers, self._file_of):
            exec(compile_all(writers, filename), self.globals)  # only ever made from the syntax tree
        self.writers.clear()

    def _file_of(self, writer: Writer) -> str:
        file = writer.files[0]
        return self.filename if file is None else file.name


def _prefix(value: Term) -> str:
    name = getattr(value, "name", None) or getattr(value, "__name__", None) or value.__class__.__name__
    text = "".join(c if c.isalnum() and c.isascii() else "_" for c in str(name))
    return f"K_{text}"


def compile_select(
    trigger: Trigger,
    plans: Sequence[Plan],
    actions: Mapping[str, InternalAction],
    outer: Plan | None = None,
    every: bool = False,
) -> tuple[Select, str]:
    """The select function of an event kind, and the generated text; *outer* is the plan that sub-plans belong to.

    With *every* it is a generator of the frames of all applicable plans.
    """
    written = write_select(trigger, plans, actions, outer, every)
    unit = written.unit
    unit.execute()
    for plan, achieved in written.conditions.items():
        plan.goal_condition = unit.globals[achieved]
    for plan, body, first in written.bodies:
        install_body(unit, plan, body, first)
    select: Select = unit.globals[written.name]
    return select, "\n".join(unit.source)


class WrittenSelect(NamedTuple):
    """A select function that has been written, and is not executed yet.

    Attributes:
        unit: holds it, and what it needs.
        name: of the function.
        bodies: of each plan the body, and the name of its first step function.
        conditions: of each plan that has one, the name of the test of its goal condition.
    """

    unit: CodeUnit
    name: str
    bodies: list[tuple[Plan, BodyCompiler, str]]
    conditions: dict[Plan, str]


def write_select(
    trigger: Trigger,
    plans: Sequence[Plan],
    actions: Mapping[str, InternalAction],
    outer: Plan | None = None,
    every: bool = False,
) -> WrittenSelect:
    """Write the select function of an event kind; see `compile_select`."""
    unit = CodeUnit(plans[0].file, actions)
    compiler = SelectCompiler(unit, trigger.functor.arity, every)
    name = compiler.select(plans, outer)
    conditions = {
        plan: compile_goal_condition(unit, plan) for plan in plans if plan.node.goal_condition is not None
    }
    return WrittenSelect(unit, name, compiler.bodies, conditions)


def install_body(unit: CodeUnit, plan: Plan, body: BodyCompiler, first: str) -> None:
    """Give a plan its compiled body.  What is known of a step is kept with its function: a frame may still be at a step
    of an earlier unit when the plan is compiled again.
    """
    plan.first = unit.globals[first] if first != "None" else None
    plan.steps = body.infos
    plan.size = body.frame.size
    for name, info in body.infos.items():
        function = unit.globals[name]
        function.plan, function.info, function.steps = plan, info, body.infos


def compile_search_function(
    symbol: Functor,
    pattern: int,
    before: Sequence[nodes.Rule],
    after: Sequence[nodes.Rule],
    actions: Mapping[str, InternalAction],
    trampoline: bool,
) -> FunctionType:
    """The generator function of a predicate for one pattern of use, see `jacaros.bdi.fast.generated.predicates`."""
    unit = CodeUnit(_file_of((*before, *after)[0]), actions)
    name = compile_search(unit, symbol, pattern, before, after, trampoline)
    unit.execute()
    function: FunctionType = unit.globals[name]
    return function


def compile_rule_function(rule: nodes.Rule, actions: Mapping[str, InternalAction]) -> FunctionType:
    """The generator function of a rule."""
    unit = CodeUnit(_file_of(rule), actions)
    name = compile_rule(unit, rule)
    unit.execute()
    function: FunctionType = unit.globals[name]
    return function


def _file_of(rule: nodes.Rule) -> str:
    return rule.span.file.name if rule.span is not None else "<run time>"
