"""The presence of an agent with a mind: beliefs and artifacts show where it is and what it focuses."""

from jacaros.bdi.actions.internal_action import STANDARD
from jacaros.body.focus import FocusedArtifacts, PerceivingMind
from jacaros.body.percepts import ADD, REMOVE, PerceptWriter
from jacaros.body.personal import AgentBodyArtifact, AgentSessionArtifact
from jacaros.body.values import atom_of
from jacaros.env.artifact import Artifact
from jacaros.env.environment import Environment
from jacaros.env.ids import ArtifactId
from jacaros.env.ports import Workspace
from jacaros.env.presence.presence import Presence
from jacaros.suggestions import aside
from jacaros.terms.values import String


class AgentPresence(Presence):
    """The joined workspaces and focused artifacts of an agent with a mind.

    For each joined workspace there is a belief ``joinedWsp(Id,Name,Path)``, and an artifact that stands for the agent.

    Args:
        agent: name of the agent.
        mind: its mind.
        environment: its environment.
        writer: writes percepts, shared by all agents of a run.
        own_actions: the body's own actions, such as ``focus/1``.
    """

    focused: FocusedArtifacts

    def __init__(
        self,
        agent: str,
        mind: PerceivingMind,
        environment: Environment,
        writer: PerceptWriter,
        own_actions: tuple[str, ...],
    ) -> None:
        focused = FocusedArtifacts(agent, writer, mind)
        super().__init__(environment, agent, "/main", focused, own_actions)
        self.references = writer.references
        self._perceive, self._writer = mind.perceive, writer
        self._entered = False
        self._session: ArtifactId | None = None

    def enter(self) -> None:
        """Add the belief about the home workspace; at the latest done by the agent's first action."""
        if not self._entered:
            self._entered = True
            self.changed(self.workspaces.home, True)

    def leave(self) -> None:
        """Stop focusing everything, and dispose the artifacts that stand for the agent."""
        if self._session is None:
            return
        for workspace in self.workspaces.joined():
            self._withdraw(workspace, self.focused.body_in(workspace))
        self._withdraw(self.workspaces.home, self._session)
        super().leave()

    def changed(self, workspace: Workspace, joined: bool) -> None:
        """Add or remove the belief about a workspace, and the artifact that stands for the agent there."""
        session = self.session
        if joined:
            made_of = (self.name, self.focused, workspace)
            self.focused.inhabit(workspace, self._offer("body", workspace, AgentBodyArtifact, *made_of))
        about = self.references.of(workspace), atom_of(workspace.name), String(workspace.path)
        self._perceive([self._writer.own(ADD if joined else REMOVE, session, "joinedWsp", *about)])
        if not joined:
            self._withdraw(workspace, self.focused.body_in(workspace))

    @property
    def session(self) -> ArtifactId:
        """The artifact that stands for the agent's session, in its home workspace."""
        if self._session is None:
            made_of = self.name, self.workspaces
            self._session = self._offer("session", self.workspaces.home, AgentSessionArtifact, *made_of)
        return self._session

    def is_own(self, artifact: ArtifactId) -> bool:
        """Return whether an artifact stands for the agent or its session."""
        return artifact is self._session or self.focused.is_body(artifact)

    def _offer(
        self, kind: str, workspace: Workspace, artifact_type: type[Artifact], *arguments: object
    ) -> ArtifactId:
        return workspace.offer(f"{kind}_{self.name}", artifact_type, arguments, personal=True)

    def _withdraw(self, workspace: Workspace, personal: ArtifactId) -> None:
        """Dispose an artifact that stands for the agent, if it still exists."""
        workspace.take_back(personal)
        self.references.forget(personal)
        self._writer.forget(personal)

    def word_for(self, operation: str) -> str | None:
        """Return a suggestion of an internal action."""
        if operation.startswith("."):
            return f"; unknown internal action `{operation}`{aside(operation, STANDARD)}"
        return (
            f"; write the internal action with a dot: .{operation}" if f".{operation}" in STANDARD else None
        )
