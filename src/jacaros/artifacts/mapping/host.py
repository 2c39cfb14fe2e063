"""The interface of a mapped artifact for its parts."""

from collections.abc import Awaitable, Callable, Mapping
from typing import Any, ClassVar, NoReturn, Protocol, TypeVar

from jacaros.artifacts.env.execution import OperationExecution
from jacaros.artifacts.kit.connection import Matching
from jacaros.artifacts.kit.faults import Faults
from jacaros.artifacts.kit.reading import Reading, ReadingPolicy, Values
from jacaros.artifacts.mapping.declared import ArtifactPart, MappingFile, Place
from jacaros.artifacts.mapping.rows import Row
from jacaros.files.yaml import Problem
from jacaros.ros.action import ActionClient
from jacaros.ros.backend import Backend, Client, Publisher, Sample, Subscription, TopicEvent
from jacaros.ros.qos import QoS
from jacaros.runtime.clock import Clock
from jacaros.runtime.trace import Cause

T = TypeVar("T")

Tap = Callable[[float, Values | None, Cause | None], None]
"""Called for each message of a property or signal with its stamp (0: none), values (None: it ended) and cause."""


class Elements(Protocol):
    """The properties of the elements of an array."""

    def take(self, rows: list[Row], cause: Cause | None) -> None:
        """Take the elements of a message."""

    def show(self) -> None:
        """Bring the properties up to date."""


class Host(Protocol):
    """A mapped artifact, such as `jacaros.artifacts.mapping.artifact.MappedArtifact`.

    It is a protocol so that the parts need not know the class that is built from them.
    """

    name: str
    clock: Clock
    readings: dict[str, Reading]
    elements: dict[str, Elements]
    taps: dict[str, list[Tap]]
    mapping: ClassVar[MappingFile]
    part: ClassVar[ArtifactPart]

    @property
    def show_rows(self) -> Callable[..., object]: ...
    @property
    def show_derived(self) -> Callable[..., object]: ...
    @property
    def send_signals(self) -> Callable[..., object]: ...
    @property
    def run_process(self) -> Callable[..., object]: ...
    @property
    def report_bad_message(self) -> Callable[..., object]: ...
    @property
    def ros(self) -> Backend: ...
    @property
    def robot_prefix(self) -> str: ...
    @property
    def current(self) -> OperationExecution: ...

    def robot_topic(self, name: str) -> str: ...
    def frame(self, name: str) -> str: ...
    def adapted(self, field: str, value: object) -> object: ...
    def publisher(self, topic: str, type_name: str, qos: QoS = ...) -> Publisher: ...
    def matching_of(
        self,
        publisher: Publisher,
        timeout: float | None = ...,
        unmatched: str | None = ...,
        warn: Callable[[str, str], None] | None = ...,
    ) -> Matching: ...
    def client(self, service: str, type_name: str) -> Client: ...
    def action_client(self, name: str, type_name: str) -> ActionClient: ...
    def subscription(
        self,
        topic: str,
        type_name: str,
        callback: Callable[[Sample], None],
        qos: QoS = ...,
        on_event: Callable[[TopicEvent], None] | None = ...,
    ) -> Subscription: ...
    def faults_at(self, topic: str) -> Faults: ...
    def at_dispose(self, closing: Callable[[], None]) -> None: ...

    def reading_of(self, name: str, policy: ReadingPolicy, *initial: object) -> Reading: ...
    def annotate(self, name: str, notes: tuple[object, ...]) -> None: ...
    def follow_property(self, name: str, follower: Callable[[Values], None]) -> None: ...
    def has_untaken(self, name: str) -> bool: ...
    def has_property(self, name: str, *values: object) -> bool: ...
    def define_property(
        self, name: str, *values: object, annotations: tuple[object, ...] | None = None
    ) -> None: ...
    def update_property(
        self,
        name: str,
        *values: object,
        annotations: tuple[object, ...] | None = None,
        if_new: bool = False,
        where: tuple[object, ...] = (),
    ) -> None: ...
    def remove_property(self, name: str, *values: object) -> None: ...

    def start(
        self, operation: str | Callable[..., object], *arguments: object, cause: Cause | None = None
    ) -> None: ...
    def step(self, awaitable: Awaitable[T]) -> Awaitable[T]: ...
    def sleep(self, delay: float) -> Awaitable[None]: ...
    def pause_point(self, on_pause: Callable[[], None] | None = None) -> Awaitable[float]: ...
    def newest(self, reading: Reading, missing: str) -> Awaitable[Values]: ...
    def refresh(self, name: str, reading: Reading, missing: str) -> Awaitable[None]: ...
    def call(self, client: Client, timeout: float, /, **fields: Any) -> Awaitable[Any]: ...
    def act(
        self,
        client: ActionClient,
        goal: Mapping[str, Any],
        *,
        timeout: float | None = None,
        on_feedback: Callable[[Any], None] | None = None,
        under_way: Callable[[bool], None] | None = None,
        suspend: Any = ...,
        pause: Callable[[], Awaitable[object] | None] | None = None,
        resume: Callable[[], Awaitable[object] | None] | None = None,
        aborted: Callable[[Any], tuple[object, ...]] | None = None,
    ) -> Awaitable[Any]: ...
    def fail(self, message: str, functor: str | None = None, *arguments: object) -> NoReturn: ...
    def log(self, text: str) -> None: ...

    def report_once(self, key: object, place: Place, message: str, help: str = "") -> None: ...
    def report(self, problems: list[Problem]) -> None: ...
    def on_topic_event(self, topic: str, place: Place) -> Callable[[TopicEvent], None]: ...
