"""Internal actions on goals and intentions, and `.wait`."""

import re
from collections.abc import Callable, Iterator
from typing import TYPE_CHECKING, Any, TypeVar

from jacaros.agents.language import nodes
from jacaros.agents.language.lowering import lower
from jacaros.agents.language.nodes import walk
from jacaros.agents.mind.actions.internal_action import WrongArguments, internal_action
from jacaros.agents.mind.rules import deadlines, goals
from jacaros.agents.mind.rules.body_steps import bindings_of, is_body_frame, trigger_of
from jacaros.agents.mind.rules.clr_int import achieve, pending_event
from jacaros.agents.mind.rules.context import Context
from jacaros.agents.mind.rules.failure_reason import code_place, nowhere, shown_goal
from jacaros.agents.mind.rules.goals import post_external
from jacaros.agents.mind.rules.pending import listen, now, set_alarm, watch
from jacaros.agents.mind.state.intention import (
    ANNOTATIONS,
    EVENT_GOAL,
    GOAL,
    PLAN,
    STEP,
    Frame,
    Intention,
    variables_of,
)
from jacaros.agents.mind.state.pending import Waiting, is_action, is_supervision
from jacaros.agents.mind.state.plan import SUSPENDED, Failure
from jacaros.agents.mind.state.triggers import Trigger, literal_of
from jacaros.agents.terms.order import annotation_set
from jacaros.agents.terms.plans import BODY_TERM, make_body, trigger
from jacaros.agents.terms.substitution import rename, resolve
from jacaros.agents.terms.text import text
from jacaros.agents.terms.values import (
    Annotated,
    String,
    Term,
    Var,
    atom,
    bare,
    functor,
    functor_of,
    make_list,
    structure,
)

if TYPE_CHECKING:
    from datetime import datetime


T = TypeVar("T")

ERROR, ERROR_MSG, REASON = functor("error", 1), functor("error_msg", 1), functor("reason", 1)


def _on_goal(ctx: Context, goal: Term, act: Callable[[Term], T]) -> T:
    """Apply *act* to all matching goals; the variables of *goal* are bound as in the first one.

    Returns the result of *act*: true if the calling intention itself was cut.
    """
    wanted = _goal(goal)
    first = goals.first_match(ctx.agent, wanted)
    own = act(wanted)
    if first is not None and not own:
        ctx.unify(goal, first)
    return own


def _goal(term: Term) -> Term:
    if functor_of(term) is None:
        raise WrongArguments(f"a goal must be a literal, not {text(term)}")
    return term


def _matches_goal(ctx: Context, goal: Term, literal: Term, identity: Term, number: int | None) -> bool:
    if identity is None:
        return ctx.unify(goal, literal)
    return number is not None and ctx.unify_all((goal, literal), (identity, float(number)))


@internal_action(".desire", arity=(1, 2), backtracks=True, pure=True)
def desire(ctx: Context, goal: Term, identity: Term = None) -> Iterator[None]:
    """``.desire(G [,Id])``: *G* is a goal of the agent, begun or not."""
    for literal, number in list(goals.desires(ctx.agent)):
        if _matches_goal(ctx, goal, literal, identity, number):
            yield


@internal_action(".intend", arity=(1, 2), backtracks=True, pure=True)
def intend(ctx: Context, goal: Term, identity: Term = None) -> Iterator[None]:
    """``.intend(G [,Id])``: *G* is a goal on the stack of an intention that is not suspended."""
    for literal, number in list(goals.intended(ctx.agent)):
        if _matches_goal(ctx, goal, literal, identity, number):
            yield


@internal_action(".intention", arity=(2, 4), backtracks=True, pure=True)
def intention(
    ctx: Context, number: Term, state: Term, stack: Term = None, which: Term = None
) -> Iterator[None]:
    """``.intention(Id, State [,Stack [,current]])``: each intention, with its state and stack."""
    only_current = which is not None and bare(which) is atom("current")
    for candidate in list(ctx.agent.alive.values()):
        running = candidate is ctx.agent.current
        if only_current and not running:
            continue
        pairs = [(number, float(candidate.id)), (state, _state(candidate))]
        if stack is not None:
            pairs.append((stack, _stack(ctx, candidate)))
        if ctx.unify_all(*pairs):
            yield


def _state(candidate: Intention) -> Term:
    if candidate.state != "waiting":
        return atom(candidate.state)
    inner = bare(candidate.waiting.reason)
    reason = inner if is_action(inner) else (REASON, candidate.waiting.reason)
    return Annotated(atom("waiting"), (reason,))


def _stack(ctx: Context, intention: Intention) -> Term:
    """Return the list of an intention's plans, the running one first."""
    frames = [frame for frame in intention.frames if not is_supervision(frame)]
    called = [frame[GOAL][0] for frame in frames[1:]]
    event = pending_event(ctx.agent, intention)
    called.append(event[EVENT_GOAL][0] if event is not None else None)
    return make_list([_means(ctx, frame, above) for frame, above in zip(frames, called, strict=True)][::-1])


def _means(ctx: Context, frame: Frame, called: Trigger | None) -> Term:
    """Return ``im(Label, {Trigger}, {Body}, Bindings)`` of one frame; the body is the rest that is still to run.

    *called* is the trigger of the goal that the frame waits for, which is still part of the body; or None.
    """
    plan = frame[PLAN]
    kind = frame[GOAL][0]
    goal = resolve(literal_of(frame[GOAL], frame[ANNOTATIONS]))
    rest = make_body(
        [_lowered(frame, node) for node in (*_calling(frame, called), *_remaining(frame[STEP]))],
        symbol=BODY_TERM,
    )
    event = trigger(kind.operator + kind.kind, goal)
    label = ctx.agent.library.label(plan)
    span = plan.node.span
    if span is not None:
        label = Annotated(label.term, annotation_set((*label.annotations, *code_place(span, span.file.name))))
    return structure("im", label, event, resolve(rest), bindings_of(frame))


def _lowered(frame: Frame, node: nodes.Node) -> Term:
    """Return a part of a plan as a term, with the variables of a frame."""
    values = variables_of(frame)
    return lower(node, lambda name: values[name] if name in values else Var(name))


def _calling(frame: Frame, called: Trigger | None) -> Iterator[nodes.Node]:
    """Yield the step whose goal the plan waits for."""
    if called is None or called.failing or not called.kind:
        return
    after = frame[STEP].__name__ if frame[STEP] is not None else "None"
    for info in getattr(frame[PLAN].first, "steps", {}).values():
        if info.next == after and _posts(info.node, called):
            yield info.node
            return


def _posts(node: nodes.Node, called: Trigger) -> bool:
    """Return whether a step may be the one that posted a goal."""
    if called.kind == "!":
        posted: nodes.Node | None = (
            node.goal if isinstance(node, nodes.Achieve) and not node.separate else None
        )
    else:
        posted = node.formula if isinstance(node, nodes.Test) else None
    return isinstance(posted, nodes.Variable) or (
        isinstance(posted, nodes.Literal) and posted.functor == called.functor.name
    )


def _remaining(step: Callable[..., object] | None) -> Iterator[nodes.Node]:
    """Yield the formulae from a step on, each once."""
    by_name = dict(getattr(step, "steps", {}))
    name = step.__name__ if step is not None else "None"
    while name in by_name:
        info = by_name.pop(name)
        yield info.node
        name = info.next


@internal_action(".current_intention", arity=1)
def current_intention(ctx: Context, target: Term) -> bool:
    """``.current_intention(I)``: *I* is the calling intention as ``intention(Id, Stack)``."""
    current = ctx.intention
    if current is None:
        return False
    stack = _stack(ctx, current)
    return ctx.unify(target, structure("intention", float(current.id), stack))


@internal_action(".drop_intention", arity=(0, 1), suspends=True)
def drop_intention(ctx: Context, goal: Term = None) -> None:
    """``.drop_intention [(G)]`` drops the calling intention, or all that have the goal, without a failure event."""
    if goal is None:
        assert ctx.intention is not None
        goals.drop_intention(ctx.agent, ctx.intention)
    else:
        _on_goal(ctx, goal, lambda wanted: goals.drop_goal(ctx.agent, wanted))


@internal_action(".drop_future_intention", arity=1, suspends=True)
def drop_future_intention(ctx: Context, goal: Term) -> None:
    """``.drop_future_intention(G)`` drops intentions whose top plan has ``!G`` (or ``!!G``) in its body."""
    wanted = _goal(goal)
    for candidate in list(ctx.agent.alive.values()):
        if candidate.frames and any(goals.matches(ctx.agent, wanted, g) for g in _goals_in(candidate)):
            goals.drop_intention(ctx.agent, candidate)


def _goals_in(candidate: Intention) -> Iterator[Term]:
    frame = candidate.frames[-1]
    for node in walk(frame[PLAN].node.body):
        if isinstance(node, nodes.Achieve):
            yield resolve(_lowered(frame, node.goal))


@internal_action(".drop_event", arity=1, suspends=True)
def drop_event(ctx: Context, goal: Term) -> None:
    """``.drop_event(G)`` drops posted goals that have not been handled yet."""
    _on_goal(ctx, goal, lambda wanted: goals.drop_events(ctx.agent, wanted))


@internal_action(".drop_desire", arity=1, suspends=True)
def drop_desire(ctx: Context, goal: Term) -> None:
    """``.drop_desire(G)`` combines `.drop_event` and `.drop_intention`."""
    _on_goal(ctx, goal, lambda wanted: goals.drop_desire(ctx.agent, wanted))


@internal_action(".drop_all_intentions", arity=0, suspends=True)
def drop_all_intentions(ctx: Context) -> None:
    """``.drop_all_intentions`` drops all intentions except the calling one."""
    goals.drop_all_intentions(ctx.agent)


@internal_action(".drop_all_events", arity=0, suspends=True)
def drop_all_events(ctx: Context) -> None:
    """``.drop_all_events`` drops all pending events."""
    goals.drop_all_events(ctx.agent)


@internal_action(".drop_all_desires", arity=0, suspends=True)
def drop_all_desires(ctx: Context) -> None:
    """``.drop_all_desires`` drops all events, and all intentions except the calling one."""
    goals.drop_all_events(ctx.agent, goals_only=True)
    goals.drop_all_intentions(ctx.agent)


@internal_action(".suspend", arity=(0, 1), suspends=True, body_only=True)
def suspend(ctx: Context, goal: Term = None) -> None:
    """``.suspend [(G)]`` suspends the intentions with the goal (or the calling one) until `.resume`."""
    if goal is None:
        assert ctx.intention is not None
        goals.suspend_intention(ctx.agent, ctx.intention)
    else:
        _on_goal(ctx, goal, lambda wanted: goals.suspend_goal(ctx.agent, wanted))


@internal_action(".resume", arity=1, suspends=True)
def resume(ctx: Context, goal: Term) -> None:
    """``.resume(G)`` resumes suspended intentions with the goal."""
    _on_goal(ctx, goal, lambda wanted: goals.resume_goal(ctx.agent, wanted))


@internal_action(".suspended", arity=2, backtracks=True, pure=True)
def suspended(ctx: Context, goal: Term, reason: Term) -> Iterator[None]:
    """``.suspended(G, R)``: an intention with the goal is suspended or waiting, and *R* is the reason: ``act`` for an
    action, ``suspend_ia`` after ``.suspend``.
    """
    for candidate in goals.intentions_for(ctx.agent, _goal(goal)):
        why = candidate.suspended
        waiting = candidate.waiting
        held = goals.is_preempted(candidate) or (why is not None and waiting is not None and waiting.ended)
        if waiting is not None and not held:
            # As in Jason, an intention that is suspended while it waits is reported with what it waits for.
            why = atom("act") if is_action(waiting.reason) else waiting.reason
        found = goals.goal_of(ctx.agent, candidate, goal)
        if why is not None and found is not None and ctx.unify_all((goal, found), (reason, why)):
            yield
    held = ctx.agent.waits.suspended_events
    if any(event in held for event in goals.goal_events(ctx.agent, goal)) and ctx.unify(
        reason, goals.BY_SUSPEND
    ):
        yield


@internal_action(".succeed_goal", arity=1, suspends=True)
def succeed_goal(ctx: Context, goal: Term) -> object:
    """``.succeed_goal(G)`` ends matching goals as achieved."""
    own = _on_goal(ctx, goal, lambda wanted: goals.succeed_goal(ctx.agent, wanted))
    return _ended(ctx, own)


@internal_action(".fail_goal", arity=1, suspends=True)
def fail_goal(ctx: Context, goal: Term) -> object:
    """``.fail_goal(G)`` ends matching goals as failed; the failure event has ``error_msg``, but no ``error``."""
    told = f".fail_goal{_caller(ctx)} ended it"
    reason = nowhere((ERROR_MSG, String(told)), told=told)
    own = _on_goal(ctx, goal, lambda wanted: goals.fail_goal(ctx.agent, wanted, reason))
    return SUSPENDED if own else None


def _caller(ctx: Context) -> str:
    """Describe the plan of the calling step, for messages."""
    if ctx.intention is None or not ctx.intention.frames:
        return ""
    return f" in the plan of {shown_goal(ctx.intention.frames[-1][GOAL])}"


def _ended(ctx: Context, own: bool) -> object:
    """Handle a cut of the calling intention: its rest continues in the next cycle, not with this step."""
    if not own:
        return None
    agent, current = ctx.agent, ctx.intention
    assert current is not None
    if goals.goes_on(agent, current):
        agent.make_ready(current)
    return SUSPENDED


@internal_action(".done", arity=0, suspends=True)
def done(ctx: Context) -> object:
    """``.done`` ends the goal of the calling plan as achieved."""
    current = ctx.intention
    assert current is not None
    if current.outer is not None and not any(frame[GOAL][0].kind for frame in current.frames):
        return _outer_done(ctx, current)
    achieve(ctx.agent, current, _own_goal(current))
    return _ended(ctx, own=True)


def _own_goal(current: Intention) -> int:
    """Return the index of the frame that `.done` ends.

    That is the plan that calls it, the goal around a reacting sub-plan, or the failed goal if a handler calls it.
    """
    top = next(
        i for i in reversed(range(len(current.frames))) if i == 0 or not is_body_frame(current.frames[i])
    )
    frame = current.frames[top]
    if frame[GOAL][0].failing and current.handlers:
        return current.handlers[-1]
    if not frame[GOAL][0].kind and frame[PLAN].scope is not None:
        return next((i for i, other in enumerate(current.frames) if other[PLAN] is frame[PLAN].scope), top)
    return top


def _outer_done(ctx: Context, current: Intention) -> object:
    """End the goal of the plan around a sub-plan that reacts to an event."""
    assert current.outer is not None
    owner, frame = current.outer
    if not owner.dropped and any(frame is other for other in owner.frames):
        queued = owner in ctx.agent.intentions
        achieve(ctx.agent, owner, next(i for i, other in enumerate(owner.frames) if other is frame))
        if goals.goes_on(ctx.agent, owner) and not queued:
            ctx.agent.make_ready(owner)
    ctx.agent.finish(current)
    return SUSPENDED


@internal_action(".fail", suspends=True)
def fail(ctx: Context, *annotations: Term) -> object:
    """``.fail(a, b…)`` fails, with these annotations on the failure event.

    An ``error(internal_action)`` and an ``error_msg`` are added unless annotations of these names are given.
    """
    del ctx
    if not annotations:
        return False
    given = {functor_of(bare(a)) for a in annotations}
    defaults = ((ERROR, atom("internal_action")), (ERROR_MSG, String("fail")))
    raise Failure(*annotations, *(each for each in defaults if each[0] not in given))


# Internal actions that wait, post events later, and read the run's clock.


TIME, WAIT = functor("time", 1), functor("wait", 1)


@internal_action(".wait", arity=(1, 3), suspends=True, body_only=True, awaits=True)
def wait(ctx: Context, what: Term, limit: Term = None, elapsed: Term = None) -> Any:
    """``.wait(Ms)``, ``.wait({+e} [,Ms [,Elapsed]])``, ``.wait(Condition [,Ms [,Elapsed]])``.

    Waits for a time in milliseconds, for an event, or until a condition holds. After *Ms* milliseconds it fails with
    ``error(wait_timeout)``, unless *Elapsed* is given: then it succeeds, and *Elapsed* is the time waited, in
    milliseconds.
    """
    if limit is not None and limit.__class__ is not float:
        raise WrongArguments(f"the timeout must be a number of milliseconds, not {text(limit)}")
    agent = ctx.agent
    if what.__class__ is float:
        timed = _begin(ctx, (TIME, what), elapsed)
        timed.pending.append(set_alarm(agent, what / 1000.0, deadlines.come_true, timed))
        return timed
    found = trigger_of(what)
    if found is not None:
        waiting = _begin(ctx, rename(found[1]), elapsed)
        waiting.pending.append(listen(agent, *found[:2], deadlines.come_true, waiting))
    elif ctx.succeeds(what):
        return None if elapsed is None else ctx.unify(elapsed, 0.0)
    else:
        waiting = _begin(ctx, rename(what), elapsed)
        waiting.pending.append(watch(agent, what, deadlines.see_condition, waiting))
    if limit is not None:
        waiting.pending.append(set_alarm(agent, limit / 1000.0, deadlines.time_out, waiting))
    return waiting


def _begin(ctx: Context, awaited: Term, elapsed: Term) -> Waiting:
    """Begin to wait. The reason is that of Jason: the number of the intention, and what it waits for."""
    intention = ctx.suspendable()
    reason = Annotated((WAIT, float(intention.id)), (awaited,))
    return Waiting(intention, reason, began=now(ctx.agent), elapsed=elapsed)


_UNITS = {"": 0.001, "ms": 0.001, "s": 1.0, "m": 60.0, "h": 3600.0, "d": 86400.0}
_MOMENT = re.compile(r"\s*now\s*(?:\+\s*([0-9.]+)\s*([a-z]*))?\s*$")


def _unit(word: str) -> str | None:
    for known in ("second", "minute", "hour", "day"):
        if word.rstrip("s") == known:
            return known[0]
    return word if word in _UNITS else "ms" if word.startswith("milli") else None


@internal_action(".at", arity=2)
def at(ctx: Context, moment: Term, event: Term) -> None:
    """``.at("now +5 s", {+!g})`` posts an event later; units ms (the default), s, m, h and d.

    ``.drop_all_intentions`` cancels it.
    """
    found = trigger_of(event)
    match = _MOMENT.match(str(moment)) if moment.__class__ is String else None
    unit = _unit(match.group(2) or "") if match else None
    if found is None or found[0] is None or match is None or unit is None:
        raise WrongArguments('.at expects a moment such as "now +5 s" and an event such as {+!g}')
    delay = float(match.group(1) or 0) * _UNITS[unit]
    set_alarm(ctx.agent, delay, post_external, found[0], rename(found[1]))


@internal_action(".signal", arity=(1, 2))
def signal(ctx: Context, event: Term, kind: Term = None) -> None:
    """``.signal({+e})`` posts an event without changing beliefs."""
    del kind
    found = trigger_of(event)
    if found is None or found[0] is None:
        raise WrongArguments(".signal expects an event such as {+e}")
    post_external(ctx.agent, found[0], found[1])


@internal_action(".time", arity=(3, 4), pure=True)
def time(ctx: Context, hour: Term, minute: Term, second: Term, *millisecond: Term) -> bool:
    """``.time(H, M, S[, Ms])``: the time of day in UTC, as integers. Fails if the arguments are another time."""
    now = _now(ctx)
    parts = (now.hour, now.minute, now.second, now.microsecond // 1000)
    asked = (hour, minute, second, *millisecond)
    return ctx.unify(make_list(asked), make_list([float(part) for part in parts[: len(asked)]]))


@internal_action(".date", arity=3, pure=True)
def date(ctx: Context, year: Term, month: Term, day: Term) -> bool:
    """``.date(Y, M, D)``: the date in UTC, month and day counted from 1. Fails if the arguments are another date."""
    now = _now(ctx)
    return ctx.unify(
        make_list((year, month, day)), make_list([float(now.year), float(now.month), float(now.day)])
    )


@internal_action(".nano_time", arity=1, pure=True)
def nano_time(ctx: Context, nanoseconds: Term) -> bool:
    """``.nano_time(T)``: *T* is the number of nanoseconds since the Unix epoch, with the precision of a double."""
    return ctx.unify(nanoseconds, float(round(ctx.architecture.now() * 1e9)))


def _now(ctx: Context) -> "datetime":
    """The present in UTC, not in local time: programs behave the same everywhere, and on a virtual clock."""
    from datetime import UTC, datetime  # imported here: few programs ask for the time

    return datetime.fromtimestamp(ctx.architecture.now(), UTC)
