"""What agents written in Python do in the environment: a `Session` under the agent's own name."""

from collections.abc import Callable, Sequence
from typing import Any, TypeVar

from jacaros.env.artifact import Artifact
from jacaros.env.ids import ArtifactId
from jacaros.env.session.observed import ObservedProperty
from jacaros.env.session.operation import SessionOperation
from jacaros.env.session.session import Session
from jacaros.env.session.signal_stream import SignalStream

T = TypeVar("T")
_REQUIRED = object()


class InEnvironment:
    """The environment, for an agent written in Python; each method is that of `Session`, which has them all."""

    @property
    def session(self) -> Session:
        """The agent's working session.

        Raises:
            WorkspaceError: the project has no environment.
        """
        raise NotImplementedError

    async def _turn(self) -> None:
        """Let others have their turn."""

    def join(self, workspace: str) -> str:
        """Join a workspace and make it the current one; gives its full path."""
        return self.session.join(workspace)

    def quit(self, workspace: str) -> None:
        """Leave a workspace, and stop to focus what is in it."""
        self.session.quit(workspace)

    async def make_artifact(
        self, name: str, artifact_type: str | type[Artifact], arguments: Sequence[object] = ()
    ) -> ArtifactId:
        """Make an artifact in the current workspace; raises `OperationFailed`."""
        return await self.session.make_artifact(name, artifact_type, arguments)

    def lookup(self, name: str) -> ArtifactId:
        """Find an artifact; raises `OperationFailed`."""
        return self.session.lookup(name)

    def focus(self, artifact: ArtifactId | str) -> ArtifactId:
        """Perceive an artifact from now on; raises `OperationFailed`."""
        return self.session.focus(artifact)

    async def focus_when_available(self, name: str) -> ArtifactId:
        """Wait until there is an artifact of that name, and focus it."""
        return await self.session.focus_when_available(name)

    def stop_focus(self, artifact: ArtifactId | str) -> None:
        """Perceive an artifact no more."""
        self.session.stop_focus(artifact)

    async def act(
        self,
        operation: str,
        *arguments: object,
        artifact: ArtifactId | str | None = None,
        workspace: str | None = None,
        timeout: float | None = None,
    ) -> Any:
        """Do an operation, wait for its end, and give the values of its `Out` arguments; see `Session.act`.

        Raises:
            OperationFailed: with the message and the reason.
        """
        result = await self.begin(
            operation, *arguments, artifact=artifact, workspace=workspace, timeout=timeout
        )
        # An operation may end at once; who does nothing else must not keep the others from their turns.
        await self._turn()
        return result

    def begin(
        self,
        operation: str,
        *arguments: object,
        artifact: ArtifactId | str | None = None,
        workspace: str | None = None,
        timeout: float | None = None,
    ) -> SessionOperation:
        """Begin an operation, and give its handle, which can be awaited, paused and cancelled."""
        return self.session.begin(
            operation, *arguments, artifact=artifact, workspace=workspace, timeout=timeout
        )

    def value(
        self, name: str, index: int = 0, artifact: ArtifactId | str | None = None, default: object = _REQUIRED
    ) -> Any:
        """A value of a property of the focused artifacts; raises `UnknownProperty` when there is no default."""
        if default is _REQUIRED:
            return self.session.value(name, index, artifact)
        return self.session.value(name, index, artifact, default)

    def values(self, name: str, artifact: ArtifactId | str | None = None) -> tuple[Any, ...]:
        """All values of a property of the focused artifacts; raises `UnknownProperty`."""
        return self.session.values(name, artifact)

    def has_property(self, name: str, *values: object, artifact: ArtifactId | str | None = None) -> bool:
        """True when a focused artifact has such a property; None stands for any value."""
        return self.session.has_property(name, *values, artifact=artifact)

    def properties(
        self, name: str, *values: object, artifact: ArtifactId | str | None = None
    ) -> tuple[ObservedProperty, ...]:
        """All such properties of the focused artifacts; None stands for any value."""
        return self.session.properties(name, *values, artifact=artifact)

    def signals(self, name: str | None = None, artifact: ArtifactId | str | None = None) -> SignalStream:
        """The signals of the focused artifacts from now on, for ``async for``."""
        return self.session.signals(name, artifact)

    async def until(self, condition: Callable[[], T], timeout: float | None = None) -> T:
        """Wait until *condition* is true, which is looked at whenever a focused artifact publishes something.

        Raises:
            TimeoutError: it was not within *timeout* seconds.
        """
        value = await self.session.until(condition, timeout)
        await self._turn()
        return value
