"""The ports of an environment, for everything that acts and observes in it.

`jacaros.artifacts.env.workspace.Workspace` implements the port of workspaces. Workspaces of another process can do so, too:
see `jacaros.artifacts.env.environment.Environment.mount`.

A *lookup* returns immediately, from local knowledge: a remote workspace keeps a copy of its artifacts and what they
offer. A *request* may take time. Its outcome is passed to a callback, possibly before the method returns, and never
after a cancel.
"""

import asyncio
from collections.abc import Callable, Collection, Mapping, Sequence
from functools import partial
from types import MappingProxyType
from typing import Any, Final, Protocol, runtime_checkable

from jacaros.artifacts.env.errors import ArtifactId
from jacaros.artifacts.env.operation import OperationOutcome, OperationRequest, ignore_outcome
from jacaros.artifacts.env.property import Observer
from jacaros.runtime.trace import Cause

OnOutcome = Callable[[OperationOutcome], None]
"""Called with the outcome of a request."""

OnMade = Callable[[ArtifactId | None, OperationOutcome], None]
"""Called with the id of a new artifact, or with None and the failure."""


def ignore_made(artifact_id: ArtifactId | None, outcome: OperationOutcome) -> None:
    """Ignore the creation of an artifact."""


class UnderWay(Protocol):
    """A request that has not ended, here or in another process."""

    def cancel(self) -> None:
        """Cancel it. Its outcome is not reported."""

    def pause(self) -> None:
        """Pause it, if it is pausable."""

    def resume(self) -> None:
        """Let it continue."""


class WaitingRequest:
    """A request that only waits, so that there is nothing to pause. Cancelling calls *stop*."""

    def __init__(self, stop: Callable[[], None]) -> None:
        self.cancel = stop

    def pause(self) -> None:
        """Do nothing."""

    def resume(self) -> None:
        """Do nothing."""


ENDED: Final = WaitingRequest(lambda: None)
"""The handle of a request that has ended."""


async def awaited(begin: Callable[[OnMade], UnderWay]) -> ArtifactId:
    """Begin a request for an artifact, and wait for it. Cancelling the wait cancels the request.

    Raises:
        OperationFailed: the request failed.
    """
    found: asyncio.Future[ArtifactId] = asyncio.get_running_loop().create_future()

    def on_done(artifact_id: ArtifactId | None, outcome: OperationOutcome) -> None:
        if found.done():
            return
        if artifact_id is not None:
            found.set_result(artifact_id)
        else:
            found.set_exception(outcome.failure)

    under_way = begin(on_done)
    try:
        return await found
    except asyncio.CancelledError:
        under_way.cancel()
        raise


@runtime_checkable
class Workspace(Protocol):
    """A workspace, local or remote. Its ids contain its `path`.

    Attributes:
        path: full path in the environment in which it is visible, such as ``/main/lab``.
        name: last part of the path.
        known: results of `providers` that still hold. Empty if they cannot be known, as for a remote workspace.
        member: name of the system of a fleet that has it; empty for this one.
    """

    path: str
    name: str
    known: Mapping[tuple[str, int], tuple[ArtifactId, ...]] = MappingProxyType({})
    member: str = ""

    # ---- lookups

    def artifacts(self) -> tuple[ArtifactId, ...]:
        """Return all artifacts, the oldest first."""

    def lookup(self, name: str) -> ArtifactId:
        """Return the artifact with this name. Raises `UnknownArtifact`."""

    def watch(
        self, watcher: Callable[[ArtifactId, bool], None], personal: bool = False
    ) -> Callable[[], None]:
        """Call *watcher* with every artifact that is added (True) or removed (False). Return a function that ends this.

        With *personal*, include the bodies and sessions of agents, which are many.
        """

    def providers(self, operation: str, arity: int) -> tuple[ArtifactId, ...]:
        """Return the artifacts that offer *operation* with *arity* arguments to agents, the oldest first."""

    def offers(self, artifact_id: ArtifactId) -> Collection[str]:
        """Return the operations of an artifact for agents, such as ``inc/1`` and ``sum/any``. Raises `UnknownArtifact`."""

    def has_method(self, artifact_id: ArtifactId, name: str) -> bool:
        """Return whether its class has a public method of this name that is not an operation. See `offers`."""

    # ---- requests

    async def make_artifact(
        self,
        name: str,
        type_name: str | type[Any],
        args: Sequence[object] = (),
        creator: str | None = None,
    ) -> ArtifactId:
        """Create an artifact and wait until its ``init`` has ended.

        Args:
            name: unique in the workspace.
            type_name: a type that the workspace knows, or the class itself.
            args: plain values for ``init``.
            creator: the agent that creates it.

        Raises:
            OperationFailed: with reason ``makeArtifactFailure(Why,What)``, where Why is
                ``"artifact_already_present"``, ``"unknown_artifact_template"`` (What is the type) or
                ``"init_failed"``. Nothing remains of the artifact.
        """
        return await awaited(partial(self.create, name, type_name, args, creator))

    def create(
        self,
        name: str,
        type_name: str | type[Any],
        args: Sequence[object] = (),
        creator: str | None = None,
        on_done: OnMade = ignore_made,
        cause: Cause | None = None,
    ) -> UnderWay:
        """Create an artifact of a type that the workspace knows, and report to *on_done*."""

    def dispose_artifact(self, artifact_id: ArtifactId, on_done: OnOutcome = ignore_outcome) -> None:
        """Dispose an artifact. Raises `UnknownArtifact` if it is known to be gone."""

    def offer(
        self, name: str, artifact_type: type[Any], args: Sequence[object] = (), personal: bool = False
    ) -> ArtifactId:
        """Add an artifact of JaCaROS itself, such as the body of an agent. It may be created at its first use.

        In a remote workspace, it is an id that cannot be looked up by name.
        """
        return ArtifactId(name, artifact_type.__name__, self.path, 0, None)

    def take_back(self, artifact_id: ArtifactId) -> None:
        """Dispose an artifact that was added with `offer`, if it still exists."""

    def execute(self, request: OperationRequest) -> UnderWay:
        """Run an operation for an agent. ``request.on_done`` gets the outcome after observers have received the changes."""

    def focus(self, artifact_id: ArtifactId, observer: Observer, on_done: OnOutcome = ignore_outcome) -> None:
        """Let *observer* receive what an artifact publishes. It receives all properties before *on_done* is called.

        Focusing again has no effect. Raises `UnknownArtifact` if the artifact is known to be gone.
        """

    def stop_focus(self, artifact_id: ArtifactId, observer: Observer) -> None:
        """Stop sending observations to *observer*. The last one removes all properties."""

    def link(
        self, from_id: ArtifactId, port: str, to_id: ArtifactId, on_done: OnOutcome = ignore_outcome
    ) -> None:
        """Link an out port of an artifact to another artifact. Raises `OperationFailed` if that is known to be invalid."""
