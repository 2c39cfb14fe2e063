"""A mind as data: its objects by kind, shared ones once, and how each is restored.

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

from jacaros.agents.language import nodes
from jacaros.agents.language.diagnostics import SourceFile
from jacaros.agents.mind.explaining.failure_reason import FailureReason
from jacaros.agents.mind.mind import Mind
from jacaros.agents.mind.rules import goals, urgency
from jacaros.agents.mind.rules.body_steps import interpreted
from jacaros.agents.mind.rules.goals import WatchedCondition, WatchedGoal
from jacaros.agents.mind.rules.pending import look_again, now, start_alarm
from jacaros.agents.mind.rules.plan_changes import look_at_plans
from jacaros.agents.mind.rules.plan_terms import plan_of_body
from jacaros.agents.mind.rules.searching import Remaining
from jacaros.agents.mind.state.act import Completion
from jacaros.agents.mind.state.belief_base import take_away
from jacaros.agents.mind.state.circumstance import Circumstance
from jacaros.agents.mind.state.intention import EVENT_INTENTION, Intention
from jacaros.agents.mind.state.pending import CoroutineWait
from jacaros.agents.mind.state.plan import (
    OpenFact,
    Plan,
    Rule,
    every_plan,
    label_of,
    position_of,
    with_subplans,
)
from jacaros.agents.mind.state.triggers import Trigger, trigger
from jacaros.agents.terms.collections import QueueValue
from jacaros.agents.terms.order import number_of
from jacaros.agents.terms.substitution import ATOMIC
from jacaros.agents.terms.values import (
    SOURCE_PERCEPT,
    Annotated,
    Functor,
    List,
    Reference,
    String,
    Var,
    atom,
    functor,
    list_items,
    make_list,
)
from jacaros.errors import JacarosError
from jacaros.runtime.trace import Cause

Value = Any
"""Any object in a mind."""
Data = list[Any]
_PACKAGES = ("jacaros.agents.language.", "jacaros.agents.mind.", "jacaros.agents.terms.")
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


# Convert the objects of a mind to a flat table of data for JSON, and back.
#
# An entry is a kind of object (`jacaros.agents.mind.storage`), plain data, and the parts: values, or the numbers of other
# entries. So shared objects are shared again, and nothing is nested too deeply. An immutable object comes after its parts;
# a mutable one is made empty, and filled when all others exist.


Entry = tuple[str, Data, Data]
"""Kind, plain data, and parts; a list when it comes from JSON."""
_INLINE = frozenset({bool, float, int, str, String})
_SHARED = ATOMIC | {Cause, Plan, Reference, Rule, Trigger}
_INFINITY = float("inf")


class Writer:
    """Write objects into a table.

    Args:
        shared: the table is for another mind of the same program in this process. Plans, rules, Python objects in terms,
            and beliefs without variables and collections are not copied.

    Attributes:
        table: the entries.
    """

    def __init__(self, mind: Mind, shared: bool = False) -> None:
        self.table: list[Entry] = []
        self._program = ProgramParts(mind)
        self._shared = shared
        self._numbers: dict[int, int] = {}
        self._written: list[Value] = []  # keeps the objects alive, so that no other object gets the same id
        self._open: list[tuple[int, Data]] = []

    def write(self, value: Value) -> Value:
        """Write a value with everything it refers to; return its reference in the table."""
        self._enter(value)
        while self._open:
            number, parts = self._open.pop()
            for part in parts:
                self._enter(part)
            self.table[number][2].extend(map(self._inline, parts))
        return self._inline(value)

    def _enter(self, value: Value) -> None:
        """Number a value, after the values that it cannot be made without."""
        todo = [value]
        forms: dict[int, Entry] = {}
        while todo:
            each = todo[-1]
            if self._is_known(each):
                todo.pop()
                continue
            form = forms.get(id(each)) or forms.setdefault(id(each), self._form(each))
            missing = [] if KINDS[form[0]].fill else [part for part in form[2] if not self._is_known(part)]
            if missing:
                todo += missing
            else:
                todo.pop()
                self._put(each, form)

    def _form(self, value: Value) -> Entry:
        kind = kind_of(self._program, value)
        data, parts = KINDS[kind].write(self._program, value)
        return kind, data, list(parts)

    def _put(self, value: Value, form: Entry) -> None:
        kind, data, parts = form
        number = self._numbers[id(value)] = len(self.table)
        self._written.append((value, parts))
        if KINDS[kind].fill:
            self._open.append((number, parts))
            parts = []
        self.table.append((kind, data, [*map(self._inline, parts)]))

    def _is_known(self, value: Value) -> bool:
        return self._is_inline(value) or id(value) in self._numbers

    def _is_inline(self, value: Value) -> bool:
        if value is None or value.__class__ in _INLINE or value.__class__ is Cause:
            return True
        return self._shared and (
            _is_shared(value) or (value.__class__ is tuple and all(map(_is_shared, value)))
        )

    def _inline(self, value: Value) -> Value:
        kind = value.__class__
        if kind is int:
            return {"i": value}
        if kind is str:
            return {"s": value}
        if kind is float and not abs(value) < _INFINITY:
            return {"f": repr(value)}
        if self._is_inline(value):
            return None if kind is Cause and not self._shared else value
        return {"r": self._numbers[id(value)]}


def _is_shared(value: Value, depth: int = 4) -> bool:
    """Return whether two minds may share this object; rows with annotations are at most as deep as
    *depth*.
    """
    if value.__class__ is tuple:
        return depth > 0 and all(each.__class__ in ATOMIC or _is_shared(each, depth - 1) for each in value)
    return value.__class__ in _SHARED or callable(value)


class Reader:
    """Make the objects of a table for a mind.

    Raises:
        ValueError: the program of the mind lacks a plan or belief that is used, or the table contains something that is
            not part of a mind.
    """

    def __init__(self, mind: Mind, table: Iterable[Entry]) -> None:
        program = ProgramParts(mind)
        self._made: list[Value] = []
        open_ones: list[tuple[str, Value, Data]] = []
        for kind, data, parts in table:
            fixed = KINDS[kind].fill is None
            made = KINDS[kind].make(program, data, self._all(parts) if fixed else [])
            self._made.append(made)
            if not fixed:
                open_ones.append((kind, made, parts))
        open_ones.sort(
            key=lambda each: each[0] == "dict"
        )  # sets that are keys must be filled before their dictionaries
        for kind, made, parts in open_ones:
            fill = KINDS[kind].fill
            assert fill is not None
            fill(made, self._all(parts))
        self._fill_nested_sets([(made, parts) for kind, made, parts in open_ones if kind == "dict"])
        self._number_variables([made for kind, made, _ in open_ones if kind == "Var"])

    def _fill_nested_sets(self, filled: list[tuple[Value, Data]]) -> None:
        """Fill dictionaries again in which two keys were equal because the sets in them were still empty."""
        short = [(made, parts) for made, parts in filled if 2 * len(made) < len(parts)]
        for made, parts in short:
            made.clear()
            fill_dict(made, self._all(parts))
        if short:
            self._fill_nested_sets(short)

    @staticmethod
    def _number_variables(variables: list[Var]) -> None:
        """Keep the order of variables that have been compared; their numbers come from another process."""
        compared = [variable for variable in variables if hasattr(variable, "number")]
        for variable in sorted(compared, key=lambda each: each.number):
            del variable.number
            number_of(variable)

    def read(self, value: Value) -> Value:
        """Return the value that an entry represents."""
        if value.__class__ is not dict:
            return String(value) if value.__class__ is str else value
        ((how, inner),) = value.items()
        if how == "r":
            return self._made[inner]
        return float(inner) if how == "f" else inner

    def _all(self, parts: Data) -> Data:
        return [self.read(part) for part in parts]


# A mind as a value: convert its state to data for JSON, and back.
#
# `knowledge` is what an agent believes and its plans. ``.save_agent`` writes it as a program, ``.clone`` gives it to
# another agent together with events and intentions (`copy_mind`), and `stored` adds everything else. All of them use the
# one walk over the state, `jacaros.agents.mind.storage`.
#
# Live Python objects cannot be stored (`NotStorable`): coroutines of the project that an intention waits for, goals and
# conditions that Python code awaits, and opaque objects in terms.


FORMAT = 6
"""Version of the format."""

_FIELDS = (
    "_acts",
    "_namespaces",
    "alive",
    "atomic",
    "atomic_over",
    "counts",
    "incoming",
    "messages",
    "sleep",
    "waits",
)
_QUEUES = ("events", "intentions")
_INTERRUPTED = (
    (functor("env_failure_reason", 1), atom("interrupted")),
    (functor("error_msg", 1), String("the agent was stored and restored while the action was under way")),
)


def stored(mind: Mind) -> dict[str, Any]:
    """Return the whole state of a mind as data for JSON; to be called between two turns.

    Raises:
        NotStorable: the mind holds a live object.
    """
    now(mind)  # the latest time is stored
    held = knowledge(mind)
    held |= {name: getattr(mind, name) for name in _FIELDS}
    held["held_percepts"], held["blamed"] = mind.beliefs.held_percepts, mind.library.blamed
    held |= {name: list(getattr(mind, name)) for name in _QUEUES}
    held["refused"] = {name: (each.refusals, each.losses) for name, each in mind.budgets.items()}
    held["serial"] = mind.trail.serial
    writer = Writer(mind)
    version, state, gauss = mind.architecture.random.getstate()
    return {
        "format": FORMAT,
        "agent": mind.name,
        "held": writer.write(held),
        "objects": writer.table,
        "random": [version, list(state), gauss],
    }


def restore(mind: Mind, data: dict[str, Any], *, same_host: bool = False) -> None:
    """Restore the state that was `stored` of another mind into a new one, which has the same program and has not
    started.

    An external action that was running fails with ``env_failure_reason(interrupted)``: its host may be gone, and
    repeating the action could move a robot twice, so the plan decides. Percept beliefs are removed without events: the
    new host reports them again. A wait that has expired meanwhile ends immediately; if the clock was set back, it ends
    after its remaining time.

    Args:
        mind: the new mind.
        data: the stored state.
        same_host: the host of the other mind serves the new one: its actions continue, and its percepts are still valid.

    Raises:
        ValueError: *data* has another format, or the program lacks a plan or belief that the other mind used.
    """
    if data.get("format") != FORMAT:
        raise ValueError(
            f"the stored mind has format {data.get('format')!r}; this version reads format {FORMAT}"
        )
    mind.engine.begin(mind)
    held = Reader(mind, data["objects"]).read(data["held"])
    _learn(mind, held)
    arrived = mind.incoming.percepts
    for name in _FIELDS:
        setattr(mind, name, held[name])
    if not same_host:
        signals = [[each for each in group if each.kind == "signal"] for group in mind.incoming.percepts]
        mind.incoming.percepts = deque(signals)
    mind.incoming.percepts.extend(arrived)
    mind.incoming.called = mind.incoming.called or bool(arrived)
    mind.beliefs.held_percepts, mind.library.blamed = held["held_percepts"], held["blamed"]
    for name in _QUEUES:
        getattr(mind, name).extend(held[name])
    for intention in mind.alive.values():
        mind.note_plans(intention)
    for alarm in mind.waits.alarms.values():
        start_alarm(mind, alarm, max(0.0, alarm.due - now(mind)))
    for name, (refusals, losses) in held["refused"].items():
        mind.budgets[name].refusals, mind.budgets[name].losses = refusals, losses
    mind.trail.serial = held["serial"]
    version, state, gauss = data["random"]
    mind.architecture.random.setstate((version, tuple(state), gauss))
    urgency.plans_changed(mind)
    if not same_host:
        _leave_host(mind)
    mind.architecture.ready()


def _leave_host(mind: Mind) -> None:
    """End everything that only the old host knew of."""
    for number in list(mind.waits.acts):
        mind.complete(number, Completion(False, annotations=_INTERRUPTED))
    mind.beliefs.held_percepts.clear()
    for table in mind.beliefs.values():
        for entry, annotations in table.entries():
            if SOURCE_PERCEPT in annotations:
                take_away(table, entry, annotations, (SOURCE_PERCEPT,))
    for number in list(mind.waits.preempted):
        goals.resume(mind, number)
    mind.waits.needs.clear()
    mind.waits.due.update(mind.waits.conditions)
    mind.do_soon(look_again)


def knowledge(agent: Circumstance) -> dict[str, Any]:
    """Return what an agent believes and its plans.

    ``beliefs`` has for each functor the entries with their annotations, oldest first, and those that answer last.
    """
    held: dict[str, Any] = {
        "functions": agent.functions.own,
        "namespace_properties": agent.beliefs.namespace_properties,
        "plans_made": agent.library.plans_made,
    }
    held["beliefs"] = [
        (symbol, list(table.rows.items()), list(table.late.items()))
        for symbol, table in agent.beliefs.items()
        if len(table)
    ]
    held["plans"] = agent.library.parts()
    return held


def _learn(mind: Mind, held: dict[str, Any]) -> None:
    """Take over the knowledge of another agent."""
    for symbol, rows, late in held["beliefs"]:
        for entries, last in ((rows, False), (late, True)):
            for entry, annotations in entries:
                mind.beliefs[symbol].add(entry, annotations, last)
    mind.functions.own = held["functions"]
    mind.beliefs.namespace_properties = held["namespace_properties"]
    mind.library.plans_made = held["plans_made"]
    if held["plans"] is not None:
        mind.library.take_parts(*held["plans"])
    look_at_plans(mind)


def copy_mind(original: Mind, clone: Mind) -> None:
    """Give *clone*, a new agent with the same program, the knowledge, events and intentions of *original*.

    The running intention is not copied, nor are waiting and suspended intentions and branches of forks: what they wait
    for belongs to the original.
    """
    part = knowledge(original)
    part["events"] = [
        event
        for event in original.events
        if (intention := event[EVENT_INTENTION]) is None or _can_be_copied(original, intention)
    ]
    part["intentions"] = [each for each in original.intentions if _can_be_copied(original, each)]
    writer = Writer(original, shared=True)
    entry = writer.write(part)
    held = Reader(clone, writer.table).read(entry)
    _learn(clone, held)
    clone.events.extend(held["events"])
    clone.intentions.extend(held["intentions"])
    owners = [event[EVENT_INTENTION] for event in held["events"] if event[EVENT_INTENTION] is not None]
    for intention in (*owners, *held["intentions"]):
        clone.counts.intentions += 1
        intention.id = clone.counts.intentions
        clone.alive[intention.id] = intention
        clone.note_plans(intention)
    clone.architecture.ready()


def _can_be_copied(agent: Circumstance, intention: Intention) -> bool:
    return not (
        intention is agent.current
        or intention.dropped
        or intention.waiting is not None
        or intention.suspended is not None
        or intention.forks
        or intention.outer is not None
        or intention.on_failed is not None
    )
