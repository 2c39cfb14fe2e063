"""What members say to each other, as payloads of their channel."""

from typing import Any

import msgspec

ArtifactData = tuple[int, str, str, str | None, list[str]]
"""Number, name, type, creator and operations of an artifact."""
StepData = tuple[str, str, str, int]
"""A step: full name of its agent, what its plan is for, file and line. See `jacaros.runtime.trace.Origin`."""
PropertyData = tuple[int, str, Any, Any]
"""Key, name, values and annotations of a property."""

LARGEST = 32 << 20
"""Bytes of one thing that is said. A network drops much larger ones, however often they are sent again."""
TOO_LARGE = f"values of more than {LARGEST >> 20} MiB cannot be sent to another system: send them in parts"


class _Said(msgspec.Struct, array_like=True, tag=True):
    """One thing that a member says. The tag is the name of the class."""


class Here(_Said):
    """The whole picture of a member, at joining and after each gap.

    Attributes:
        epoch: number of its present session with the other side; a new one begins when it has lost it.
        knows: number of the newest session of the other side that it has heard of; 0: none.
        agents: their names.
        services: agents and what they provide.
        workspaces: paths, each with its artifacts.
        page: address of its live page, or empty.
    """

    epoch: int
    knows: int
    agents: list[str]
    services: list[tuple[str, str]]
    workspaces: list[tuple[str, list[ArtifactData]]]
    page: str


class Watched(_Said):
    """Whether the member records its run, so that it needs causes, and the address of its live page (or empty)."""

    records: bool
    page: str


class Bye(_Said):
    """The member ends."""


class AgentNews(_Said):
    """An agent began or ended."""

    name: str
    present: bool


class ServiceNews(_Said):
    """An agent provides a service from now on, or no longer."""

    agent: str
    service: str
    provides: bool


class Message(_Said):
    """A message of an agent. ``cause`` is the step that sent it, for explanations."""

    performative: str
    sender: str
    receiver: str
    content: Any
    id: str
    in_reply_to: str | None
    cause: StepData | None


class Returned(_Said):
    """A message could not be put into the mailbox of its receiver. The content is as it was sent."""

    id: str
    sender: str
    receiver: str
    performative: str
    content: Any
    reason: str


class WorkspaceNews(_Said):
    """A workspace was created or removed."""

    path: str
    present: bool


class ArtifactNews(_Said):
    """An artifact was created, has changed its operations, or (None as data) is gone."""

    workspace: str
    number: int
    data: ArtifactData | None


class Execute(_Said):
    """Run an operation. ``cause`` is the step that asks for it."""

    call: int
    artifact: int
    operation: str
    arguments: Any
    agent: str | None
    timeout: float | None
    urgency: int
    policy: str
    yields: bool
    cause: StepData | None


class Create(_Said):
    """Create an artifact."""

    call: int
    workspace: str
    name: str
    type_name: str
    arguments: Any
    creator: str | None


class CreateWorkspace(_Said):
    """Create a workspace."""

    call: int
    path: str


class Dispose(_Said):
    """Dispose an artifact."""

    call: int
    artifact: int


class Focus(_Said):
    """Let an agent observe an artifact. ``observer`` is a number of the asking side."""

    call: int
    artifact: int
    observer: int
    agent: str


class StopFocus(_Said):
    """End an observer of an artifact."""

    artifact: int
    observer: int


class Link(_Said):
    """Link two artifacts of the same member."""

    call: int
    artifact: int
    port: str
    to: int


class Handle(_Said):
    """Cancel, pause or resume a call."""

    call: int
    what: str


class Ended(_Said):
    """A call has ended. ``results`` are the values of output parameters, each in a list; an empty one is unset."""

    call: int
    ok: bool
    message: str | None
    reason: Any
    results: list[list[Any]]
    artifact: int | None


class Observed(_Said):
    """What an artifact published since the last time.

    Attributes:
        observer: number of the observer.
        whole: whether these are all properties, after the beginning of a focus.
        signals: names and arguments.
        properties: new and changed ones.
        removed: keys of removed ones.
        cause: the step that led to it, if that is known.
    """

    observer: int
    whole: bool
    signals: list[tuple[str, Any]]
    properties: list[PropertyData]
    removed: list[int]
    cause: StepData | None


class Ask(_Said):
    """A request of a visitor: ``ping`` or ``stop``. See `jacaros.fleet.visits`."""

    call: int
    what: str


class Answer(_Said):
    """The answer to it. ``refused`` says why it was refused, or is empty."""

    call: int
    refused: str


Said = (
    Here | Watched | Bye | AgentNews | ServiceNews | Message | Returned | WorkspaceNews | ArtifactNews | Execute | Create
    | CreateWorkspace | Dispose | Focus | StopFocus | Link | Handle | Ended | Observed | Ask | Answer
)  # fmt: skip
"""Anything that a member says."""

write = msgspec.msgpack.Encoder().encode
read = msgspec.msgpack.Decoder(Said).decode
