"""Causes of what crosses from one member to another: the step of an agent that led to it.

They are described only while a member records its run. A description from the wire is the data of a stranger.
"""

from pathlib import PurePath

from jacaros.agents.mind.mind import Mind
from jacaros.artifacts.env.operation import OperationRequest
from jacaros.artifacts.env.property import Observation
from jacaros.fleet.protocol import StepData
from jacaros.look.records.words import limited, shown_event
from jacaros.runtime.files.texts import escaped
from jacaros.runtime.mas.history.intentions import place_of_step
from jacaros.runtime.mas.system import System
from jacaros.runtime.trace import Cause, Origin

_LARGEST_LINE = 1_000_000_000


class Causes:
    """Describes steps of agents of this member, and makes causes of those of others.

    Args:
        system: the system of this member.
        member: its name.
    """

    def __init__(self, system: System, member: str) -> None:
        self._system, self._member = system, member
        self._wanted: set[str] = set()

    def want(self, member: str, wanted: bool) -> None:
        """Hear that another member records its run, or no longer."""
        (self._wanted.add if wanted else self._wanted.discard)(member)

    # ---- what happens here

    def of_step(self, agent: str) -> StepData | None:
        """Return the step that an agent is at; None if no member records, or it is not in a plan."""
        if not self._wanted:
            return None
        host = self._system.directory.find(agent)
        mind = None if host is None else host.mind
        if not isinstance(mind, Mind) or mind.current is None or not mind.current.frames:
            return None
        goal, file, line = place_of_step(mind.current)
        return self._data(Origin(agent, shown_event(goal), file, line))

    def of_request(self, request: OperationRequest) -> StepData | None:
        """Return the step that asks for an operation: that of its cause, or without one, the present step of its agent."""
        if request.cause is not None:
            return self.of(request.cause)
        return None if request.agent is None else self.of_step(request.agent)

    def of(self, cause: Cause | None) -> StepData | None:
        """Return the step that led to a cause, if it is known and a member records."""
        tracer = self._system.tracer
        if cause is None or tracer is None or not self._wanted:
            return None
        origin = tracer.origin(cause)
        return None if origin is None else self._data(origin)

    def _data(self, step: Origin) -> StepData:
        agent = step.agent if "@" in step.agent else f"{step.agent}@{self._member}"
        return (
            agent,
            step.event,
            PurePath(step.file).name,
            step.line,
        )  # other members need not know the folders

    # ---- what comes from others

    def arrived(self, data: StepData | None) -> Cause | None:
        """Return a cause that stands for a step of an agent of another member; None if this member does not record."""
        tracer = self._system.tracer
        if tracer is None or data is None:
            return None
        agent, event, file = map(_line, data[:3])
        origin = Origin(agent, event, file, min(max(0, data[3]), _LARGEST_LINE))
        return tracer.link("remote", event, None, origin)

    def observed(self, observation: Observation, data: StepData | None) -> Observation:
        """Return what a remote artifact published with its cause."""
        tracer = self._system.tracer
        if tracer is None:
            return observation
        properties = (*(new for _, new in observation.changed), *observation.added, *observation.removed)
        names = " ".join((*(each.name for each in observation.signals), *(each.name for each in properties)))
        about = observation.artifact, observation.signals, observation
        kind, what = "property" if properties else "signal", f"{observation.artifact.path} {names}"
        return observation._replace(cause=tracer.link(kind, what, self.arrived(data), about))


def _line(text: str) -> str:
    """Return a text of a stranger as a short line of printable characters."""
    return limited(escaped(" ".join(text.split())))
