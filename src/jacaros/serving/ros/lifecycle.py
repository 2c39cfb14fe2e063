"""The node of the agents as a managed node of ROS 2, with the states of its design article "Managed nodes".

==============  ===============================================================
state           agents
==============  ===============================================================
unconfigured    have no turns; nothing is offered in the graph
inactive        have no turns: their intentions are suspended, and the robot stands still; goals are rejected
active          run
finalized       the run ends
==============  ===============================================================
"""

from collections.abc import Callable, Iterable
from dataclasses import dataclass
from typing import Any, Final

from jacaros.agents.mind.mind import Mind
from jacaros.agents.mind.rules.goals import resume_intention, suspend_intention
from jacaros.agents.mind.state.intention import Intention
from jacaros.robots.ros.guarded import guarded_by
from jacaros.robots.ros.qos import QoS
from jacaros.runtime.mas.agents.host import AgentHost
from jacaros.runtime.mas.agents.python_agents import PythonAgentHost
from jacaros.runtime.mas.system import System
from jacaros.serving.ros.door import RosDoor

UNCONFIGURED, INACTIVE, ACTIVE, FINALIZED = 1, 2, 3, 4
LABELS: Final = {
    0: "unknown",
    UNCONFIGURED: "unconfigured",
    INACTIVE: "inactive",
    ACTIVE: "active",
    FINALIZED: "finalized",
    10: "configuring",
    11: "cleaningup",
    12: "shuttingdown",
    13: "activating",
    14: "deactivating",
    15: "errorprocessing",
}
"""States by the numbers of ``lifecycle_msgs/msg/State``."""
SUCCESS, FAILURE = 0, 1
"""What is added to ten times the number of a transition, for the transition at its end."""
LEAVING = 0.5
"""Seconds between the transition to ``finalized`` and the end of the run, in which the answer leaves."""
_SERVICES: Final = "lifecycle_msgs/srv/"
Fields = dict[str, Any]


@dataclass(frozen=True, slots=True)
class Transition:
    """A transition that can be asked for: number and label as in ``lifecycle_msgs``, its states, and those meanwhile."""

    number: int
    label: str
    start: int
    during: int
    goal: int


TRANSITIONS: Final = (
    Transition(1, "configure", UNCONFIGURED, 10, INACTIVE),
    Transition(2, "cleanup", INACTIVE, 11, UNCONFIGURED),
    Transition(3, "activate", INACTIVE, 13, ACTIVE),
    Transition(4, "deactivate", ACTIVE, 14, INACTIVE),
    Transition(5, "shutdown", UNCONFIGURED, 12, FINALIZED),
    Transition(6, "shutdown", INACTIVE, 12, FINALIZED),
    Transition(7, "shutdown", ACTIVE, 12, FINALIZED),
)


class Lifecycle:
    """Serves the lifecycle of the run's node. The agents wait for ``activate`` from the beginning.

    Args:
        system: the run; started, and no agent has had a turn.
        open_door: offers goals in the graph; None to offer none.

    Attributes:
        state: number of the state.
    """

    def __init__(self, system: System, open_door: Callable[[], RosDoor] | None) -> None:
        self._system, self._open_door = system, open_door
        self._backend = backend = system.ros.backend()
        self._door: RosDoor | None = None
        self._suspended: list[tuple[Mind, Intention]] = []
        self.state = UNCONFIGURED
        system.scheduler.pause()
        for host in system.directory:
            _hold(host)
        system.directory.watch(self._agent_changed)
        event_type = "lifecycle_msgs/msg/TransitionEvent"
        self._events = backend.publisher("~/transition_event", event_type, QoS())
        for name, kind, answer in (
            ("change_state", "ChangeState", self._change),
            ("get_state", "GetState", lambda _: {"current_state": _state(self.state)}),
            ("get_available_states", "GetAvailableStates", lambda _: _STATES),
            ("get_available_transitions", "GetAvailableTransitions", lambda _: _available(self._possible())),
            ("get_transition_graph", "GetAvailableTransitions", lambda _: _available(TRANSITIONS)),
        ):
            backend.service(f"~/{name}", _SERVICES + kind, answer)

    def _agent_changed(self, name: str, present: bool) -> None:
        host = self._system.directory.find(name) if present else None
        if host is not None and self.state != ACTIVE:
            _hold(host)

    def _possible(self) -> list[Transition]:
        return [each for each in TRANSITIONS if each.start == self.state]

    def _change(self, request: Any) -> Fields:
        asked = request.transition
        for each in self._possible():
            if asked.label == each.label if asked.label else asked.id == each.number:
                return {"success": self.change(each)}
        return {"success": False}

    def change(self, transition: Transition) -> bool:
        """Make a transition. Return whether it succeeded; otherwise the state stays."""
        number, during = transition.number, transition.during
        self._tell(number, transition.label, transition.start, during)
        try:
            getattr(self, f"_{transition.label}")()
        except Exception as error:  # the node stays manageable; its manager sees the failure
            self._system.console.log(f"[ros] error: {transition.label} failed: {error}", "error")
            self._tell(10 * number + FAILURE, "transition_failure", during, transition.start)
            return False
        self.state = transition.goal
        self._tell(10 * number + SUCCESS, "transition_success", during, transition.goal)
        self._system.console.log(f"[ros] note: {LABELS[transition.goal]}, by `{transition.label}`")
        return True

    def _tell(self, number: int, label: str, start: int, goal: int) -> None:
        now, fields = int(self._system.clock.now() * 1e9), _described(number, label, start, goal)
        self._events.publish(self._events.message(timestamp=now, **fields))

    def _configure(self) -> None:
        if self._open_door is not None:
            self._door = self._open_door()
            self._door.active = False

    def _cleanup(self) -> None:
        if self._door is not None:
            self._door.close()
            self._door = None

    def _activate(self) -> None:
        for mind, intention in self._suspended:
            if intention.id in mind.alive:
                resume_intention(mind, intention)
                mind.architecture.ready()
        self._suspended.clear()
        for host in self._system.directory:
            if isinstance(host, PythonAgentHost):
                host.release()
        self._system.scheduler.resume()
        if self._door is not None:
            self._door.active = True

    def _deactivate(self) -> None:
        if self._door is not None:
            self._door.active = False
        for host in self._system.directory:
            _hold(host)
            if isinstance(host.mind, Mind):
                self._suspend(host.mind)
        self._system.scheduler.pause()
        if (joined := self._system.ros.joined) is not None:
            guarded_by(joined).stand_still()

    def _suspend(self, mind: Mind) -> None:
        for intention in list(mind.alive.values()):
            if intention.suspended is None:
                suspend_intention(mind, intention)
                self._suspended.append((mind, intention))

    def _shutdown(self) -> None:
        if self.state == ACTIVE:
            self._deactivate()
        self._cleanup()
        self._system.clock.call_later(LEAVING, lambda: self._system.stop_system(0.0, 0))


def _hold(host: AgentHost) -> None:
    """Hold an agent in Python; the others have no turns."""
    if isinstance(host, PythonAgentHost):
        host.hold()


def _state(number: int) -> Fields:
    return {"id": number, "label": LABELS[number]}


def _described(number: int, label: str, start: int, goal: int) -> Fields:
    transition = {"id": number, "label": label}
    return {"transition": transition, "start_state": _state(start), "goal_state": _state(goal)}


def _available(transitions: Iterable[Transition]) -> Fields:
    found = [_described(each.number, each.label, each.start, each.goal) for each in transitions]
    return {"available_transitions": found}


_STATES: Final[Fields] = {"available_states": [_state(each) for each in LABELS]}
