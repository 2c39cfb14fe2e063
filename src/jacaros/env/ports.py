"""The ports of an environment: what those who act and observe in it ask of it.

`jacaros.env.workspace.Workspace` and `jacaros.env.environment.Environment` stand behind them, and so can workspaces of
another process, see `Environment.mount`.

What is *looked up* is answered at once, from what is known here: a workspace that is served from elsewhere keeps a copy of
which artifacts it has and what they offer.  What is *asked for* may take time: its end is told to a callback, which may be
called before the method returns, and does not come at all when it was given up.
"""

import asyncio
from collections.abc import Callable, Collection, Mapping, Sequence
from typing import Protocol, runtime_checkable

from jacaros.clock import Clock
from jacaros.env.artifact import Artifact
from jacaros.env.errors import OperationFailed
from jacaros.env.ids import ArtifactId
from jacaros.env.observation import Observer
from jacaros.env.operation import OperationOutcome, OperationRequest, ignore_outcome
from jacaros.env.resources.arbiter import Arbiter
from jacaros.env.resources.resource import Use
from jacaros.trace import Cause, Tracer

Told = Callable[[OperationOutcome], None]
"""Told how something ended."""

Made = Callable[[ArtifactId | None, OperationOutcome], None]
"""Told what came of making an artifact: its id, or None and why not."""


def nobody_waits(artifact_id: ArtifactId | None, outcome: OperationOutcome) -> None:
    """Take what came of making an artifact that nobody waits for."""


class UnderWay(Protocol):
    """Something that was asked for and has not ended."""

    def cancel(self) -> None:
        """Give it up; its end is not told."""

    def pause(self) -> None:
        """Let it rest, if it can."""

    def resume(self) -> None:
        """Let it go on."""


@runtime_checkable
class Workspace(Protocol):
    """A workspace, wherever its artifacts live.  The ids that it gives carry its `path`.

    Attributes:
        path: full path in the environment that it is seen in, such as ``/main/lab``.
        name: last part of the path.
    """

    path: str
    name: str

    # ---- looked up

    def artifacts(self) -> tuple[ArtifactId, ...]:
        """All artifacts, the oldest first."""

    def lookup(self, name: str) -> ArtifactId:
        """Find an artifact by its name; raises `UnknownArtifact`."""

    def watch(
        self, watcher: Callable[[ArtifactId, bool], None], personal: bool = False
    ) -> Callable[[], None]:
        """Call *watcher* with every artifact that comes (True) or goes (False); gives what ends that.

        With *personal* also with the bodies and sessions of agents, which are many.
        """

    def providers(self, operation: str, arity: int) -> tuple[ArtifactId, ...]:
        """The artifacts that offer *operation* with *arity* arguments to agents, the oldest first."""

    def offers(self, artifact_id: ArtifactId) -> Collection[str]:
        """The operations of an artifact for agents, such as ``inc/1`` and ``sum/any``; raises `UnknownArtifact`."""

    def histories(self, artifact_id: ArtifactId) -> Mapping[str, float]:
        """For properties by name, the seconds for which past values are to be kept; raises `UnknownArtifact`."""

    def has_method(self, artifact_id: ArtifactId, name: str) -> bool:
        """True when its class has a public method of that name that is no operation of agents; see `offers`."""

    # ---- asked for

    async def make_artifact(
        self,
        name: str,
        type_name: str | type[Artifact],
        args: Sequence[object] = (),
        creator: str | None = None,
    ) -> ArtifactId:
        """Make an artifact and wait until its ``init`` has ended.

        Args:
            name: unique in the workspace.
            type_name: looked up where the workspace lives; or the class itself.
            args: plain values for ``init``.
            creator: the agent that makes it.

        Raises:
            OperationFailed: with reason ``makeArtifactFailure(Why,What)``, where Why is
                ``"artifact_already_present"``, ``"unknown_artifact_template"`` (What is the type) or
                ``"init_failed"``; nothing is left behind.
        """
        made: asyncio.Future[ArtifactId] = asyncio.get_running_loop().create_future()

        def on_done(artifact_id: ArtifactId | None, outcome: OperationOutcome) -> None:
            if made.done():
                return
            if artifact_id is not None:
                made.set_result(artifact_id)
            else:
                made.set_exception(OperationFailed(outcome.message or "", outcome.reason))

        execution = self.create(name, type_name, args, creator, on_done)
        try:
            return await made
        except asyncio.CancelledError:
            execution.cancel()
            raise

    def create(
        self,
        name: str,
        type_name: str | type[Artifact],
        args: Sequence[object] = (),
        creator: str | None = None,
        on_done: Made = nobody_waits,
        cause: Cause | None = None,
    ) -> UnderWay:
        """Make an artifact, of a type that is known where the workspace lives."""

    def dispose_artifact(self, artifact_id: ArtifactId, on_done: Told = ignore_outcome) -> None:
        """End an artifact; raises `UnknownArtifact` when it is known to be gone."""

    def offer(
        self, name: str, artifact_type: type[Artifact], args: Sequence[object] = (), personal: bool = False
    ) -> ArtifactId:
        """Have an artifact of JaCaROS itself, such as the body of an agent; it need not be made before it is used.

        Where the workspace is served from elsewhere it is an id that nobody finds by its name.
        """
        return ArtifactId(name, artifact_type.__name__, self.path, 0, None)

    def take_back(self, artifact_id: ArtifactId) -> None:
        """End an artifact that was offered, if it is still there."""

    def execute(self, request: OperationRequest) -> UnderWay:
        """Run an operation for an agent; ``request.on_done`` is told its end, after observers were told the changes."""

    def focus(self, artifact_id: ArtifactId, observer: Observer, on_done: Told = ignore_outcome) -> None:
        """Let *observer* receive what an artifact publishes; all its properties come before *on_done* is told.

        Focusing again has no effect.  Raises `UnknownArtifact` when it is known to be gone.
        """

    def stop_focus(self, artifact_id: ArtifactId, observer: Observer) -> None:
        """Let *observer* receive nothing more, after the removal of all properties."""

    def link(self, from_id: ArtifactId, port: str, to_id: ArtifactId, on_done: Told = ignore_outcome) -> None:
        """Put an artifact behind an out port of another one; raises `OperationFailed` when that is known to be wrong."""


class Environment(Protocol):
    """All workspaces that can be seen from here."""

    @property
    def tracer(self) -> Tracer | None:
        """Told of every cause that arises, None while nobody watches."""

    @property
    def arbiter(self) -> Arbiter:
        """Decides who has what operations and plans use."""

    def used_by(self, artifact_id: ArtifactId) -> Sequence[Use]:
        """What the operations of an artifact use; nothing if it lives elsewhere."""

    @property
    def clock(self) -> Clock:
        """Where artifacts and time limits take time from."""

    def workspaces(self) -> Sequence[Workspace]:
        """All workspaces, the oldest first."""

    def workspace(self, path: str) -> Workspace:
        """The workspace with that full path; raises `UnknownWorkspace`."""

    def create_workspace(self, path: str) -> Workspace:
        """Make a workspace; raises `OperationFailed`."""

    def execute(self, request: OperationRequest) -> UnderWay:
        """Run an operation, wherever the artifact lives; see `Workspace.execute`."""

    def log_error(self, who: str, what: str, error: BaseException) -> None:
        """Tell people that *what* went wrong in the code of *who*."""
