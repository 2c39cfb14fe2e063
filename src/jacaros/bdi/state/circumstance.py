"""The state of a mind: beliefs, plans, events, intentions, and what waits.  No behaviour beyond keeping it in order."""

from collections import deque
from collections.abc import Callable, Mapping, Sequence
from types import MappingProxyType
from typing import Any, Final, NamedTuple, Protocol

from jacaros.asl.source import Span
from jacaros.bdi.actions.internal_action import InternalAction
from jacaros.bdi.architecture import Architecture
from jacaros.bdi.state.act import Percept
from jacaros.bdi.state.belief_base import BeliefTables
from jacaros.bdi.state.budget import SearchBudget, budgets
from jacaros.bdi.state.condition_waits import ConditionWaits
from jacaros.bdi.state.event import EVENT_GOAL, EVENT_INTENTION, Event
from jacaros.bdi.state.intention import Intention
from jacaros.bdi.state.options import Options
from jacaros.bdi.state.plan_library import PlanLibrary, ProgramPlans
from jacaros.bdi.state.selections import Selections
from jacaros.bdi.state.speech_act import SpeechAct
from jacaros.bdi.state.triggers import Trigger
from jacaros.bdi.state.waiting import ActWait, Alarm, AnswerWait, EventWaits, Waiting
from jacaros.terms.text import text
from jacaros.terms.unifier import Trail
from jacaros.terms.values import Term

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


class Waits:
    """What the intentions of an agent wait for, and what has been put off.

    Attributes:
        events: those who wait for an event.
        conditions: those who wait for a condition.
        acts: those who wait for an external action, by its number.
        questions: those who wait for an answer, by the id of the question.
        abandoned: ids of questions that nobody waits for any more: an answer that still comes is thrown away.
        alarms: calls that are due at a moment, by number.
        alarms_made: number of alarms so far.
        suspended_events: goal events whose goal was suspended before it became an intention.
        requeued: external events without plan that are to be tried again (``events=requeue``).
    """

    __slots__ = (
        "abandoned",
        "acts",
        "alarms",
        "alarms_made",
        "conditions",
        "events",
        "questions",
        "requeued",
        "suspended_events",
    )

    def __init__(self) -> None:
        self.events = EventWaits()
        self.conditions = ConditionWaits()
        self.acts: dict[int, ActWait] = {}
        self.questions: dict[str, AnswerWait] = {}
        self.abandoned: set[str | None] = set()
        self.alarms: dict[int, Alarm] = {}
        self.alarms_made = 0
        self.suspended_events: list[Event] = []
        self.requeued: list[Event] = []


class Features:
    """What the plans of an agent make it look at in each cycle.

    Attributes:
        meta: plans or an observer want to hear of changes of goal states.
        goal_conditions: plans have goal conditions, which are tested in every cycle.
        subplans: plans have plans of their own.
        edges: there may be plans for falling asleep and awaking.
    """

    __slots__ = ("edges", "goal_conditions", "meta", "subplans")

    def __init__(self) -> None:
        self.meta = self.goal_conditions = self.subplans = self.edges = False


class Circumstance:
    """All that an agent holds.

    Attributes:
        name: of the agent.
        architecture: the port to its host.
        trail: bindings of the search under way; empty between two steps.
        beliefs, library, selects: what it believes, its plans, and their select functions.
        events: the queue of events, oldest first.
        usual_events: external events without a plan are passed over, events of belief changes in plans belong to the
            intentions that made them, and no agent class is asked about these changes.
        intentions: those that can run, in turn; others are waiting, suspended, or in an event.
        crowd: intentions for goals that the agent set itself beside `CROWD` others that can run: they join these as others
            end, and one in each turn anyway, so that an agent that sets itself more and more goals keeps its other plans.
        budgets: what refuses more than a limit allows, by the name of the option.
        next_count: number of the cycle after which beliefs are counted, and unused names dropped, next; a look at what
            comes in counts as one.
        selections: which message, event, plan and intention goes first.
        alive: every intention that is not over, by id.
        current: the intention whose step is being made.
        atomic: the intention that has an atomic plan on its stack, or None.
        atomic_over: its atomic plan has ended; it still makes its next step before others have their turn.
        inbox, percepts: what was received and noticed, and not yet looked at.
        tasks: housekeeping for the beginning of the next cycle: functions, and their arguments behind the agent.
        goal_observer: told of each goal that changes, or None, see `jacaros.bdi.rules.meta_events.observe_goals`.
        on_lost: called with what people are told of each lost goal (first line, further lines, place), or None.
        intentions_made: number of intentions so far.
        special: whether `features` has more than `edges`.
        called: something may want to be looked at besides `events` and `intentions`: `inbox`, `percepts`, `tasks`,
            restless conditions that intentions wait for, a suspension, or because the agent is `special` or its
            `selections` are not plain.  Whoever adds to one of
            them sets it.
        outer_frame: frame of the plan whose sub-plans are being tried.
        context: the view of itself that it gives to internal actions.
        functions: arithmetic functions that its program registers, by name.
        cycles: number of steps made.
        next_look: number of the cycle in which percepts and messages are looked at next.
        running: the agent has its turn: whoever gave it finds out at its end whether there is more to do.
        stopped: the agent is over.
        engine: carries out plans and rules.
        drowsy: it has had nothing to do since it last awoke, and has been told so.
        asleep: it is drowsy, and has done what its plans do before sleep.
        waits: what intentions wait for, and what has been put off.
        features: what its plans make it look at in each cycle.
        project: the arithmetic functions of the project.
    """

    __slots__ = (
        "actions",
        "alive",
        "architecture",
        "asleep",
        "atomic",
        "atomic_over",
        "beliefs",
        "budgets",
        "called",
        "context",
        "crowd",
        "current",
        "cycles",
        "drowsy",
        "engine",
        "events",
        "features",
        "functions",
        "goal_observer",
        "inbox",
        "intentions",
        "intentions_made",
        "library",
        "name",
        "next_count",
        "next_look",
        "on_lost",
        "options",
        "outer_frame",
        "percepts",
        "project",
        "running",
        "selections",
        "selects",
        "special",
        "stopped",
        "tasks",
        "trail",
        "usual_events",
        "waits",
    )

    selections: Selections
    accepts: Callable[[SpeechAct], bool]
    call_own: Callable[[Term], Term]
    observe_rest: Callable[[Intention], None]
    drop_wait: Callable[[Waiting], None]
    notify_event_waits: Callable[[Event], None]

    def __init__(
        self,
        name: str,
        architecture: Architecture,
        actions: Mapping[str, InternalAction],
        options: Options,
        plans: ProgramPlans,
    ) -> None:
        self.name = name
        self.architecture = architecture
        self.actions = actions
        self.options = options
        self.trail = Trail()
        self.current: Intention | None = None
        self.budgets = budgets(self)
        self.engine = plans.engine
        self.beliefs: BeliefTables = plans.engine.belief_base(self, options.belief_limit)
        self.next_count = INTERVAL
        if options.search_limit:
            self.beliefs.budget = SearchBudget(options.search_limit)
        self.usual_events = options.events == "discard" and not options.new_focus
        self.library = PlanLibrary(plans)
        self.selects = self.library.selects
        self.events: deque[Event] = deque()
        self.next_look = 0
        self.intentions: deque[Intention] = deque()
        self.crowd: deque[Intention] = deque()
        self.alive: dict[int, Intention] = {}
        self.atomic: Intention | None = None
        self.atomic_over = False
        self.inbox: deque[SpeechAct] = deque()
        self.percepts: deque[list[Percept]] = deque()
        self.tasks: deque[tuple[Callable[..., None], tuple[object, ...]]] = deque()
        self.goal_observer: Callable[[str, str, int, int, str], None] | None = None
        self.on_lost: Callable[[str, Sequence[str], Span | None], None] | None = None
        self.waits = Waits()
        self.features = Features()
        self.project: ProjectFunctions = NO_FUNCTIONS
        self.special = False
        self.called = False
        self.outer_frame: Any = None
        self.functions: dict[str, Any] = {}
        self.context: Any = None
        self.cycles = 0
        self.running = False
        self.stopped = False
        self.drowsy = False
        self.asleep = False
        self.intentions_made = 0

    def warn_of_operand(self, what: str, value: Term) -> None:
        """Take note of an operand that is no number."""
        self.architecture.log("warning", f"{what} is no number: {text(value)}")

    def new_intention(self, cause: Any = None) -> Intention:
        """An intention with a number of its own; it is not in any queue yet."""
        self.intentions_made += 1
        intention = Intention(self.intentions_made, cause)
        self.alive[intention.id] = intention
        return intention

    def make_ready(self, intention: Intention) -> None:
        """Let an intention take part in the next cycles; a suspended one is parked."""
        if intention.suspended is not None:
            intention.parked = True
        else:
            self.selections.note_intention(intention)
            self.intentions.append(intention)
        if not self.running:
            self.architecture.ready()

    def finish(self, intention: Intention) -> None:
        """An intention is over; what it waits for is cancelled."""
        intention.dropped = True
        if intention.frames:
            if self.goal_observer is not None:
                self.observe_rest(intention)
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
        """Whether there may be a plan for an event kind (sub-plans are looked at when the event is taken)."""
        return self.features.subplans or self.selects[kind] is not None

    def do_soon(self, function: Callable[..., None], *arguments: object) -> None:
        """Call a function with the agent and the arguments at the beginning of the next cycle."""
        self.tasks.append((function, arguments))
        self.called = True

    def queue(self, event: Event) -> None:
        """Put an event at the end of the queue."""
        self.note(event[EVENT_GOAL][0])
        self.events.append(event)

    def note(self, kind: Trigger) -> None:
        """An event of a kind is about to be queued, or handled at once."""
        urgencies = self.selections.urgencies
        if urgencies is not None and urgencies[kind]:
            self.selections.rank()

    def post(self, event: Event) -> None:
        """Put an event at the end of the queue, and resume those who wait for it."""
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
        """Whether an event may still come into the queue: one that an existing intention waits for may.

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
        """Put a new intention for a goal that the agent set itself behind all others, now that there are `CROWD`."""
        (self.crowd if self.selections.may_line_up(intention) else self.intentions).append(intention)

    def is_in_turn(self, intention: Intention) -> bool:
        """Whether an intention waits for its turn."""
        return intention in self.intentions or intention in self.crowd

    def let_in(self) -> None:
        """Let intentions of the crowd take part: as many as there is room for, and one anyway."""
        intentions, crowd = self.intentions, self.crowd
        for _ in range(min(len(crowd), max(1, CROWD - len(intentions)))):
            intentions.append(crowd.popleft())

    def is_idle(self) -> bool:
        """Whether there is nothing to do until something comes from outside or a timer ends."""
        return not (self.events or self.intentions or self.crowd or self.inbox or self.percepts or self.tasks)
