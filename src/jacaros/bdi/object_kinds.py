"""How each kind of object in a mind is converted to data and restored.

Plans, rules and beliefs of the program are stored as their places in it, with a digest of their text; those added at run
time as their syntax. A step is stored as the plan and its position in it.
"""

import sys
from collections import deque
from collections.abc import Callable, Iterable, Iterator
from importlib import import_module
from types import FunctionType
from typing import Any, NamedTuple
from zlib import crc32

from jacaros.asl import nodes
from jacaros.asl.source import SourceFile
from jacaros.bdi.explaining.failure_reason import FailureReason
from jacaros.bdi.mind import Mind
from jacaros.bdi.rules.body_steps import interpreted
from jacaros.bdi.rules.plan_terms import plan_of_body
from jacaros.bdi.rules.searching import Remaining
from jacaros.bdi.rules.watched import WatchedCondition, WatchedGoal
from jacaros.bdi.state.pending import CoroutineWait
from jacaros.bdi.state.plan import Plan, every_plan, label_of, position_of, with_subplans
from jacaros.bdi.state.rule import OpenFact, Rule
from jacaros.bdi.state.triggers import Trigger, trigger
from jacaros.errors import JacarosError
from jacaros.terms.collections import QueueValue
from jacaros.terms.values import Annotated, Functor, List, Reference, Var, functor, list_items, make_list

Value = Any
"""Any object in a mind."""
Data = list[Any]
_PACKAGES = ("jacaros.asl.", "jacaros.bdi.", "jacaros.terms.")
"""Packages of the classes and functions of a mind."""
_LIVE = {
    CoroutineWait: "it waits for a coroutine",
    WatchedCondition: "Python code awaits a condition",
    WatchedGoal: "Python code awaits a goal",
    Reference: "a term holds a Python object",
}


class NotStorable(JacarosError):
    """Raised when a mind holds a live Python object."""


class Kind(NamedTuple):
    """How objects of one kind are written and restored.

    Attributes:
        write: returns plain data, and the parts.
        make: makes an object of both; a mutable one, of the data alone.
        fill: adds its parts to a mutable object; None for immutable ones.
    """

    write: Callable[["ProgramParts", Value], tuple[Data, Iterable[Value]]]
    make: Callable[["ProgramParts", Data, Data], Value]
    fill: Callable[[Value, Data], None] | None = None


class ProgramParts:
    """The plans and beliefs of a mind's program, found by their places."""

    def __init__(self, mind: Mind) -> None:
        self.mind = mind
        self._plans = list(every_plan(mind.library.program.plans))
        self._beliefs = mind.program.beliefs
        self._places = {id(part): place for place, part in enumerate(self._plans)}
        self._places |= {id(node): place for place, node in enumerate(self._beliefs)}

    def __contains__(self, part: Plan | nodes.Node) -> bool:
        return id(part) in self._places

    def written(self, part: Value) -> tuple[Data, tuple[()]]:
        """Return the place of a plan or belief, and a digest of it, as the program may have changed when it is restored."""
        return [self._places[id(part)], _digest(part)], ()

    def plan(self, data: Data, _: Data) -> Plan:
        """Restore a plan of the program."""
        plan: Plan = _same_as(data, self._plans)
        if plan.node.goal_condition is not None and plan.goal_condition is None:
            interpreted(plan)  # a frame whose body has ended needs the condition, but no step
        return plan

    def belief(self, data: Data, _: Data) -> nodes.Node:
        """Restore a belief or rule of the program."""
        node: nodes.Node = _same_as(data, self._beliefs)
        return node

    def own_plan(self, _: Data, parts: Data) -> Plan:
        """Restore a plan that was added at run time."""
        node, *labels = parts
        plan = with_subplans(Plan(node, label_of(node, 0), self.mind.library.by_name), 0)
        for inner, label in zip(every_plan([plan]), labels, strict=True):
            inner.label = label
        return plan


def _digest(part: Plan | nodes.Node) -> int:
    node = part.node if isinstance(part, Plan) else part
    return crc32(repr(node).encode())


def _same_as(data: Data, held: Iterable[Value]) -> Value:
    """Return the stored plan or belief of a program; at another place, if the program has changed.

    Raises:
        ValueError: the program lacks it.
    """
    place, digest = data
    at_place = list(held)[place : place + 1]
    for part in (*at_place, *held):
        if _digest(part) == digest:
            return part
    raise ValueError("the program has changed: it lacks a plan or belief that the stored mind uses")


def _name_of(value: Value) -> Data:
    """Return the module and the name of a function or class of the mind.

    Raises:
        NotStorable: it cannot be found by name.
    """
    _refuse_live(value)
    module, name = getattr(value, "__module__", None) or "", getattr(value, "__qualname__", "")
    if module.startswith(_PACKAGES) and getattr(sys.modules.get(module), name, None) is value:
        return [module, name]
    raise NotStorable(f"the mind cannot be stored: it holds {value!r}")


def _refuse_live(value: Value) -> None:
    """Refuse a live object, or a method of one."""
    for live, why in _LIVE.items():
        if isinstance(getattr(value, "__self__", value), live):
            raise NotStorable(f"the mind cannot be stored: {why}")


def _named(data: Data, wanted: type) -> Value:
    """Return the function of that name, or the subclass of *wanted*.

    Raises:
        ValueError: it is not part of a mind.
    """
    module, name = data
    found = getattr(import_module(module), name, None) if module.startswith(_PACKAGES) else None
    if found.__class__ is wanted or (isinstance(found, type) and issubclass(found, wanted)):
        return found
    raise ValueError(f"{module}.{name} is not part of a mind")


def fill_dict(made: dict[Value, Value], parts: Data) -> None:
    """Put keys and values in turn into a dictionary."""
    made.update(zip(parts[::2], parts[1::2], strict=True))


def _fill_variable(made: Var, parts: Data) -> None:
    made.ref, at, number = parts
    if at is not None:
        made.at = at
    if number is not None:
        made.number = number


def _fill_queue(made: QueueValue, parts: Data) -> None:
    for item in parts:
        made.add(item)


def _written_object(_: ProgramParts, value: Value) -> tuple[Data, Data]:
    _refuse_live(value)
    if isinstance(value, FailureReason):
        value.terms  # noqa: B018 - puts them together
    return _name_of(value.__class__), [part for item in _attributes(value) for part in item]


def _attributes(value: Value) -> Iterator[tuple[str, Value]]:
    for kind in value.__class__.__mro__:
        for name in kind.__dict__.get("__slots__", ()):
            if name != "timer" and hasattr(value, name):
                yield name, getattr(value, name)
    yield from getattr(value, "__dict__", {}).items()


def _empty_object(_: ProgramParts, data: Data, __: Data) -> Value:
    kind = _named(data, object)
    return kind.__new__(kind)


def _fill_object(made: Value, parts: Data) -> None:
    for name, value in zip(parts[::2], parts[1::2], strict=True):
        setattr(made, name, value)


def kind_of(program: ProgramParts, value: Value) -> str:
    """Return the kind of an object, usually by its class."""
    known = _KIND_OF.get(value.__class__)
    if known is not None:
        return known
    if isinstance(value, Plan):
        return _kind_of_plan(program, value)
    if isinstance(value, nodes.Node):
        return "belief" if value in program else "node"
    if callable(value):
        return "step" if hasattr(value, "plan") else "function"
    return "named" if isinstance(value, tuple) else "object"


def _kind_of_plan(program: ProgramParts, plan: Plan) -> str:
    if plan in program:
        return "plan"
    if plan.body_term is not None:
        return "body"
    return "own_plan" if plan.scope is None else "subplan"


def _of_parts(make: Callable[..., Value], *names: str) -> Kind:
    """Return a kind of immutable objects that are made of the values of their attributes."""
    return Kind(
        lambda _, value: ([], [getattr(value, name) for name in names]), lambda _, __, parts: make(*parts)
    )


def _filled(make: Callable[[], Value], fill: Callable[[Value, Data], None]) -> Kind:
    """Return a kind of mutable collections."""
    return Kind(lambda _, value: ([], value), lambda _, __, ___: make(), fill)


_CLASSES: dict[type, Kind] = {
    # immutable
    tuple: Kind(lambda _, value: ([], value), lambda _, __, parts: tuple(parts)),
    List: Kind(lambda _, value: ([], list_items(value)), lambda _, __, parts: make_list(parts)),
    Functor: _of_parts(functor, "name", "arity", "negated", "namespace", "kind"),
    Trigger: _of_parts(trigger, "operator", "kind", "functor"),
    Annotated: _of_parts(Annotated, "term", "annotations", "tail"),
    SourceFile: _of_parts(SourceFile, "name", "text"),
    Rule: _of_parts(Rule, "written", "of_program"),
    OpenFact: _of_parts(OpenFact, "literal", "annotations", "written"),
    # mutable
    list: _filled(list, list.extend),
    deque: _filled(deque, deque.extend),
    set: _filled(set, set.update),
    dict: Kind(
        lambda _, value: ([], [part for item in value.items() for part in item]),
        lambda _, __, ___: {},
        fill_dict,
    ),
    Var: Kind(
        lambda _, var: ([var.name], (var.ref, getattr(var, "at", None), getattr(var, "number", None))),
        lambda _, data, __: Var(*data),
        _fill_variable,
    ),
    QueueValue: Kind(
        lambda _, queue: ([queue.priority], queue), lambda _, data, __: QueueValue(*data), _fill_queue
    ),
    Remaining: Kind(
        lambda _, value: ([], value.copy()),
        lambda _, __, ___: Remaining(iter(())),
        lambda made, parts: Remaining.__init__(made, iter(parts), parts),
    ),
}
_KIND_OF = {each: each.__name__ for each in _CLASSES}
KINDS: dict[str, Kind] = {_KIND_OF[each]: kind for each, kind in _CLASSES.items()} | {
    "function": Kind(lambda _, value: (_name_of(value), ()), lambda _, data, __: _named(data, FunctionType)),
    "named": Kind(
        lambda _, value: (_name_of(value.__class__), value),
        lambda _, data, parts: _named(data, tuple)(*parts),
    ),
    "plan": Kind(ProgramParts.written, ProgramParts.plan),
    "own_plan": Kind(
        lambda _, plan: ([], (plan.node, *(each.label for each in every_plan([plan])))),
        ProgramParts.own_plan,
    ),
    "subplan": Kind(
        lambda _, plan: ([plan.scope.subplans.index(plan)], (plan.scope,)),
        lambda _, data, parts: parts[0].subplans[data[0]],
    ),
    "body": Kind(
        lambda _, plan: ([], (plan.body_term,)), lambda program, _, parts: plan_of_body(program.mind, *parts)
    ),
    "step": Kind(
        lambda _, step: ([position_of(step)], (step.plan,)),
        lambda program, data, parts: program.mind.engine.step_at(*parts, *data),
    ),
    "belief": Kind(ProgramParts.written, ProgramParts.belief),
    "node": Kind(
        lambda _, node: (_name_of(node.__class__), (*node.parts(), node.span)),
        lambda _, data, parts: _named(data, nodes.Node)(*parts[:-1], span=parts[-1]),
    ),
    "object": Kind(_written_object, _empty_object, _fill_object),
}
