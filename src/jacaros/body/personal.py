"""The artifacts that stand for an agent in its workspaces: ``body_bob`` in each, ``session_bob`` in its home.

They show to others what the agent focuses on and where it is. They are made on the first look-up. The agent's own
operations on them are run by its `AgentBody`.
"""

from typing import NoReturn

from jacaros.body.focus import FocusedArtifacts
from jacaros.env.artifact import Artifact, Out, internal_operation, operation
from jacaros.env.ids import ArtifactId
from jacaros.env.ports import Workspace
from jacaros.env.presence.joined import JoinedWorkspaces
from jacaros.env.values import Atom


class AgentBodyArtifact(Artifact):
    """The body of an agent in one workspace.

    Properties:
        focusing(Id, Name, Type, WspId, WspName, WspPath): one for each artifact of the workspace that the agent
            focuses on.
    """

    def init(self, agent: str, focused: FocusedArtifacts, workspace: Workspace) -> None:
        """Show the focused artifacts, and follow changes."""
        self._agent, self._here = agent, workspace
        for artifact in focused.in_workspace(workspace):
            self._show(artifact, True)
        self.on_dispose(focused.watch(workspace, lambda a, present: self.start(self._show, a, present)))

    @internal_operation
    def _show(self, artifact: ArtifactId, present: bool) -> None:
        here = self._here
        values = (artifact, Atom(artifact.name), artifact.type_name, here, Atom(here.name), here.path)
        if present:
            self.define_property("focusing", *values)
        else:
            self.remove_property("focusing", artifact, *(None,) * 5)

    @operation
    def focus(self, artifact: ArtifactId, only: object = None) -> None:
        """Perceive an artifact from now on, optionally only what a filter lets pass."""
        _refuse(self, self._agent)

    @operation(name="focusWhenAvailable")
    def focus_when_available(self, name: str, only: object = None) -> None:
        """Wait until an artifact of that name exists, and perceive it from then on."""
        _refuse(self, self._agent)

    @operation(name="stopFocus")
    def stop_focus(self, artifact: ArtifactId) -> None:
        """Stop perceiving an artifact."""
        _refuse(self, self._agent)


class AgentSessionArtifact(Artifact):
    """The session of an agent.

    Properties:
        joinedWsp(WspId, Name, Path): one for each workspace that the agent has joined.
    """

    def init(self, agent: str, workspaces: JoinedWorkspaces) -> None:
        """Show the joined workspaces, and follow changes."""
        self._agent = agent
        for workspace in workspaces.joined():
            self._show(workspace, True)
        workspaces.watcher = lambda workspace, joined: self.start(self._show, workspace, joined)

    @internal_operation
    def _show(self, workspace: Workspace, joined: bool) -> None:
        if joined:
            self.define_property("joinedWsp", workspace, Atom(workspace.name), workspace.path)
        else:
            self.remove_property("joinedWsp", None, None, workspace.path)

    @operation(name="joinWorkspace")
    def join(self, path: str) -> None:
        """Make a workspace the current one of the intention."""
        _refuse(self, self._agent)

    @operation(name="joinWorkspace")
    def join_and_tell(self, path: str, workspace: Out) -> None:
        """Make a workspace the current one of the intention, and give its id."""
        _refuse(self, self._agent)

    @operation(name="quitWorkspace")
    def quit(self, workspace: object = None) -> None:
        """Leave a workspace."""
        _refuse(self, self._agent)

    @operation(name="quitFromEnvironment")
    def quit_all(self) -> None:
        """Leave all workspaces."""
        _refuse(self, self._agent)


def _refuse(artifact: Artifact, owner: str) -> NoReturn:
    """Fail: the owner's own actions are handled by its body."""
    caller = str(artifact.caller or "nobody")
    artifact.fail(f"{artifact.name} can only be used by {owner}", "security_exception", caller, artifact.name)
