"""A mind as a value: everything it holds, as data for JSON, and back.

`stored` writes one flat table of objects that refer to each other by number: so variables that several frames share are
shared again, and nothing is too deep.  A step is the plan and its position there; a plan is its place in the program, or
its text if it was added at run time.

What Python code around the mind holds on to cannot be stored (`NotStorable`): coroutines of the project that an intention
waits for, goals and conditions that it awaits, and opaque objects in terms.
"""

import sys
from collections import deque
from collections.abc import Iterable, Iterator
from typing import Any

from jacaros.asl.formatter import format_plan, format_term
from jacaros.asl.loader import parse_plans, parse_term
from jacaros.bdi.explaining.failure_reason import FailureReason, StepPlace
from jacaros.bdi.mind import Mind
from jacaros.bdi.rules import waits
from jacaros.bdi.rules.body_steps import interpreted
from jacaros.bdi.rules.functions import known_names
from jacaros.bdi.rules.plan_changes import look_at_plans
from jacaros.bdi.rules.plan_terms import plan_of_body
from jacaros.bdi.rules.searching import Remaining
from jacaros.bdi.rules.watched import WatchedGoal
from jacaros.bdi.state.condition_waits import ConditionObserver
from jacaros.bdi.state.intention import STEP
from jacaros.bdi.state.plan import Plan, label_of, position_of, with_subplans
from jacaros.bdi.state.rule import OpenFact, Rule
from jacaros.bdi.state.triggers import Trigger, trigger
from jacaros.bdi.state.waiting import CoroutineWait
from jacaros.errors import JacarosError
from jacaros.terms.collections import QueueValue
from jacaros.terms.values import (
    Annotated,
    Functor,
    List,
    Reference,
    String,
    Var,
    functor,
    list_items,
    make_list,
)
from jacaros.trace import Cause

FORMAT = 1
"""Version of the format."""

_FIELDS = (
    "_acts",
    "_namespaces",
    "abandoned_asks",
    "alarms",
    "alarms_made",
    "alive",
    "asleep",
    "atomic",
    "atomic_over",
    "blamed",
    "called",
    "cycles",
    "drowsy",
    "functions",
    "held_percepts",
    "inbox",
    "intentions_made",
    "messages",
    "namespace_properties",
    "next_count",
    "next_look",
    "pending_acts",
    "pending_asks",
    "percepts",
    "plans_made",
    "refused_options",
    "requeued",
    "suspended_events",
    "tasks",
)
_QUEUES = ("events", "intentions", "crowd")


class NotStorable(JacarosError):
    """A mind holds a live object of Python code."""


def stored(mind: Mind) -> dict[str, Any]:
    """Return everything that a mind holds, as data for JSON; to be called between two turns.

    Raises:
        NotStorable: the mind holds a live object.
    """
    library, conditions = mind.library, mind.condition_waits
    held: dict[str, Any] = {name: getattr(mind, name) for name in _FIELDS}
    held |= {name: list(getattr(mind, name)) for name in _QUEUES}
    held["beliefs"] = [
        (symbol, list(table.rows.items()), list(table.late.items()))
        for symbol, table in mind.beliefs.items()
        if len(table)
    ]
    held["plans"] = library.parts()
    held["event_waits"] = [wait for kind in mind.event_waits.values() for wait in kind.values()]
    held["condition_waits"] = (list(conditions.values()), list(conditions.due), list(conditions.restless))
    held["serial"] = mind.trail.serial
    writer = _Writer(mind)
    version, state, gauss = mind.architecture.random.getstate()
    return {
        "format": FORMAT,
        "agent": mind.name,
        "held": writer.write(held),
        "objects": writer.table,
        "random": [version, list(state), gauss],
    }


def restore(mind: Mind, data: dict[str, Any]) -> None:
    """Give a new mind, which has the same program and has not begun, what was `stored` of another.

    Raises:
        ValueError: *data* has another format.
    """
    if data.get("format") != FORMAT:
        raise ValueError(
            f"the stored mind has format {data.get('format')!r}; this version reads format {FORMAT}"
        )
    held = _Reader(mind, data["objects"]).read(data["held"])
    for symbol, rows, late in held["beliefs"]:
        for entries, last in ((rows, False), (late, True)):
            for entry, annotations in entries:
                mind.beliefs[symbol].add(entry, annotations, last)
    if held["plans"] is not None:
        mind.library.take_parts(*held["plans"])
    look_at_plans(mind)
    mind.tasks.clear()
    for name in _FIELDS:
        setattr(mind, name, held[name])
    for name in _QUEUES:
        getattr(mind, name).extend(held[name])
    for wait in sorted(held["event_waits"], key=lambda each: each.number):
        mind.event_waits.add(wait, wait.number)
    conditions, due, restless = held["condition_waits"]
    for wait in conditions:
        mind.condition_waits.add(wait, wait.number)
    mind.condition_waits.due = {number: mind.condition_waits[number] for number in due}
    mind.condition_waits.restless = {number: mind.condition_waits[number] for number in restless}
    mind.trail.serial = held["serial"]
    version, state, gauss = data["random"]
    mind.architecture.random.setstate((version, tuple(state), gauss))
    if mind.urgency is not None:
        mind.urgency.rank()
    for alarm in mind.alarms.values():
        waits.start_alarm(mind, alarm, max(0.0, alarm.due - mind.architecture.now()))
    mind.architecture.ready()


class _Writer:
    """Puts objects into a table: a list for each, which begins with its kind.

    What cannot change comes behind its parts; what can may refer to anything.
    """

    def __init__(self, mind: Mind) -> None:
        self.table: list[list[Any]] = []
        self._mind = mind
        self._numbers: dict[int, int] = {}
        self._held: list[
            Any
        ] = []  # so that nothing else can be at the place in memory of what has been written
        self._open: list[tuple[int, Any]] = []
        self._plans = {plan: place for place, plan in enumerate(_with_inner(mind.library.program.plans))}

    def write(self, value: Any) -> Any:
        """Write a value with all that it refers to; return how the table is entered."""
        self._enter(value)
        while self._open:
            number, each = self._open.pop()
            parts = list(_parts(each))
            for part in parts:
                self._enter(part)
            self.table[number] += map(self._inline, parts)
        return self._inline(value)

    def _enter(self, value: Any) -> None:
        todo = [value]
        while todo:
            each = todo[-1]
            if _is_inline(each) or id(each) in self._numbers:
                todo.pop()
                continue
            fixed = self._fixed(each)
            parts = () if fixed is None else fixed[1]
            missing = [part for part in parts if not (_is_inline(part) or id(part) in self._numbers)]
            if missing:
                todo += missing
                self._held.append(parts)
                continue
            todo.pop()
            self._numbers[id(each)] = len(self.table)
            self._held.append((each, parts))
            if fixed is None:
                self._open.append((len(self.table), each))
                self.table.append(_kind(each))
            else:
                self.table.append([*fixed[0], *map(self._inline, parts)])

    def _inline(self, value: Any) -> Any:
        kind = value.__class__
        if kind is int:
            return {"i": value}
        if kind is str:
            return {"s": value}
        if kind is float and not abs(value) < _INFINITY:
            return {"f": repr(value)}
        if _is_inline(value):
            return None if kind is Cause else value
        return {"r": self._numbers[id(value)]}

    def _fixed(self, value: Any) -> tuple[list[Any], list[Any]] | None:
        """Kind and parts of an object that cannot change; None for others."""
        kind = value.__class__
        if kind is tuple:
            return ["tuple"], list(value)
        if kind is Functor:
            return ["functor", value.name, value.arity, value.negated, value.namespace, value.kind], []
        if kind is Trigger:
            return ["trigger", value.operator, value.kind], [value.functor]
        if kind is List:
            return ["list"], list(list_items(value))
        if kind is Annotated:
            return ["annotated"], [value.term, value.annotations, value.tail]
        if kind is Plan:
            return self._plan(value)
        if kind is Rule or kind is OpenFact:
            return self._entry(value)
        if callable(value):
            if hasattr(value, "plan"):
                return ["step", position_of(value)], [value.plan]
            return ["function", *_name_of(value)], []
        if isinstance(value, tuple):
            return ["named", *_name_of(kind)], list(value)
        return None

    def _plan(self, plan: Plan) -> tuple[list[Any], list[Any]]:
        if plan in self._plans:
            return ["plan", self._plans[plan]], []
        if plan.body_term is not None:
            return ["body"], [plan.body_term]
        if plan.scope is not None:
            return ["subplan", plan.scope.subplans.index(plan)], [plan.scope]
        return ["text", format_plan(plan.node)], [plan.label]

    def _entry(self, entry: Rule | OpenFact) -> tuple[list[Any], list[Any]]:
        """A rule or a belief with variables."""
        parts = [] if isinstance(entry, Rule) else [entry.literal, entry.annotations]
        for place, node in enumerate(self._mind.program.beliefs):
            if node is entry.written:
                return ["of_program", place], parts
        return (["rule", format_term(entry.written)] if isinstance(entry, Rule) else ["open"]), parts


_INFINITY = float("inf")


def _is_inline(value: Any) -> bool:
    return value is None or value.__class__ in _INLINE


_INLINE = frozenset({float, int, str, bool, String, Cause})
_KINDS = {Var: "var", list: "array", dict: "dict", set: "set", deque: "deque", QueueValue: "queue"}
_KINDS |= {Remaining: "remaining", StepPlace: "place"}
_LIVE = {
    CoroutineWait: "it waits for a coroutine",
    ConditionObserver: "Python code awaits a condition",
    WatchedGoal: "Python code awaits a goal",
    Reference: "a term holds a Python object",
}


def _name_of(value: Any) -> tuple[str, str]:
    """Return the module and the name of a function or class of the mind.

    Raises:
        NotStorable: it cannot be found by a name.
    """
    module, name = getattr(value, "__module__", None) or "", getattr(value, "__qualname__", "")
    if module.startswith("jacaros.") and getattr(sys.modules.get(module), name, None) is value:
        return module, name
    raise NotStorable(f"the mind cannot be stored: it holds {value!r}")


def _kind(value: Any) -> list[Any]:
    """How the entry of an object begins that can change."""
    kind = _KINDS.get(value.__class__)
    if kind is not None:
        return [kind]
    for live, why in _LIVE.items():
        if isinstance(value, live):
            raise NotStorable(f"the mind cannot be stored: {why}")
    return ["object", *_name_of(value.__class__)]


def _parts(value: Any) -> Iterable[Any]:
    """What is written of an object that can change."""
    kind = value.__class__
    if kind in (list, set, deque):
        return value  # type: ignore[no-any-return]
    if kind is dict:
        return [part for item in value.items() for part in item]
    if kind is Var:
        return [value.name, value.ref, getattr(value, "at", None), getattr(value, "number", None)]
    if kind is QueueValue:
        return [value.priority, *value]
    if kind is Remaining:
        return value.copy()  # type: ignore[no-any-return]
    if kind is StepPlace:
        return [value.frame]
    if kind is FailureReason:
        value.terms  # noqa: B018 - puts them together
    return [part for item in _attributes(value) for part in item]


def _attributes(value: Any) -> Iterator[tuple[str, Any]]:
    for kind in value.__class__.__mro__:
        for name in kind.__dict__.get("__slots__", ()):
            if name != "timer" and hasattr(value, name):
                yield name, getattr(value, name)
    yield from getattr(value, "__dict__", {}).items()


def _with_inner(plans: Iterable[Plan]) -> Iterator[Plan]:
    """Plans and those inside them, in a fixed order."""
    for plan in plans:
        yield plan
        yield from _with_inner(plan.subplans)


class _Reader:
    """Makes the objects of a table: first what cannot change, and empty ones of what can, then what these hold."""

    def __init__(self, mind: Mind, table: list[list[Any]]) -> None:
        self._mind = mind
        self._plans = list(_with_inner(mind.library.program.plans))
        self._made: list[Any] = []
        for kind, *parts in table:
            self._made.append(getattr(self, f"_{kind}")(*parts))
        places: list[StepPlace] = []
        for made, (kind, *parts) in zip(self._made, table, strict=True):
            if kind in _FILLED:
                self._fill(made, parts[2:] if kind == "object" else parts)
            if kind == "place":
                places.append(made)
        for place in places:
            place.info = place.frame[STEP].info

    def read(self, value: Any) -> Any:
        """The value that an entry stands for."""
        if value.__class__ is not dict:
            return String(value) if value.__class__ is str else value
        ((how, inner),) = value.items()
        if how == "r":
            return self._made[inner]
        return float(inner) if how == "f" else inner

    def _all(self, parts: Iterable[Any]) -> list[Any]:
        return [self.read(part) for part in parts]

    def _fill(self, made: Any, parts: list[Any]) -> None:
        values = self._all(parts)
        kind = made.__class__
        if kind in (list, deque):
            made.extend(values)
        elif kind is set:
            made.update(values)
        elif kind is dict:
            made.update(zip(values[::2], values[1::2], strict=True))
        elif kind is Var:
            _, made.ref, at, number = values
            if at is not None:
                made.at = at
            if number is not None:
                made.number = number
        elif kind is QueueValue:
            for item in values[1:]:
                made.add(item)
        elif kind is Remaining:
            made.__init__(iter(values), values)
        elif kind is StepPlace:
            made.__init__(values[0], None)
        else:
            for name, value in zip(values[::2], values[1::2], strict=True):
                setattr(made, name, value)

    # what cannot change

    def _tuple(self, *parts: Any) -> Any:
        return tuple(self._all(parts))

    def _functor(self, *parts: Any) -> Functor:
        return functor(*parts)

    def _trigger(self, operator: str, kind: str, symbol: Any) -> Trigger:
        return trigger(operator, kind, self.read(symbol))

    def _list(self, *parts: Any) -> Any:
        return make_list(self._all(parts))

    def _annotated(self, *parts: Any) -> Annotated:
        return Annotated(*self._all(parts))

    def _function(self, module: str, name: str) -> Any:
        if not module.startswith("jacaros."):
            raise ValueError(f"{module}.{name} is not part of a mind")
        return getattr(sys.modules[module], name)

    def _named(self, module: str, name: str, *parts: Any) -> Any:
        return self._function(module, name)(*self._all(parts))

    def _step(self, position: str, plan: Any) -> Any:
        return self._mind.engine.step_at(self.read(plan), position)

    def _plan(self, place: int) -> Plan:
        plan = self._plans[place]
        if plan.node.goal_condition is not None and plan.goal_condition is None:
            interpreted(plan)  # a frame whose body has ended asks for the condition and for no step
        return plan

    def _body(self, term: Any) -> Plan:
        return plan_of_body(self._mind, self.read(term))

    def _subplan(self, place: int, scope: Any) -> Plan:
        inner: Plan = self.read(scope).subplans[place]
        return inner

    def _text(self, written: str, label: Any) -> Plan:
        (node,) = parse_plans(written, functions=known_names(self._mind), actions=self._mind.actions)
        own = self.read(label) if node.label is None else label_of(node, 0)
        return with_subplans(Plan(node, own, self._mind.library.by_name), 0)

    def _of_program(self, place: int, *parts: Any) -> Rule | OpenFact:
        written: Any = self._mind.program.beliefs[place]
        if parts:
            literal, annotations = self._all(parts)
            return OpenFact(literal, annotations, written)
        return Rule(written, of_program=True)

    def _rule(self, written: str) -> Rule:
        term: Any = parse_term(f"{{ {written} }}", functions=known_names(self._mind))
        return Rule(term.rule)

    def _open(self, *parts: Any) -> OpenFact:
        return OpenFact(*self._all(parts))

    # what can change, empty

    def _array(self, *_: Any) -> list[Any]:
        return []

    def _dict(self, *_: Any) -> dict[Any, Any]:
        return {}

    def _set(self, *_: Any) -> set[Any]:
        return set()

    def _deque(self, *_: Any) -> deque[Any]:
        return deque()

    def _var(self, name: Any, *_: Any) -> Var:
        return Var(self.read(name))

    def _queue(self, priority: bool, *_: Any) -> QueueValue:
        return QueueValue(priority)

    def _remaining(self, *_: Any) -> Remaining:
        return Remaining(iter(()))

    def _place(self, *_: Any) -> StepPlace:
        return StepPlace.__new__(StepPlace)

    def _object(self, module: str, name: str, *_: Any) -> Any:
        kind = self._function(module, name)
        return kind.__new__(kind)


_FILLED = frozenset({*_KINDS.values(), "object"})
