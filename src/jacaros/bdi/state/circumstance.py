"""The state of a mind: beliefs, plans, events, intentions, and what waits.  No behaviour beyond keeping it in order."""

from collections import deque
from collections.abc import Callable, Mapping, Sequence
from types import MappingProxyType
from typing import Any, Final, Literal, NamedTuple, Protocol

from jacaros.asl.source import Span
from jacaros.bdi.architecture import Architecture
from jacaros.bdi.state.act import Percept
from jacaros.bdi.state.belief_base import BeliefTables
from jacaros.bdi.state.budget import SearchBudget, budgets
from jacaros.bdi.state.condition_waits import ConditionWaits
from jacaros.bdi.state.event import EVENT_GOAL, EVENT_INTENTION, Annotations, Event
from jacaros.bdi.state.intention import Frame, Intention
from jacaros.bdi.state.need import Need, Wanted
from jacaros.bdi.state.observing import MindObserver
from jacaros.bdi.state.options import Options
from jacaros.bdi.state.plan_library import PlanLibrary, ProgramPlans
from jacaros.bdi.state.selections import Selections
from jacaros.bdi.state.speech_act import SpeechAct
from jacaros.bdi.state.triggers import Goal, Trigger
from jacaros.bdi.state.waiting import ActWait, Alarm, AnswerWait, EventWaits, TimedWait, Waiting
from jacaros.terms.text import text
from jacaros.terms.unifier import Trail
from jacaros.terms.values import Functor, Term
from jacaros.trace import Cause

INTERVAL = 1_000
"""Reasoning cycles between two looks at the names that an agent uses; more when there are more names."""
CROWD = 2000
"""Intentions that take turns.  With more of them, goals that the agent sets itself (``!!g``) begin one by one."""


class ProjectFunctions(Protocol):
    """The arithmetic functions of a project.

    Attributes:
        functions: their least and greatest numbers of arguments, by name.
        evaluators: what computes them, by name; None stands for a value that is not known yet.
    """

    @property
    def functions(self) -> Mapping[str, tuple[int, int | None]]: ...

    @property
    def evaluators(self) -> Mapping[str, Callable[..., Term]]: ...


class _NoFunctions(NamedTuple):
    functions: Mapping[str, tuple[int, int | None]] = MappingProxyType({})
    evaluators: Mapping[str, Callable[..., Term]] = MappingProxyType({})


NO_FUNCTIONS: Final = _NoFunctions()

Sleep = Literal["awake", "drowsy", "asleep"]


class Functions:
    """The arithmetic functions that an agent knows beside those of the language.

    Attributes:
        own: those that its program registers, by name.
        project: those of the project.
    """

    __slots__ = ("own", "project")

    def __init__(self) -> None:
        self.own: dict[str, Any] = {}
        self.project: ProjectFunctions = NO_FUNCTIONS


class Incoming:
    """Input that has not been taken in yet.

    Attributes:
        messages: received.
        percepts: noticed, in groups that belong together.
        tasks: housekeeping for the beginning of the next cycle: functions, and their arguments after the agent.
        called: there may be something to look at besides events and intentions: the input here, restless conditions that
            intentions wait for, special features of the agent, or selections that are not plain.
            Code that adds to one of them sets it.
    """

    __slots__ = ("called", "messages", "percepts", "tasks")

    def __init__(self) -> None:
        self.messages: deque[SpeechAct] = deque()
        self.percepts: deque[list[Percept]] = deque()
        self.tasks: deque[tuple[Callable[..., None], tuple[object, ...]]] = deque()
        self.called = False

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


class BeliefObserver(Protocol):
    """What derives beliefs from others."""

    def heard(self, operator: str, symbol: Functor, row: tuple[Term, ...], cause: Cause | None) -> None:
        """Hear of a belief that was added (``+``) or deleted (``-``), or of a signal."""


class HeldEvent(NamedTuple):
    """The event before which an agent is held.

    Attributes:
        event: the event.
        ends_cycle: it is handled at the end of a cycle: an atomic intention has just posted it.
    """

    event: Event
    ends_cycle: bool


class Observers:
    """Observers of an agent's goals and reasons.

    Attributes:
        goal: called with each goal that changes, or None, see `jacaros.bdi.rules.meta_events.observe_goals`.
        lost: called with the description of each lost goal (first line, further lines, place), or None.
        step: may hold the agent before an event or a step, or None, see `jacaros.bdi.rules.holding.observe_steps`.
        mind: observes plans, beliefs and messages, or None; see `jacaros.bdi.rules.meta_events.observe_mind`.
        derived: derives beliefs from others, or None; see `jacaros.bdi.rules.deriving`.
        hear_beliefs: whether one of the last three is set.
        usual_events: the feature of this name before `step` was set.
    """

    __slots__ = ("derived", "goal", "hear_beliefs", "lost", "mind", "step", "usual_events")

    def __init__(self) -> None:
        self.goal: Callable[[str, Goal, int, int, str], None] | None = None
        self.lost: Callable[[str, Sequence[str], Span | None], None] | None = None
        self.step: StepObserver | None = None
        self.mind: MindObserver | None = None
        self.derived: BeliefObserver | None = None
        self.hear_beliefs = self.usual_events = False


class Counts:
    """How much an agent has done.

    Attributes:
        cycles: number of reasoning cycles made.
        intentions: number of intentions so far.
        next_check: number of the cycle after which beliefs are counted, and unused names dropped, next; a look at what
            comes in counts as one.
        next_look: number of the cycle in which percepts and messages are looked at next.
    """

    __slots__ = ("cycles", "intentions", "next_check", "next_look")

    def __init__(self) -> None:
        self.cycles = self.intentions = self.next_look = 0
        self.next_check = INTERVAL


class Waits:
    """What the intentions of an agent wait for, and what has been postponed.

    Attributes:
        events: waits for an event.
        conditions: waits for a condition.
        acts: waits for an external action, by its number.
        questions: waits for an answer, by the id of the question.
        abandoned: ids of questions that no intention waits for: a late answer is discarded.
        alarms: calls that are due at a moment, by number.
        alarms_made: number of alarms so far.
        suspended_events: those of suspended intentions, and of goals that were suspended before they began.
        needs: the resources that plans and goals have requested, by the number of the act.
        preempted: the acts that have lost a resource: why, and the intentions that are suspended for it.
        requeued: external events without plan that are to be tried again (``events=requeue``).
    """

    __slots__ = (
        "abandoned",
        "acts",
        "alarms",
        "alarms_made",
        "conditions",
        "events",
        "needs",
        "preempted",
        "questions",
        "requeued",
        "suspended_events",
    )

    def __init__(self) -> None:
        self.events = EventWaits()
        self.conditions = ConditionWaits()
        self.acts: dict[int, ActWait] = {}
        self.needs: dict[int, Need] = {}
        self.preempted: dict[int, tuple[Term, list[Intention]]] = {}
        self.questions: dict[str, AnswerWait] = {}
        self.abandoned: set[str | None] = set()
        self.alarms: dict[int, Alarm] = {}
        self.alarms_made = 0
        self.suspended_events: list[Event] = []
        self.requeued: list[Event] = []


class Features:
    """What the plans and options of an agent require in each cycle.

    Attributes:
        meta: plans or an observer react to changes of goal states.
        meta_plans: plans do.
        goal_conditions: plans have goal conditions, which are tested in every cycle.
        subplans: plans have plans of their own.
        needs: plans or goals need resources.
        special: meta, goal_conditions, subplans or needs, or an observer of its reasons, or one that may hold the agent.
        edges: there may be plans for falling asleep and awaking.
        usual_events: external events without a plan are skipped, events of belief changes in plans belong to the
            intentions that made them, and no agent class is asked about these changes.
    """

    __slots__ = (
        "edges",
        "goal_conditions",
        "meta",
        "meta_plans",
        "needs",
        "special",
        "subplans",
        "usual_events",
    )

    def __init__(self, options: Options) -> None:
        self.needs = False
        self.meta = self.meta_plans = self.goal_conditions = self.subplans = self.special = self.edges = False
        self.usual_events = options.events == "discard" and not options.new_focus


class Circumstance:
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
        crowd: intentions for goals that the agent set itself while `CROWD` others can run. They join these as others end,
            and one in each turn anyway, so that an agent with more and more goals of its own keeps running its other plans.
        alive: every intention that is not over, by id.
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
        sleep: ``drowsy``: it is idle since it last awoke, and has got the event for it; ``asleep``: its plans for it
            have run.
    """

    __slots__ = (
        "alive",
        "architecture",
        "atomic",
        "atomic_over",
        "beliefs",
        "budgets",
        "context",
        "counts",
        "crowd",
        "current",
        "engine",
        "events",
        "features",
        "functions",
        "held",
        "incoming",
        "intentions",
        "library",
        "name",
        "observers",
        "options",
        "outer_frame",
        "running",
        "selections",
        "sleep",
        "stopped",
        "trail",
        "waits",
    )

    selections: Selections
    accepts: Callable[[SpeechAct], bool]
    call_own: Callable[[Term], Term]
    observe_rest: Callable[[Intention], None]
    drop_wait: Callable[[Waiting], None]
    end_above: Callable[[Intention, int], None]
    end_wait: Callable[[TimedWait], None]
    begin_need: Callable[[Intention, Frame, Wanted], bool]
    notify_event_waits: Callable[[Event], None]

    def __init__(
        self,
        name: str,
        architecture: Architecture,
        options: Options,
        plans: ProgramPlans,
    ) -> None:
        self.name = name
        self.architecture = architecture
        self.options = options
        self.trail = Trail()
        self.current: Intention | None = None
        self.budgets = budgets(self)
        self.engine = plans.engine
        self.beliefs: BeliefTables = plans.engine.belief_base(self, options.belief_limit)
        if options.search_limit:
            self.beliefs.budget = SearchBudget(options.search_limit)
        self.library = PlanLibrary(plans)
        self.events: deque[Event] = deque()
        self.intentions: deque[Intention] = deque()
        self.crowd: deque[Intention] = deque()
        self.alive: dict[int, Intention] = {}
        self.atomic: Intention | None = None
        self.atomic_over = False
        self.incoming = Incoming()
        self.observers = Observers()
        self.waits = Waits()
        self.features = Features(options)
        self.functions = Functions()
        self.counts = Counts()
        self.sleep: Sleep = "awake"
        self.outer_frame: Any = None
        self.context: Any = None
        self.held: HeldEvent | Intention | None = None
        self.running = False
        self.stopped = False

    def warn_of_operand(self, what: str, value: Term) -> None:
        """Warn of an operand that is not a number."""
        self.architecture.log("warning", f"{what} is not a number: {text(value)}")

    def cause_now(self) -> Cause | None:
        """Return the cause of what the agent is doing, as far as it is observed."""
        observer = self.observers.mind
        return None if observer is None else observer.cause()

    def new_intention(self, cause: Any = None) -> Intention:
        """Make an intention with a new number; it is not in any queue yet."""
        self.counts.intentions += 1
        intention = Intention(self.counts.intentions, cause)
        self.alive[intention.id] = intention
        return intention

    def make_ready(self, intention: Intention) -> None:
        """Let an intention take part in the next cycles; a suspended one once it is resumed."""
        if intention.suspended is None:
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
        if intention.handlers:
            intention.handlers.clear()
        self.alive.pop(intention.id, None)
        if self.atomic is intention:
            self.atomic = None
            self.atomic_over = False
        if intention.waiting is not None:
            waiting, intention.waiting = intention.waiting, None
            self.drop_wait(waiting)

    def may_handle(self, kind: Trigger) -> bool:
        """Return whether there may be a plan for an event kind (sub-plans are checked when the event is handled)."""
        return self.features.subplans or self.library.selects[kind] is not None

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
            self.notify_event_waits(event)

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

    def line_up(self, intention: Intention) -> None:
        """Put a new intention for a goal that the agent set itself last, as there are `CROWD` others."""
        (self.crowd if self.selections.may_line_up(intention) else self.intentions).append(intention)

    def is_in_turn(self, intention: Intention) -> bool:
        """Return whether an intention waits for its turn."""
        return intention in self.intentions or intention in self.crowd

    def take_out(self, intention: Intention) -> None:
        """Take an intention out of those that can run."""
        for queue in (self.intentions, self.crowd):
            if intention in queue:
                queue.remove(intention)

    def let_in(self) -> None:
        """Let intentions of the crowd take part: as many as there is room for, and at least one."""
        intentions, crowd = self.intentions, self.crowd
        for _ in range(min(len(crowd), max(1, CROWD - len(intentions)))):
            intentions.append(crowd.popleft())

    def is_idle(self) -> bool:
        """Return whether there is nothing to do until input arrives or a timer ends."""
        return not (self.events or self.intentions or self.crowd or self.incoming)
