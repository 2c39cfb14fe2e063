"""A mind as a value: convert its state to data for JSON, and back.

`knowledge` is what an agent believes and its plans. ``.save_agent`` writes it as a program, ``.clone`` gives it to
another agent together with events and intentions (`copy_mind`), and `stored` adds everything else. All of them use the
one walk over the state, `jacaros.bdi.object_table`.

Live Python objects cannot be stored (`NotStorable`): coroutines of the project that an intention waits for, goals and
conditions that Python code awaits, and opaque objects in terms.
"""

from collections import deque
from typing import Any

from jacaros.bdi.mind import Mind
from jacaros.bdi.object_table import Reader, Writer
from jacaros.bdi.rules import preemption, urgency
from jacaros.bdi.rules.pending import look_again, now, start_alarm
from jacaros.bdi.rules.plan_changes import look_at_plans
from jacaros.bdi.state.act import Completion
from jacaros.bdi.state.belief_base import take_away
from jacaros.bdi.state.circumstance import Circumstance
from jacaros.bdi.state.event import EVENT_INTENTION
from jacaros.bdi.state.intention import Intention
from jacaros.terms.values import SOURCE_PERCEPT, String, atom, functor

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
    from jacaros.bdi.rules import deriving  # imported here and below: few minds are stored or copied

    now(mind)  # the latest time is stored
    held = knowledge(mind)
    held |= {name: getattr(mind, name) for name in _FIELDS}
    held["held_percepts"], held["blamed"] = mind.beliefs.held_percepts, mind.library.blamed
    held |= {name: list(getattr(mind, name)) for name in _QUEUES}
    held["refused"] = {name: (each.refusals, each.losses) for name, each in mind.budgets.items()}
    held["derived"] = deriving.stored(mind, mind.program)
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
    from jacaros.bdi.rules import deriving

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
    deriving.resume(mind, mind.program, held.get("derived"))
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
        preemption.resume(mind, number)
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
    from jacaros.bdi.rules import deriving

    part = knowledge(original)
    part["events"] = [
        event
        for event in original.events
        if (intention := event[EVENT_INTENTION]) is None or _can_be_copied(original, intention)
    ]
    part["intentions"] = [each for each in original.intentions if _can_be_copied(original, each)]
    part["derived"] = deriving.stored(original, original.program)
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
    deriving.resume(clone, clone.program, held["derived"])
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
