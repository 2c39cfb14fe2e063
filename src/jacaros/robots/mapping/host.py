"""The mapped artifact, as its parts use it; and the types that a mapping omits."""

from collections.abc import Callable
from typing import ClassVar

from jacaros.artifacts.env.artifact import internal_operation
from jacaros.robots.kit.reading import Reading
from jacaros.robots.kit.ros_artifact import RosArtifact
from jacaros.robots.mapping.fields import FilePosition, Written
from jacaros.robots.mapping.file import ArtifactPart, MappingFile
from jacaros.robots.ros.backend import GraphContents
from jacaros.robots.ros.errors import RosError
from jacaros.robots.ros.names import frame_name
from jacaros.robots.ros.node import TopicEvent, TopicTrouble
from jacaros.robots.ros.waiting import MISSING_AFTER
from jacaros.robots.streams import ReadingPolicy, Values
from jacaros.runtime.files.yaml import Problem, shown
from jacaros.runtime.trace import Cause

Tap = Callable[[float, Values | None, Cause | None], None]
"""Called for each message of a property or signal with its stamp (0: none), values (None: it ended) and cause."""


class MappingHost(RosArtifact):
    """The base class of `jacaros.robots.mapping.artifact.MappedArtifact`, which is built from the parts.

    Attributes:
        mapping: the file.
        part: the declaration of this artifact.
        readings: the properties that operations refresh, by name.
        taps: called with the messages of properties and signals, by their names.
    """

    mapping: ClassVar[MappingFile]
    part: ClassVar[ArtifactPart]

    def open(self) -> None:
        """Begin without any parts."""
        self.readings: dict[str, Reading] = {}
        self.taps: dict[str, list[Tap]] = {}
        self._reported: set[object] = set()

    @property
    def robot_prefix(self) -> str:
        """Prefix of relative names: from ``makeArtifact``, or else from the file."""
        given = super().robot_prefix
        return given or (f"/{self.part.namespace}" if self.part.namespace else "")

    @property
    def tf_prefix(self) -> str:
        """Prefix of frame names."""
        given = self.option("tf_prefix", self.part.tf_prefix)
        return self.frame_prefix if given is None else given.strip("/")

    def frame(self, name: str) -> str:
        """Return the name of a frame in the graph."""
        return frame_name(name, self.tf_prefix)

    def adapted(self, field: str, value: object) -> object:
        """Adapt a constant for the field of a message: frame names get their prefix."""
        if field in ("frame_id", "child_frame_id") and isinstance(value, str):
            return self.frame(value)
        return value

    # ---- properties

    def reading_of(self, name: str, policy: ReadingPolicy) -> Reading:
        """Return the reading of a property, also for operations that refresh it."""
        made = self.readings[name] = self.reading(name, policy)
        return made

    @internal_operation
    def show_property(self, name: str, show: object) -> None:
        """Bring the property *name* up to date, by calling *show*."""
        del name  # only the log needs it
        assert callable(show)
        show()

    @internal_operation
    def send_signals(self, name: str, rows: object) -> None:
        """Send one signal for each tuple of values."""
        assert isinstance(rows, list)
        for values in rows:
            self.signal(name, *values)

    @internal_operation
    async def run_process(self, process: object) -> None:
        """Run a long-running process for as long as the artifact exists."""
        assert callable(process)
        await process()  # pyright: ignore[reportGeneralTypeIssues]

    # ---- log

    def report_once(self, key: object, place: FilePosition, message: str, help: str = "") -> None:
        """Log a problem with the line of the mapping, the first time only."""
        if key in self._reported:
            return
        self._reported.add(key)
        self.report([place.problem(message, help)])

    def report(self, problems: list[Problem]) -> None:
        """Log problems."""
        lines = self.mapping.text.splitlines()
        for problem in problems:
            self.log(shown(self.mapping.file, lines, problem))

    def on_topic_event(self, topic: str, place: FilePosition) -> Callable[[TopicEvent], None]:
        """Return a callback that logs each kind of problem of a topic once."""

        def report(event: TopicEvent) -> None:
            weak = event.trouble is TopicTrouble.INCOMPATIBLE_QOS
            help = "write qos: sensor_data, which is compatible with any publisher" if weak else ""
            self.report_once((topic, event.trouble), place, event.text, help)

        return report


# Types that a mapping omits are looked up in the graph.

LOOK = 0.5
"""Seconds between two queries of the graph."""

_EXAMPLES = {"topic": "msg/Type", "service": "srv/Type", "action": "action/Type"}


def type_in(contents: GraphContents, kind: str, name: str) -> str:
    """Return the type of a topic, service or action by its absolute name; empty if it does not exist."""
    if kind == "topic":
        topic = contents.topics.get(name)
        return topic.types[0] if topic is not None and topic.types else ""
    return (contents.services if kind == "service" else contents.actions).get(name, "")


async def ask_type(host: MappingHost, kind: str, written: Written) -> str:
    """Return the type of a topic, service or action that an operation uses; a step boundary.

    Raises:
        OperationFailed: ``type_unknown(Name)``.
    """
    name = host.ros.resolve(host.robot_topic(written.text))
    patience = host.clock.elapsed + MISSING_AFTER
    try:
        # A node that has just joined needs some time to discover its graph.
        while not (found := type_in(await host.step(host.ros.contents()), kind, name)):
            if host.clock.elapsed >= patience:
                break
            await host.sleep(LOOK)
    except RosError as error:
        host.fail(str(error), "type_unknown", name)
    if not found:
        where = host.mapping.where(written.place)
        help = f"start the node that offers it, or write its type in {where}: type: package/{_EXAMPLES[kind]}"
        host.fail(f"unknown {kind} {name}, so its type is unknown; {help}", "type_unknown", name)
    return found
