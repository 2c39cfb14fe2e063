"""A mind as a value: written as a pickle that makes only what a mind holds, and read back.

A pickle can call any function of Python. Here it can name a few makers of immutable values (`_MAKERS`) and nothing else.
Everything with a state of its own is made empty by `MindReader` and filled afterwards, so nothing is nested deeply. Plans,
rules and beliefs of the program are written as their places in it, with a digest of their text; a step as its plan and its
position there; plans added at run time as their syntax.
"""

import pickle
from base64 import b64decode, b64encode
from collections import deque
from collections.abc import Callable, Iterable, Iterator, Mapping
from functools import partial
from importlib import import_module
from io import BytesIO
from pickletools import genops
from types import FunctionType, NoneType
from typing import Any
from zlib import crc32

from jacaros.agents.language import nodes
from jacaros.agents.language.diagnostics import SourceFile, Span
from jacaros.agents.mind.mind import Mind
from jacaros.agents.mind.rules import goals, urgency
from jacaros.agents.mind.rules.body_steps import interpreted, plan_of_body
from jacaros.agents.mind.rules.context import RegisteredFunction
from jacaros.agents.mind.rules.failure_reason import FailureReason
from jacaros.agents.mind.rules.goals import WatchedCondition, WatchedGoal
from jacaros.agents.mind.rules.pending import look_again, now, start_alarm
from jacaros.agents.mind.rules.plan_changes import look_at_plans
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
from jacaros.agents.terms.collections import MapValue, QueueValue, SetValue
from jacaros.agents.terms.order import number_of
from jacaros.agents.terms.values import (
    CONS,
    SOURCE_PERCEPT,
    Annotated,
    Functor,
    List,
    Reference,
    String,
    Var,
    atom,
    functor,
    listed,
    make_list,
)
from jacaros.runtime.errors import JacarosError
from jacaros.runtime.trace import Cause

Value = Any
"""Any object in a mind."""
Form = tuple[Any, ...]
"""How `MindReader` makes an object: the name of one of its functions, and the arguments."""
_WHOLE = (
    Annotated,
    MapValue,
    OpenFact,
    QueueValue,
    RegisteredFunction,
    Remaining,
    SetValue,
    SourceFile,
    Span,
    String,
)
"""Classes of values that are made of their parts, whatever mind they are in."""
_NODES = tuple(
    each for each in vars(nodes).values() if isinstance(each, type) and issubclass(each, nodes.Node)
)
_CALLED = frozenset({functor, listed, nodes.remade, trigger})
_MADE_BY: tuple[Any, ...] = (*_WHOLE, *_NODES, *_CALLED, Rule, deque)
_MAKERS = {(each.__module__, each.__qualname__): each for each in _MADE_BY}
"""What a pickle may call: nothing of it has another effect than its result."""
_IN_PLACE = frozenset(
    {*_WHOLE, Functor, List, NoneType, Trigger, bool, deque, dict, float, int, list, set, str, tuple, type}
)
"""Classes whose objects are written where they occur."""
_PACKAGES = tuple(f"jacaros.agents.{each}." for each in ("mind.rules", "mind.state", "terms"))
"""Packages of the classes that have a state, and of the functions that are called later."""
_LIVE = {
    CoroutineWait: "it waits for a coroutine",
    WatchedCondition: "Python code awaits a condition",
    WatchedGoal: "Python code awaits a goal",
    Reference: "a term holds a Python object",
}


class NotStorable(JacarosError):
    """Raised when a mind holds a live Python object."""

    def __init__(self, why: str) -> None:
        super().__init__(f"the mind cannot be stored: {why}")


class Writer(pickle.Pickler):
    """Writes objects of a mind.

    Args:
        shared: for another mind of the same program in this process. Plans, rules, syntax and live
            objects are not copied.

    Attributes:
        objects: those that are written as numbers, by these.
    """

    def __init__(self, mind: Mind, shared: bool = False) -> None:
        self._stream = BytesIO()
        super().__init__(self._stream, protocol=pickle.HIGHEST_PROTOCOL)
        self.objects: list[Value] = []
        self._shared = shared
        self._numbers: dict[int, int] = {}
        self._filled_later: list[Value] = []
        self._places = {id(part): place for place, part in enumerate(parts_of_program(mind))}

    def write(self, value: Value) -> bytes:
        """Return the bytes of a value with everything it refers to.

        Raises:
            NotStorable: it holds a live object, or a term that is nested too deeply.
        """
        try:
            self.dump(value)
            for each in self._filled_later:  # becomes longer meanwhile
                self.dump(dict(_attributes(each)))
        except RecursionError:
            raise NotStorable("a term is nested too deeply") from None
        return self._stream.getvalue()

    def persistent_id(self, value: Value) -> int | Form | None:
        """Return the number of an object, with its form at its first occurrence; None for one that is written in place."""
        if value.__class__ in _IN_PLACE and not _is_open_list(value):
            return None
        number = self._numbers.get(id(value))
        if number is not None:
            return number
        # Two minds of a program may share these.
        shared = self._shared and (isinstance(value, _SHARED) or callable(value))
        form = () if shared else self._form(value)
        if form is None:
            return None
        number = self._numbers[id(value)] = len(self.objects)
        self.objects.append(value)
        return number if shared else (number, *form)

    def _form(self, value: Value) -> Form | None:
        if isinstance(value, Plan | nodes.Node) and id(value) in self._places:
            return "part", self._places[id(value)], _digest(value)
        if isinstance(value, Plan):
            return _form_of_plan(value)
        if isinstance(value, nodes.Node | Rule | type):
            return None
        if _is_open_list(value):
            return "open_list", *_items_and_tail(value)
        if isinstance(value, Cause):
            return ("nothing",)  # of the run that has made it
        if callable(value) and (plan := getattr(value, "plan", None)) is not None:
            return "step", plan, position_of(value)
        _refuse_live(value)
        if isinstance(value, FunctionType):
            return None if value in _CALLED else ("function", *_name_of(value))
        self._filled_later.append(value)
        return "empty", *_name_of(value.__class__)


def _form_of_plan(plan: Plan) -> Form:
    """Return the form of a plan that is not of the program."""
    if plan.body_term is not None:
        return "body", plan.body_term
    if plan.scope is not None:
        return "subplan", plan.scope, plan.scope.subplans.index(plan)
    return "own_plan", plan.node, [each.label for each in every_plan([plan])]


def _is_open_list(value: Value) -> bool:
    """Return whether a value is a list term whose end is not known yet: its pairs may be nested deeply."""
    return value.__class__ is tuple and value[:1] == (CONS,)


def _items_and_tail(term: Value) -> tuple[list[Value], Value]:
    items = []
    while _is_open_list(term):
        _, item, term = term
        items.append(item)
    return items, term


_SHARED = (Cause, Plan, Reference, Rule, nodes.Node)


def _name_of(value: Value) -> tuple[str, str]:
    """Return the module and the name of a function or class of the mind.

    Raises:
        NotStorable: it cannot be found by name.
    """
    name = value.__module__, value.__qualname__
    if _found(*name) is not value:
        raise NotStorable(f"it holds {value!r}")
    return name


def _found(module: str, name: str) -> Value:
    """Return a function or class of the mind; None for another name."""
    found = getattr(import_module(module), name, None) if module.startswith(_PACKAGES) else None
    return found if getattr(found, "__module__", "") == module else None


def _refuse_live(value: Value) -> None:
    """Refuse a live object, or a method of one."""
    for live, why in _LIVE.items():
        if isinstance(getattr(value, "__self__", value), live):
            raise NotStorable(why)


def _attributes(value: Value) -> Iterator[tuple[str, Value]]:
    if isinstance(value, FailureReason):
        value.terms  # noqa: B018 - puts them together
    for kind in value.__class__.__mro__:
        for name in kind.__dict__.get("__slots__", ()):
            if name != "timer" and hasattr(value, name):
                yield name, getattr(value, name)
    yield from getattr(value, "__dict__", {}).items()


class MindReader(pickle.Unpickler):
    """Reads what a `Writer` has written for a mind.

    Args:
        shared: the objects by number that the writer has not copied.
    """

    def __init__(self, mind: Mind, data: bytes, shared: Iterable[Value] = ()) -> None:
        super().__init__(BytesIO(data))
        self._mind = mind
        self._parts = parts_of_program(mind)
        self._made = dict(enumerate(shared))
        self._filled_later: list[Value] = []
        self._forms: Mapping[str, Callable[..., Value]] = {
            "part": self._part,
            "own_plan": self._own_plan,
            "subplan": lambda plan, index: plan.subplans[index],
            "body": partial(plan_of_body, mind),
            "step": mind.engine.step_at,
            "open_list": make_list,
            "function": partial(_named, FunctionType),
            "empty": self._empty,
            "nothing": lambda: None,
        }

    def read(self) -> Value:
        """Return the value.

        Raises:
            ValueError: the program of the mind lacks a plan or belief that is used, or the data contains something that is
                not part of a mind.
        """
        value = self.load()
        for each in self._filled_later:  # becomes longer meanwhile
            for name, part in self.load().items():
                setattr(each, name, part)
        compared = [each for each in self._filled_later if isinstance(each, Var) and hasattr(each, "number")]
        for variable in sorted(compared, key=lambda each: each.number):
            del variable.number  # the order is kept; the number was of another process
            number_of(variable)
        return value

    def find_class(self, module: str, name: str) -> Value:
        """Return what makes an immutable value."""
        if (module, name) not in _MAKERS:
            raise ValueError(f"{module}.{name} is not part of a mind")
        return _MAKERS[module, name]

    def persistent_load(self, form: int | Form) -> Value:
        """Return the object of a number, which is made at its first occurrence."""
        if not isinstance(form, tuple):
            return self._made[form]
        number, kind, *arguments = form
        made = self._made[number] = self._forms[kind](*arguments)
        return made

    def _part(self, place: int, digest: int) -> Plan | nodes.Node:
        """Return a plan or belief of the program; from another place, if the program has changed."""
        for part in (*self._parts[place : place + 1], *self._parts):
            if _digest(part) == digest:
                if (
                    isinstance(part, Plan)
                    and part.node.goal_condition is not None
                    and part.goal_condition is None
                ):
                    interpreted(part)  # a frame whose body has ended needs the condition, but no step
                return part
        raise ValueError("the program has changed: it lacks a plan or belief that the stored mind uses")

    def _own_plan(self, node: nodes.Plan, labels: list[Value]) -> Plan:
        """Make a plan that was added at run time."""
        plan = with_subplans(Plan(node, label_of(node, 0), self._mind.library.by_name), 0)
        for inner, label in zip(every_plan([plan]), labels, strict=True):
            inner.label = label
        return plan

    def _empty(self, module: str, name: str) -> Value:
        kind = _named(type, module, name)
        made = Var() if kind is Var else kind.__new__(kind)
        self._filled_later.append(made)
        return made


def _named(wanted: type, module: str, name: str) -> Value:
    """Return the function or class of that name.

    Raises:
        ValueError: it is not part of a mind.
    """
    found = _found(module, name)
    if found.__class__ is not wanted:
        raise ValueError(f"{module}.{name} is not part of a mind")
    return found


def parts_of_program(mind: Mind) -> list[Plan | nodes.Node]:
    """Return the plans and beliefs of a mind's program, in a fixed order."""
    return [*every_plan(mind.library.program.plans), *mind.program.beliefs]


def _digest(part: Plan | nodes.Node) -> int:
    return crc32(repr(part.node if isinstance(part, Plan) else part).encode())


def _refuse_changes(data: bytes) -> None:
    """Refuse a pickle that sets attributes of what it has made; it could be a class, or shared by all minds."""
    stream = BytesIO(data)
    while stream.tell() < len(data):
        if any(code.name == "BUILD" for code, _, _ in genops(stream)):
            raise ValueError("the data is not that of a stored mind")


# The state of a mind as data for JSON, and back.
#
# `knowledge` is what an agent believes and its plans. ``.save_agent`` writes it as a program, ``.clone`` gives it to
# another agent together with events and intentions (`copy_mind`), and `stored` adds everything else.
#
# Live Python objects cannot be stored (`NotStorable`): coroutines of the project that an intention waits for, goals and
# conditions that Python code awaits, and opaque objects in terms.


FORMAT = 9
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
    held["random"] = mind.architecture.random.getstate()
    return {"format": FORMAT, "agent": mind.name, "mind": b64encode(Writer(mind).write(held)).decode()}


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
    pickled = b64decode(data["mind"])
    _refuse_changes(pickled)
    held = MindReader(mind, pickled).read()
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
    mind.architecture.random.setstate(held["random"])
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
    held = MindReader(clone, writer.write(part), writer.objects).read()
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
