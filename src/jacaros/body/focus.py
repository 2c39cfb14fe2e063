"""The focused artifacts of an agent, whose properties and signals it perceives."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Protocol

from jacaros.bdi.state.act import Percept
from jacaros.body.percepts import ADD, REMOVE, PerceptWriter
from jacaros.body.values import atom_of
from jacaros.env.ids import ArtifactId
from jacaros.env.observation import Observation
from jacaros.env.ports import Workspace
from jacaros.env.presence.focused import Focused
from jacaros.terms.values import String, Term

Watcher = Callable[[ArtifactId, bool], None]
"""Called with an artifact that is focused (True) or no longer focused (False)."""


Notice = Callable[[list[Percept]], None]
"""Receives percepts."""

Untaken = Callable[[str], bool]
"""Returns whether percepts about properties of a name are still unprocessed."""


class PerceivingMind(Protocol):
    """A mind that perceives."""

    def perceive(self, percepts: list[Percept]) -> None:
        """Take percepts."""

    def has_untaken(self, name: str) -> bool:
        """Return whether percepts about properties called *name* are still unprocessed."""


@dataclass(slots=True, eq=False, repr=False)
class FocusObserver:
    """Perceives for an agent, in one namespace of its program.

    Attributes:
        agent: name of the agent.
        namespace: namespace of its program.
        writer: writes its percepts.
        notice: receives its percepts.
        has_untaken: returns whether the mind still has unprocessed percepts about properties of a name.
    """

    agent: str
    namespace: str | None
    writer: PerceptWriter
    notice: Notice
    has_untaken: Untaken

    def observe(self, observation: Observation) -> None:
        """Pass an observation to the mind."""
        writer, namespace = self.writer, self.namespace
        # The percepts just written for another observer are the same.
        if observation is writer.newest and namespace is writer.namespace:
            self.notice(writer.written)
        else:
            self.notice(writer.percepts(observation, namespace))


class FocusedArtifacts(Focused):
    """The artifacts that one agent focuses.

    For each there is a belief ``focusing(Id,Name,Type,WspId,WspName,WspPath)``.
    """

    def __init__(self, agent: str, writer: PerceptWriter, mind: PerceivingMind) -> None:
        super().__init__()
        self._agent = agent
        self._writer = writer
        self._notice: Notice = mind.perceive
        self._untaken = mind.has_untaken
        self._observers: dict[str | None, FocusObserver] = {}
        self._bodies: dict[str, ArtifactId] = {}
        self._watchers: dict[str, Watcher] = {}

    def inhabit(self, workspace: Workspace, body: ArtifactId) -> None:
        """Register the artifact that stands for the agent in a workspace: focused artifacts are a property of it."""
        self._bodies[workspace.path] = body

    def body_in(self, workspace: Workspace) -> ArtifactId:
        """Return the artifact that stands for the agent in a joined workspace."""
        return self._bodies[workspace.path]

    def is_body(self, artifact: ArtifactId) -> bool:
        """Return whether an artifact stands for the agent itself."""
        return self._bodies.get(artifact.workspace) is artifact

    def watch(self, workspace: Workspace, watcher: Watcher) -> Callable[[], None]:
        """Call *watcher* with every artifact of a workspace that is focused (True) or no longer focused (False).
        Return a function that removes it."""
        self._watchers[workspace.path] = watcher
        return lambda: self._watchers.pop(workspace.path, None) and None

    def observer(self, namespace: str | None) -> FocusObserver:
        """Return the observer for a namespace of the agent's program."""
        observer = self._observers.get(namespace)
        if observer is None:
            observer = FocusObserver(self._agent, namespace, self._writer, self._notice, self._untaken)
            self._observers[namespace] = observer
        return observer

    def began(self, workspace: Workspace, artifact: ArtifactId) -> None:
        """Add the belief about a focused artifact."""
        self._report(ADD, workspace, artifact)

    def ended(self, workspace: Workspace, artifact: ArtifactId, disposed: bool) -> None:
        """Remove the belief about an artifact."""
        self._report(REMOVE, workspace, artifact)

    def fall_silent(self) -> None:
        """Send no more percepts to the mind."""
        self._notice = _ignore
        for observer in self._observers.values():
            observer.notice = _ignore

    def _report(self, kind: str, workspace: Workspace, artifact: ArtifactId) -> None:
        self._notice([self._focusing(kind, workspace, artifact)])
        watcher = self._watchers.get(workspace.path)
        if watcher is not None:
            watcher(artifact, kind is ADD)

    def _focusing(self, kind: str, workspace: Workspace, artifact: ArtifactId) -> Percept:
        references = self._writer.references
        arguments: tuple[Term, ...] = (
            references.of(artifact),
            atom_of(artifact.name),
            String(artifact.type_name),
            references.of(workspace),
            atom_of(workspace.name),
            String(workspace.path),
        )
        return self._writer.own(kind, self._bodies[workspace.path], "focusing", *arguments)


def _ignore(percepts: list[Percept]) -> None:
    """Discard percepts after the agent's end."""
