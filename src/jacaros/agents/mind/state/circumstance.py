"""The state of a mind: beliefs, plans, events, intentions, and what waits.  No behaviour beyond keeping it in order."""

from collections import deque
from collections.abc import Callable, Mapping, Sequence
from dataclasses import InitVar, dataclass, field
from typing import Any, Literal, NamedTuple, Protocol

from jacaros.agents.language.diagnostics import Span
from jacaros.agents.mind.state.act import Architecture, Callers, MindObserver, Percept, SpeechAct
from jacaros.agents.mind.state.belief_base import MANY_NAMES, BeliefTables, Table
from jacaros.agents.mind.state.budget import Budget, Options, budgets
from jacaros.agents.mind.state.intention import (
    EVENT_GOAL,
    EVENT_INTENTION,
    PLAN,
    Event,
    Frame,
    Intention,
    Posted,
)
from jacaros.agents.mind.state.pending import CONDITION, Waiting, Waits, Wanted, is_supervision
from jacaros.agents.mind.state.plan import Engine, Plan
from jacaros.agents.mind.state.plan_library import PlanLibrary, ProgramPlans
from jacaros.agents.mind.state.triggers import EventAnnotations, Goal, Trigger
from jacaros.agents.terms.text import text
from jacaros.agents.terms.unifier import Trail
from jacaros.agents.terms.values import Annotations, Term
from jacaros.runtime.trace import Cause

# The port of a mind to what chooses: which message, event, plan and intention goes first.


class Selections:
    """The selection functions of one agent, as the published semantics have them (S_M, S_E, S_O, S_I).

    These and `jacaros.agents.mind.rules.urgency.Fair` take what came first, `jacaros.agents.mind.rules.urgency.Urgent` what
    is most urgent, and the class of a project what it likes.  Each takes what it chooses out of its queue.

    Attributes:
        plain: at present the first of each queue goes first, so an intention may stay in its turn while nothing else
            needs a cycle. Code that makes it False must set `Incoming.called`.
        chooses: applicable plans are chosen by `select_option`, as with rules in `option_filter`; otherwise the first
            one is taken.
        option_filter: beliefs and rules of the program that filter applicable plans (``select__option/4``).
        urgencies: how urgent events of each kind are; None when they are all alike.
        refused: there were applicable plans for the last event, and none of them was let pass.
    """

    __slots__ = ("agent", "chooses", "option_filter", "plain", "refused", "urgencies")

    urgencies: Mapping[Trigger, int] | None

    def __init__(self, agent: "Circumstance", option_filter: Table) -> None:
        self.agent, self.option_filter = agent, option_filter
        self.plain, self.chooses, self.refused = True, False, False
        self.urgencies = None

    def urgency_of(self, intention: Intention) -> int:
        """Return how urgent an intention is: 0 if none is more urgent than others."""
        del intention
        return 0

    def select_messages(self) -> Sequence[SpeechAct]:
        """Return those that are read in this cycle, of a mailbox that is not empty: the oldest one."""
        return (self.agent.incoming.messages.popleft(),)

    def select_event(self) -> Event | None:
        """Return the event that is handled now, the oldest; None if none is to be."""
        events = self.agent.events
        return events.popleft() if events else None

    def select_option(
        self, goal: Goal, annotations: EventAnnotations, intention: Intention | None
    ) -> Frame | None:
        """Return the frame of the plan that is selected for an event (of that intention, if it is the agent's own)."""
        raise NotImplementedError

    def select_intention(self) -> Intention | None:
        """Return the intention that makes a step now: the one whose last turn is the longest ago."""
        intentions = self.agent.intentions
        return intentions.popleft() if intentions else None

    def rank(self) -> None:
        """Note that an event of an urgent kind is about to be queued, or handled immediately."""

    def note_message(self, message: SpeechAct) -> None:
        """Note a message that is about to be queued."""

    def note_intention(self, intention: Intention) -> None:
        """Note an intention that waited, was suspended or is new, and is about to be queued."""


@dataclass(frozen=True)
class ProjectFunctions:
    """The arithmetic functions of a project.

    Attributes:
        functions: their least and greatest numbers of arguments, by name.
        evaluators: what computes them, by name; None stands for a value that is not known yet.
    """

    functions: Mapping[str, tuple[int, int | None]] = field(default_factory=dict)
    evaluators: Mapping[str, Callable[..., Term]] = field(default_factory=dict)


Sleep = Literal["awake", "drowsy", "asleep"]


@dataclass(slots=True, eq=False)
class Functions:
    """The arithmetic functions that an agent knows beside those of the language.

    Attributes:
        own: those that its program registers, by name.
        project: those of the project.
    """

    own: dict[str, Any] = field(default_factory=dict)
    project: ProjectFunctions = field(default_factory=ProjectFunctions)


@dataclass(slots=True, eq=False)
class Incoming:
    """Input that has not been taken in yet.

    Attributes:
        messages: received.
        percepts: noticed, in groups that belong together.
        tasks: housekeeping for the beginning of the next cycle: functions, and their arguments after the agent.
        called: there may be something to look at besides events and intentions, so no intention stays in its turn: the
            input here, restless conditions that intentions wait for, goal conditions, an observer of steps, or selections
            that are not plain. Code that adds to one of them sets it.
    """

    messages: deque[SpeechAct] = field(default_factory=deque)
    percepts: deque[list[Percept]] = field(default_factory=deque)
    tasks: deque[tuple[Callable[..., None], tuple[object, ...]]] = field(default_factory=deque)
    called: bool = False

    def __bool__(self) -> bool:
        return bool(self.messages or self.percepts or self.tasks)


class StepObserver(Protocol):
    """What may hold an agent before it handles an event or makes a step: a debugger.

    A held agent finishes its reasoning cycle in its next turn, from the point where it was held.
    """

    @property
    def paused(self) -> bool:
        """Whether a held agent must not continue yet."""

    def holds_event(self, agent: Any, event: Event) -> bool:
        """Whether *agent* is held before it selects a plan for *event*."""

    def holds_step(self, agent: Any, intention: Intention) -> bool:
        """Whether *agent* is held before it makes the next step of *intention*."""

    def notes_unhandled(self, agent: Any, goal: Goal, annotations: Annotations) -> None:
        """Hear of a belief change or signal for which *agent* has no plan, so that it need not become an event."""

    def notes_failure(self, agent: Any, intention: Intention, reason: Any) -> None:
        """Hear of the failure (`FailureReason`) of a goal of *intention* before it is handled."""


class HeldEvent(NamedTuple):
    """The event before which an agent is held.

    Attributes:
        event: the event.
        ends_cycle: it is handled at the end of a cycle: an atomic intention has just posted it.
    """

    event: Event
    ends_cycle: bool


@dataclass(slots=True, eq=False)
class Observers:
    """Observers of an agent's goals and reasons.

    Attributes:
        goal: called with each goal that changes, or None, see `jacaros.agents.mind.rules.meta_events.observe_goals`.
        lost: called with the description of each lost goal (first line, further lines, place), or None.
        step: may hold the agent before an event or a step, or None, see `jacaros.agents.mind.rules.cycle.observe_steps`.
        mind: observes plans, beliefs and messages, or None; see `jacaros.agents.mind.rules.meta_events.observe_mind`.
        hear_beliefs: whether one of the last two is set.
        callers: hears of goals that callers outside gave, and of events for them, or None.
    """

    goal: Callable[[str, Goal, int, int, str], None] | None = None
    lost: Callable[[str, Sequence[str], Span | None], None] | None = None
    step: StepObserver | None = None
    mind: MindObserver | None = None
    hear_beliefs: bool = False
    callers: Callers | None = None


@dataclass(slots=True, eq=False)
class MindCounts:
    """How much an agent has done.

    Attributes:
        cycles: number of reasoning cycles made.
        intentions: number of intentions so far.
        many_names: with more names of beliefs, those without a belief are dropped.
        next_look: number of the cycle in which percepts and messages are looked at next.
    """

    cycles: int = 0
    intentions: int = 0
    many_names: int = MANY_NAMES
    next_look: int = 0


@dataclass(slots=True, eq=False)
class Features:
    """What is true of all plans and observers of an agent together.

    Attributes:
        meta: plans or an observer react to changes of goal states.
        meta_plans: plans do.
        ends: something is to be done when a plan has ended: states are reported, or conditions are tested.
        edges: there may be plans for falling asleep and awaking.
    """

    meta: bool = False
    meta_plans: bool = False
    ends: bool = False
    edges: bool = False


class _Rules:
    """Rules that the state calls; `jacaros.agents.mind.mind.Mind` has them."""

    __slots__ = ()

    accepts: Callable[[SpeechAct], bool]
    call_own: Callable[[Term], Term]
    observe_rest: Callable[[Intention], None]
    drop_wait: Callable[[Waiting], None]
    end_above: Callable[[Intention, int], None]
    end_wait: Callable[[Waiting], None]
    begin_need: Callable[[Intention, Frame, Wanted], bool]
    notify_listeners: Callable[[Event], None]


@dataclass(slots=True, eq=False, repr=False)
class Circumstance(_Rules):
    """All that an agent holds.

    Attributes:
        name: of the agent.
        architecture: the port to its host.
        options: how it handles events, and what it may use.
        engine: runs plans and rules.
        trail: bindings of the current search; empty between two steps.
        beliefs, library: its beliefs, and its plans.
        functions: its arithmetic functions.
        features: what its plans and options require.
        incoming: input, taken in at the beginning of the next cycle.
        events: the queue of events, oldest first.
        intentions: those that can run, in turn; others are waiting, suspended, or in an event.
        alive: every intention that is not over, by id.
        holders: for each plan with sub-plans the intentions that have, or had, it on their stacks, by id.
        conditioned: the intentions with goal conditions on their stacks, which are tested in each cycle, by id.
        selections: which message, event, plan and intention goes first.
        current: the intention whose step is running.
        atomic: the intention that has an atomic plan on its stack, or None.
        atomic_over: its atomic plan has ended; it still makes its next step before others have their turn.
        outer_frame: frame of the plan whose sub-plans are being tried.
        waits: what intentions wait for, and what has been postponed.
        budgets: limits, by the name of the option.
        observers: observers of goals and reasons.
        counts: how much it has done.
        context: the view of itself that it passes to internal actions.
        held: the event or intention before which an observer holds the agent, in the middle of a reasoning cycle; it is in
            its queue meanwhile. None if the agent is not held.
        running: the agent has its turn: at its end, the host checks whether there is more to do.
        stopped: the agent is over.
        unusual: events take more than the first applicable plan: there are sub-plans, urgent plans, or plans for goal
            states, the program or the project chooses, or an observer listens. It may stay set when that has ended.
        sleep: ``drowsy``: it is idle since it last awoke, and has got the event for it; ``asleep``: its plans for it
            have run.
    """

    name: str
    architecture: Architecture
    options: Options
    plans: InitVar[ProgramPlans]
    trail: Trail = field(default_factory=Trail)
    current: Intention | None = None
    budgets: dict[str, Budget] = field(init=False)
    engine: Engine = field(init=False)
    beliefs: BeliefTables = field(init=False)
    library: PlanLibrary = field(init=False)
    events: deque[Event] = field(default_factory=deque)
    intentions: deque[Intention] = field(default_factory=deque)
    alive: dict[int, Intention] = field(default_factory=dict)
    holders: dict[Plan, dict[int, Intention]] = field(default_factory=dict)
    conditioned: dict[int, Intention] = field(default_factory=dict)
    selections: Selections = field(init=False)
    atomic: Intention | None = None
    atomic_over: bool = False
    incoming: Incoming = field(default_factory=Incoming)
    observers: Observers = field(default_factory=Observers)
    waits: Waits = field(default_factory=Waits)
    features: Features = field(default_factory=Features)
    functions: Functions = field(default_factory=Functions)
    counts: MindCounts = field(default_factory=MindCounts)
    sleep: Sleep = "awake"
    outer_frame: Any = None
    context: Any = None
    held: HeldEvent | Intention | None = None
    running: bool = False
    stopped: bool = False
    unusual: bool = False

    def __post_init__(self, plans: ProgramPlans) -> None:
        self.budgets = budgets(self)
        self.engine = plans.engine
        self.beliefs = BeliefTables(plans.engine, self.options.belief_limit, self.budgets["belief_limit"])
        self.library = PlanLibrary(plans)

    def look_at_observers(self) -> None:
        """Note whether anything observes beliefs, or changes how plans are selected."""
        each = self.observers
        each.hear_beliefs = each.mind is not None or each.step is not None
        self.unusual = bool(
            each.mind is not None
            or self.features.meta
            or self.holders
            or self.selections.urgencies is not None
            or self.selections.chooses
            or self.selections.option_filter.rows
        )

    def warn_of_operand(self, what: str, value: Term) -> None:
        """Warn of an operand that is not a number."""
        self.architecture.log("warning", f"{what} is not a number: {text(value)}")

    def cause_now(self) -> Cause | None:
        """Return the cause of what the agent is doing, as far as it is observed."""
        observer = self.observers.mind
        return None if observer is None else observer.cause()

    def note_plan(self, intention: Intention, plan: Plan) -> None:
        """Note a plan on the stack of an intention that is looked for from outside: by events, or in each cycle."""
        if plan.subplans:
            self.holders.setdefault(plan, {})[intention.id] = intention
            self.unusual = True
        if plan.node.goal_condition is not None:
            self.conditioned[intention.id] = intention
            self.incoming.called = True

    def note_plans(self, intention: Intention) -> None:
        """Note all plans on the stack of a copied or restored intention."""
        for frame in intention.frames:
            if frame[PLAN].special:
                self.note_plan(intention, frame[PLAN])
            elif is_supervision(frame) and frame[CONDITION] is not None:
                self.features.ends = True

    def make_ready(self, intention: Intention) -> None:
        """Let an intention take part in the next cycles; a suspended one once it is resumed."""
        if intention.suspended is None:
            if self.selections.urgencies is not None:
                self.selections.note_intention(intention)
            self.intentions.append(intention)
        if not self.running:
            self.architecture.ready()

    def finish(self, intention: Intention) -> None:
        """End an intention; what it waits for is cancelled."""
        intention.dropped = True
        if intention.frames:
            if self.observers.goal is not None:
                self.observe_rest(intention)
            self.end_above(intention, 0)
            intention.frames.clear()
            intention.handlers.clear()
        self.alive.pop(intention.id, None)
        if self.holders or self.conditioned:
            for held in (self.conditioned, *self.holders.values()):
                held.pop(intention.id, None)
        if self.atomic is intention:
            self.atomic = None
            self.atomic_over = False
        if intention.waiting is not None:
            waiting, intention.waiting = intention.waiting, None
            self.drop_wait(waiting)
        if intention.on_end is not None:
            function, arguments = intention.on_end
            function(self, *arguments)

    def may_handle(self, kind: Trigger) -> bool:
        """Return whether there may be a plan for an event kind (sub-plans are checked when the event is handled)."""
        return self.library.selects[kind] is not None

    def do_soon(self, function: Callable[..., None], *arguments: object) -> None:
        """Call a function with the agent and the arguments at the beginning of the next cycle."""
        self.incoming.tasks.append((function, arguments))
        self.incoming.called = True

    def queue(self, event: Event) -> None:
        """Put an event at the end of the queue."""
        self.note(event[EVENT_GOAL][0])
        self.events.append(event)

    def note(self, kind: Trigger) -> None:
        """Prepare for an event of a kind that is about to be queued or handled."""
        urgencies = self.selections.urgencies
        if urgencies is not None and urgencies[kind]:
            self.selections.rank()

    def post(self, event: Event) -> None:
        """Put an event at the end of the queue, and resume the intentions that wait for it."""
        if (
            len(self.events) >= self.options.event_limit or len(self.alive) >= self.options.intention_limit
        ) and not self._admits(event):
            return
        if self.selections.urgencies is not None:
            self.note(event[EVENT_GOAL][0])
        self.events.append(event)
        if self.waits.events:
            self.notify_listeners(event)

    def post_for(self, intention: Intention, posted: Posted | None) -> None:
        """Queue what an intention continues with, if it does."""
        if posted is not None:
            self.post((posted.goal, intention, posted.annotations, None))
            if not self.running:
                self.architecture.ready()

    def _admits(self, event: Event) -> bool:
        """Return whether an event may still be queued: one that an existing intention waits for may.

        Raises:
            Failure: it may not, and a step posts it.
        """
        if event[EVENT_INTENTION] is not None:
            return True
        if len(self.events) >= self.options.event_limit:
            self.budgets["event_limit"].refuse(len(self.events))
        else:
            self.budgets["intention_limit"].refuse(len(self.alive))
        return False

    def take_out(self, intention: Intention) -> None:
        """Take an intention out of those that can run."""
        if intention in self.intentions:
            self.intentions.remove(intention)

    def is_idle(self) -> bool:
        """Return whether there is nothing to do until input arrives or a timer ends."""
        return not (self.events or self.intentions or self.incoming)
