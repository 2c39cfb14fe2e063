"""Query and control goals and intentions, wherever they are: running, in an event, waiting, suspended."""

from collections.abc import Callable, Iterator

from jacaros.agents.mind.actions.internal_action import ActionError
from jacaros.agents.mind.rules import deadlines, failure, meta_events, needs
from jacaros.agents.mind.rules.clr_int import achieve, cut_out, pending_event, pop_finished, remove_event
from jacaros.agents.mind.rules.cycle import announce
from jacaros.agents.mind.rules.deadlines import supervised
from jacaros.agents.mind.rules.failure import release_bindings
from jacaros.agents.mind.rules.failure_reason import FailureReason, nowhere
from jacaros.agents.mind.rules.pending import cancel, watch
from jacaros.agents.mind.state.belief_base import parts
from jacaros.agents.mind.state.circumstance import Circumstance
from jacaros.agents.mind.state.intention import (
    ANNOTATIONS,
    EVENT_ANNOTATIONS,
    EVENT_CAUSE,
    EVENT_GOAL,
    EVENT_INTENTION,
    FIRST_SLOT,
    GOAL,
    SERIAL,
    STEP,
    Event,
    Frame,
    Intention,
    event_literal,
)
from jacaros.agents.mind.state.pending import CONDITION, SUPERVISION, holders_below
from jacaros.agents.mind.state.plan import hidden_plan
from jacaros.agents.mind.state.triggers import Goal, Trigger, literal_of, own_annotations, trigger
from jacaros.agents.terms.substitution import rename
from jacaros.agents.terms.unifier import undo, unify
from jacaros.agents.terms.values import BY_SELF, Term, atom, functor, structure
from jacaros.runtime.trace import Cause

BY_SUSPEND, _BY_RESUME = atom("suspend_ia"), atom("resume_ia")
PREEMPTED = functor("preempted", 1)
"""Functor of the reason of intentions that have lost a resource; they are resumed when they regain it."""


def goal_literals(intention: Intention) -> list[Term]:
    """Return the achievement goals on the stack, top first."""
    return [
        literal_of(frame[GOAL], frame[ANNOTATIONS])
        for frame in reversed(intention.frames)
        if _is_goal(frame[GOAL])
    ]


def frame_of(agent: Circumstance, intention: Intention, goal: Term) -> int | None:
    """Return the index of the lowest frame that serves a matching goal, without binding variables."""
    for index, frame in enumerate(intention.frames):
        if _is_goal(frame[GOAL]) and matches(agent, goal, literal_of(frame[GOAL], frame[ANNOTATIONS])):
            return index
    return None


def matches(agent: Circumstance, pattern: Term, literal: Term) -> bool:
    trail = agent.trail
    mark = len(trail)
    found = unify(pattern, literal, trail)
    undo(trail, mark)
    return found


def intentions_for(agent: Circumstance, goal: Term) -> list[Intention]:
    """Return the intentions that pursue the goal at any depth, or are about to."""
    return [each for each in list(agent.alive.values()) if goal_of(agent, each, goal) is not None]


def goal_of(agent: Circumstance, intention: Intention, goal: Term) -> Term | None:
    """Return the matching goal of an intention: the lowest on its stack, or the posted one; None if no goal matches."""
    index = frame_of(agent, intention, goal)
    if index is not None:
        frame = intention.frames[index]
        return literal_of(frame[GOAL], frame[ANNOTATIONS])
    event = pending_event(agent, intention)
    if event is None or not _is_goal(event[EVENT_GOAL]):
        return None
    literal = event_literal(event)
    return literal if matches(agent, goal, literal) else None


def first_match(agent: Circumstance, goal: Term) -> Term | None:
    """Return the first matching goal, of intentions or events; renamed, as its intention may end."""
    for intention in list(agent.alive.values()):
        found = goal_of(agent, intention, goal)
        if found is not None:
            return rename(found)
    for event in goal_events(agent, goal):
        return rename(event_literal(event))
    return None


def _is_goal(goal: Goal) -> bool:
    return goal[0].kind == "!" and goal[0].operator == "+"


def goal_events(agent: Circumstance, goal: Term) -> list[Event]:
    """Return matching events of new goals (without intention)."""
    return [
        e
        for e in _pending_events(agent)
        if e[EVENT_INTENTION] is None and _is_goal(e[EVENT_GOAL]) and matches(agent, goal, event_literal(e))
    ]


def desires(agent: Circumstance) -> Iterator[tuple[Term, int | None]]:
    """Yield all goals: of pending events and of intentions, with the id of the intention."""
    for event in _pending_events(agent):
        if _is_goal(event[EVENT_GOAL]):
            owner = event[EVENT_INTENTION]
            yield event_literal(event), owner.id if owner else None
    yield from intended(agent, include_suspended=True)


def intended(agent: Circumstance, include_suspended: bool = False) -> Iterator[tuple[Term, int | None]]:
    """Yield goals on the stacks of intentions, with the id of the intention."""
    for intention in list(agent.alive.values()):
        if include_suspended or intention.suspended is None:
            for literal in goal_literals(intention):
                yield literal, intention.id


# --- dropping ----------------------------------------------------------------------------------------------


def drop_intention(agent: Circumstance, intention: Intention) -> None:
    """Drop an intention without failure events; what it waits for is cancelled."""
    if agent.features.meta:
        for frame in intention.frames:
            meta_events.goal_state(agent, frame[GOAL], frame[ANNOTATIONS], "dropped")
            meta_events.goal_state(agent, frame[GOAL], frame[ANNOTATIONS], "finished")
    event = pending_event(agent, intention)
    if event is not None:
        remove_event(agent, event)
    agent.finish(intention)


def _pending_events(agent: Circumstance) -> list[Event]:
    """Return the events that are queued, and those of suspended goals and intentions."""
    return [*agent.events, *agent.waits.suspended_events]


def drop_events(agent: Circumstance, goal: Term) -> None:
    """Drop events of matching goals, with the intentions that posted them."""
    for event in goal_events(agent, goal):
        _drop_event(agent, event)
        _event_state(agent, event, "dropped", "finished")
    for event in _pending_events(agent):
        if (
            event[EVENT_INTENTION] is not None
            and _is_goal(event[EVENT_GOAL])
            and matches(agent, goal, event_literal(event))
        ):
            _drop_event(agent, event)


def _drop_event(agent: Circumstance, event: Event) -> None:
    """Drop an event, with the intention that posted it."""
    remove_event(agent, event)
    intention = event[EVENT_INTENTION]
    if intention is not None:
        drop_intention(agent, intention)


def drop_goal(agent: Circumstance, goal: Term) -> None:
    """``.drop_intention(G)``: drop whole intentions that have the goal."""
    for intention in intentions_for(agent, goal):
        drop_intention(agent, intention)


def drop_desire(agent: Circumstance, goal: Term) -> None:
    """``.drop_desire(G)``: drop intentions and pending events."""
    drop_events(agent, goal)
    drop_goal(agent, goal)


def drop_all_intentions(agent: Circumstance) -> None:
    """Drop all intentions except the running one, and cancel pending events of ``.at``."""
    for alarm in list(agent.waits.alarms.values()):
        if alarm.function is post_external:
            cancel(agent, alarm)
    for intention in list(agent.alive.values()):
        if intention is not agent.current:
            drop_intention(agent, intention)


def drop_all_events(agent: Circumstance, goals_only: bool = False) -> None:
    """Drop all pending events, or those of goals, with the intentions that posted them."""
    for event in _pending_events(agent):
        if not goals_only or _is_goal(event[EVENT_GOAL]):
            _drop_event(agent, event)
    if not goals_only:
        agent.waits.requeued.clear()


def _event_state(agent: Circumstance, event: Event, *states: str) -> None:
    if agent.features.meta:
        for state in states:
            meta_events.goal_state(agent, event[EVENT_GOAL], event[EVENT_ANNOTATIONS], state)


# --- suspending --------------------------------------------------------------------------------------------


def suspend_goal(agent: Circumstance, goal: Term) -> None:
    """Suspend all intentions with the goal until it is resumed; a goal that has not begun yet does not begin."""
    for event in goal_events(agent, goal):
        if event in agent.events:
            agent.events.remove(event)
            agent.waits.suspended_events.append(event)
            meta_events.goal_state(
                agent, event[EVENT_GOAL], event[EVENT_ANNOTATIONS], "suspended", BY_SUSPEND
            )
    for intention in intentions_for(agent, goal):
        suspend_intention(agent, intention)


def is_preempted(intention: Intention) -> bool:
    """Return whether an intention is suspended because it has lost a resource."""
    reason = intention.suspended
    return reason.__class__ is tuple and reason[0] is PREEMPTED


def suspend_intention(agent: Circumstance, intention: Intention, reason: Term = BY_SUSPEND) -> None:
    """Suspend one intention: a pausable external action is paused, and resources are given back.

    One that has lost a resource is from now on suspended for the program's reason: it waits for ``.resume``.
    """
    if intention.suspended is not None and not is_preempted(intention):
        return
    intention.suspended = reason
    if intention.on_wait is not None:
        intention.on_wait()
    agent.incoming.called = True  # an intention that suspends itself ends its turn
    agent.take_out(intention)
    if agent.features.meta:
        for frame in reversed([*meta_events.live_frames(intention)]):
            meta_events.frame_state(agent, intention, frame, "suspended", reason)
    if reason is BY_SUSPEND:
        for need in needs.of(agent, intention):
            agent.architecture.suspend_act(need.number)
    event = pending_event(agent, intention)
    if event is not None and event in agent.events:
        agent.events.remove(event)
        agent.waits.suspended_events.append(event)
    act = None if intention.waiting is None else intention.waiting.act
    # An action that has lost a resource is paused already, until it regains it; other waits go on.
    if act is not None and (reason is BY_SUSPEND or act not in agent.waits.preempted):
        agent.architecture.suspend_act(act)


def resume_goal(agent: Circumstance, goal: Term) -> None:
    """Resume all intentions with the goal, the reverse of `suspend_goal`."""
    for event in list(agent.waits.suspended_events):
        if event[EVENT_INTENTION] is None and matches(agent, goal, event_literal(event)):
            meta_events.goal_state(agent, event[EVENT_GOAL], event[EVENT_ANNOTATIONS], "resumed", _BY_RESUME)
            _queue_again(agent, event)
    for intention in intentions_for(agent, goal):
        resume_intention(agent, intention)


def resume_intention(agent: Circumstance, intention: Intention, by: Term = _BY_RESUME) -> None:
    """Resume a suspended intention; ``.resume`` has no effect on one that has lost a resource."""
    if intention.suspended is None or (by is _BY_RESUME and is_preempted(intention)):
        return
    intention.suspended = None
    if agent.features.meta:
        for frame in reversed([*meta_events.live_frames(intention)]):
            meta_events.frame_state(agent, intention, frame, "resumed", by)
    if by is _BY_RESUME:
        for need in needs.of(agent, intention):
            agent.architecture.resume_act(need.number)
    held = pending_event(agent, intention)
    if held is not None:
        _queue_again(agent, held)
    elif intention.waiting is not None:
        deadlines.resume(agent, intention.waiting)
    else:
        agent.make_ready(intention)
        if agent.features.meta:
            meta_events.top_goal_state(agent, intention, "executing")


def _queue_again(agent: Circumstance, event: Event) -> None:
    """Queue the event of a resumed goal or intention, as if it were new."""
    goal, intention, annotations, _ = event
    remove_event(agent, event)
    agent.queue(event)
    announce(agent, intention, goal, annotations)
    agent.architecture.ready()


# --- ending goals from outside -----------------------------------------------------------------------------


def succeed_goal(agent: Circumstance, goal: Term) -> bool:
    """End matching goals as achieved, periodic ones for good: their callers continue.

    Return True if the running intention is concerned.
    """
    own = False
    for intention in intentions_for(agent, goal):
        if intention.dropped:  # the branch of a fork above the goal, which has ended with another branch
            continue
        index = frame_of(agent, intention, goal)
        running = intention is agent.current
        queued = intention in agent.intentions
        _end_for_good(intention, len(intention.frames) if index is None else index)
        if index is None:
            event = pending_event(agent, intention)
            if event is not None:
                remove_event(agent, event)
        else:
            achieve(agent, intention, index)
        if running:
            own = True
        elif goes_on(agent, intention) and not queued:
            agent.make_ready(intention)
    for event in goal_events(agent, goal):
        remove_event(agent, event)
        _event_state(agent, event, "achieved", "finished")
    return own


def goes_on(agent: Circumstance, intention: Intention) -> bool:
    if not intention.frames:
        agent.finish(intention)
        return False
    return pop_finished(agent, intention)


def fail_goal(agent: Circumstance, goal: Term, reason: FailureReason | None = None) -> bool:
    """End matching goals as failed: their own handlers run, or those below. Return True if the caller is concerned.

    A periodic goal is not pursued again. Without *reason* the failure events have no error annotation, as in Jason.
    """
    reason = reason or nowhere()
    own = False
    for intention in intentions_for(agent, goal):
        if intention.dropped:  # the branch of a fork above the goal, which has ended with another branch
            continue
        index = frame_of(agent, intention, goal)
        _end_for_good(intention, len(intention.frames) if index is None else index)
        if index is None:
            event = pending_event(agent, intention)
            if event is not None:
                _fail_event(agent, intention, event, reason)
            continue
        own = own or intention is agent.current
        frame = intention.frames[index]
        ended = reason.interrupted(intention.frames[index:])
        release_bindings(frame[GOAL], frame[SERIAL])
        failure.observe_failed(agent, intention, index + 1, ended)
        cut_out(agent, intention, index)
        posted = failure.fail_goal(agent, intention, frame[GOAL], frame[ANNOTATIONS], ended, frame[SERIAL])
        agent.post_for(intention, posted)
    for event in goal_events(agent, goal):
        _fail_event(agent, Intention(agent, event[EVENT_CAUSE]), event, reason)
    return own


def _fail_event(agent: Circumstance, intention: Intention, event: Event, reason: FailureReason) -> None:
    """Fail a goal that was posted and not handled yet."""
    goal, _, annotations, _ = event
    remove_event(agent, event)
    agent.post_for(intention, failure.fail_goal(agent, intention, goal, annotations, reason))


def _end_for_good(intention: Intention, index: int) -> None:
    """Let the goal at *index* (or one about to get a frame there) end without a test, and without a further period."""
    for holder in holders_below(intention, index):
        holder[SUPERVISION].period = holder[CONDITION] = None


def post_external(agent: Circumstance, kind: Trigger, literal: Term) -> None:
    """Post an external event, as ``.at`` and ``.signal`` do."""
    _, arguments, annotations = parts(rename(literal))
    agent.post(((kind, *arguments), None, own_annotations(annotations), None))
    agent.architecture.ready()


# Goals and conditions that code outside the mind watches, with a callback for their end.  No stored mind holds them.


_WATCHED = trigger("+", "", functor("watched", 0, namespace="jacaros"))
_BOTTOM = hidden_plan(atom("watched"))


def _nothing() -> None:
    """Do nothing."""


class WatchedGoal:
    """An achievement goal in an intention of its own, with a callback for its end.

    The bottom frame of the stack is reached when the goal is achieved. It is copied with the stack when the plan forks,
    so the branch that continues reaches it.

    Args:
        agent: the agent that adopts the goal.
        goal: an atom or structure.
        on_end: called when the goal is achieved or has failed.
        on_dropped: called when it is over without having been achieved or having failed.
        cause: what led to it, outside the agent.
        on_wait: called whenever an intention that pursues it begins to wait or is suspended.

    Attributes:
        identity: what the bottom frame of its intentions serves.
        arguments: of the goal. When it is achieved, they have their values.
        achieved: the goal was achieved.
        failed: it failed, and no plan handled the failure.
        reason: why it failed, None if that is not known.
        first: the intention that began to pursue it.

    Raises:
        ActionError: *goal* is not a literal.
    """

    def __init__(
        self,
        agent: Circumstance,
        goal: Term,
        on_end: Callable[[], None] = _nothing,
        on_dropped: Callable[[], None] = _nothing,
        cause: Cause | None = None,
        on_wait: Callable[[], None] | None = None,
    ) -> None:
        symbol, arguments, annotations = parts(rename(goal))
        if symbol is None:
            raise ActionError("a goal must be a literal")
        self.agent = agent
        self.achieved = False
        self.failed = False
        self.reason: FailureReason | None = None
        self._on_end, self._on_dropped = on_end, on_dropped
        posted = (trigger("+", "!", symbol), *arguments)
        self.arguments = arguments
        self.identity = (_WATCHED, float(id(self)))
        self.first = intention = Intention(agent, cause)
        intention.on_failed, intention.on_end = (self._intention_failed, ()), (self._intention_ended, ())
        intention.on_wait = on_wait
        frame: Frame = [self._reached, self.identity, BY_SELF, agent.trail.serial, _BOTTOM, *arguments]
        intention.frames.append(frame)
        given = own_annotations(annotations)
        agent.post((supervised(agent, intention, posted, given), intention, given, cause))
        agent.architecture.ready()

    @property
    def ended(self) -> bool:
        """Whether the goal was achieved or has failed."""
        return self.achieved or self.failed

    def intentions(self) -> list[Intention]:
        """The intentions that pursue the goal: one, none when it has ended or was dropped, several after a fork."""
        return [
            intention
            for intention in self.agent.alive.values()
            if intention.frames and intention.frames[0][GOAL] == self.identity
        ]

    def _reached(self, agent: Circumstance, frame: Frame) -> None:
        del agent
        frame[STEP] = None
        self.achieved, self.arguments = (
            True,
            tuple(frame[FIRST_SLOT:]),
        )  # of the branch that continues after a fork
        self._on_end()

    def _intention_failed(self, _: Circumstance, reason: FailureReason | None) -> None:
        self.failed = True
        self.reason = reason
        self._on_end()

    def _intention_ended(self, _: Circumstance) -> None:
        if not (self.ended or self.intentions()):
            self._on_dropped()


class WatchedCondition:
    """A condition of an agent, with a callback for when it holds or cannot be evaluated (then with the exception)."""

    def __init__(
        self, agent: Circumstance, condition: Term, on_end: Callable[[Exception | None], None]
    ) -> None:
        self._agent, self._on_end = agent, on_end
        self._watch = watch(agent, condition, self._ended)
        agent.architecture.ready()

    def _ended(self, _: Circumstance, fault: Exception | None) -> None:
        self._on_end(fault)

    def forget(self) -> None:
        """End the watch; no effect if it has ended."""
        cancel(self._agent, self._watch)


# Intentions that have lost a resource to a more urgent claim: suspended, and resumed when they regain it.


def suspend(agent: Circumstance, number: int, resource: str) -> None:
    """Suspend the intentions with an act, or with a plan that needs something, which has lost a resource."""
    owners = _owners(agent, number)
    if not owners:
        return
    reason = structure("preempted", atom(resource))
    agent.waits.preempted[number] = (reason, owners)
    for intention in owners:
        if intention.suspended is None:
            suspend_intention(agent, intention, reason)


def resume(agent: Circumstance, number: int) -> None:
    """Resume the intentions that were suspended because an act had lost a resource."""
    known = agent.waits.preempted.pop(number, None)
    if known is None:
        return
    reason, owners = known
    for intention in owners:
        if not intention.dropped and is_preempted(intention):
            others = agent.waits.preempted.values()
            other = next((lost for lost, of in others if intention in of), None)
            if other is None:
                resume_intention(agent, intention, by=reason)
            else:
                intention.suspended = other


def _owners(agent: Circumstance, number: int) -> list[Intention]:
    """Return the intentions with that act, or with the frame that needs it."""
    waiting = agent.waits.acts.get(number)
    if waiting is not None:
        return [waiting.intention]
    need = agent.waits.needs.get(number)
    return [] if need is None else [each for each in agent.alive.values() if need.is_on(each)]
