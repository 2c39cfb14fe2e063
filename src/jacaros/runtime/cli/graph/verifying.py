"""``jacaros ros check``: compare a mapping file with a graph."""

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass

from jacaros.robots.mapping.checking import UNCERTAIN, check_topic, type_problems
from jacaros.robots.mapping.fields import FilePosition, Written
from jacaros.robots.mapping.file import ArtifactPart
from jacaros.robots.mapping.operations import OperationKind, OperationPart
from jacaros.robots.mapping.properties import FramePart, TopicPart
from jacaros.robots.ros.backend import Endpoint, alike, latching
from jacaros.robots.ros.errors import RosError
from jacaros.robots.ros.guarded import VELOCITIES
from jacaros.robots.ros.names import frame_name, near_names
from jacaros.robots.ros.node import Capability
from jacaros.robots.ros.qos import DEFAULT_QOS, SENSOR_DATA, STATE, QoS, incompatibility
from jacaros.runtime.cli.graph.joining import Joined, root
from jacaros.runtime.files.texts import did_you_mean
from jacaros.runtime.files.yaml import Problem

MOST_NAMES = 8
"""Number of known names listed in a suggested fix."""

_VERBS = {OperationKind.SERVICE: "offers the service", OperationKind.ACTION: "offers the action"}


@dataclass(frozen=True, slots=True)
class ResolvedNames:
    """Names of an artifact, resolved in the graph."""

    joined: Joined
    part: ArtifactPart

    def resolve(self, written: str) -> str:
        """Return the absolute name of a topic, service, action or node."""
        if self.part.namespace and not written.startswith(("/", "~")):
            written = f"{self.part.namespace}/{written}"
        return self.joined.backend.resolve(written)

    def frame(self, written: str) -> str:
        """Return the name of a frame."""
        return frame_name(written, self.tf_prefix)

    @property
    def tf_prefix(self) -> str:
        """Prefix of frames: that of the file, by default the namespace."""
        if self.part.tf_prefix is not None:
            return self.part.tf_prefix
        return self.resolve("frame").rpartition("/")[0].strip("/")


def topics_of(joined: Joined, part: ArtifactPart) -> set[str]:
    """Return the absolute names of the topics that an artifact receives or publishes."""
    names = ResolvedNames(joined, part)
    received = [topic.topic.text for topic in part.topics if topic.topic is not None]
    published = [each.target.text for each in part.operations if each.kind is OperationKind.PUBLISH]
    return {names.resolve(written) for written in (*received, *published)}


async def problems_of(joined: Joined, part: ArtifactPart, frames: dict[str, str]) -> list[Problem]:
    """Return all problems of an artifact, each with what was found and a suggested fix.

    Args:
        joined: graph to compare with.
        part: an artifact of the file.
        frames: the frames received.
    """
    names = ResolvedNames(joined, part)
    for folder in part.interfaces:
        joined.backend.add_interfaces(folder)
    found: list[Problem] = []
    for topic in part.topics:
        found += _of_topic(names, topic)
    for operation in part.operations:
        found += _of_operation(names, operation)
    for frame in part.frames:
        found += _of_frame(names, frame, frames)
    reported = {(each.line, each.column) for each in found}
    found += [
        each
        for each in type_problems(part, joined.backend)
        if not (each.message.endswith(UNCERTAIN) and (each.line, each.column) in reported)
    ]
    for each in part.operations:
        if each.kind is OperationKind.SET and each.node:
            wrong = await _of_parameter(names, each.node, each.target.text, each.place)
            found += filter(None, [wrong])
    return sorted(set(found), key=lambda problem: (problem.line, problem.column, problem.message))


def warnings_of(joined: Joined, part: ArtifactPart) -> Iterator[Problem]:
    """Yield a warning for each topic of velocities that another node publishes on, too."""
    names = ResolvedNames(joined, part)
    for operation in part.operations:
        if operation.kind is not OperationKind.PUBLISH:
            continue  # the target of other operations may be empty, or not a topic
        info = joined.contents.topics.get(names.resolve(operation.target.text))
        if info is not None and info.publishers and any(each in VELOCITIES for each in info.types):
            yield operation.target.place.problem(
                f"{nodes_of(info.publishers)} also publishes on {info.name}: the robot follows whichever command came last",
                "give every source a topic of its own, and let twist_mux choose between them",
            )


def _of_topic(names: ResolvedNames, topic: TopicPart) -> Iterator[Problem]:
    written = topic.topic
    assert written is not None
    name = names.resolve(written.text)
    info = names.joined.contents.topics.get(name)
    if info is None:
        near = names.joined.contents.near_topics(name, _text(topic.type_name), "publishers")
        yield _absent(names, written, f"no node publishes `{name}`", near)
        return
    if not info.publishers:
        who = nodes_of(info.subscriptions)
        yield written.place.problem(
            f"no node publishes `{name}`; it has only subscriptions, by {who}",
            "start the node that publishes it, or replace the property by an operation with `publish`",
        )
        return
    wrong = _of_type(topic.type_name, info.types, written.place)
    yield from wrong
    if topic.type_name is None and not wrong:
        found: list[Problem] = []
        try:
            check_topic(topic, info.types[0], names.joined.backend, found)
            yield from found
        except RosError as error:
            yield written.place.problem(str(error), "install the package of this type")
    requested = topic.qos or (SENSOR_DATA if topic.signal else STATE)
    for end in info.publishers:
        help = "" if end.qos is None else _suiting(end.qos, requested)
        yield from _of_qos(written.place, name, end, end.qos, requested, help)
    nodes = latching(info)
    if nodes and requested.durability == "volatile" and not topic.signal:
        text = f"{nodes} latches its messages on {name}, and earlier ones are not requested"
        yield written.place.problem(text, "write qos: latched")


def _of_qos(
    place: FilePosition, topic: str, end: Endpoint, offered: QoS | None, requested: QoS | None, help: str
) -> Iterator[Problem]:
    """Yield a problem if the quality of service is incompatible with that of *end*; None: unknown."""
    why = None if offered is None or requested is None else incompatibility(offered, requested)
    if why is not None:
        yield place.problem(
            f"incompatible QoS with {end.node or 'an unknown node'} on {topic}: {why}", f"write {help}"
        )


def _suiting(offered: QoS, requested: QoS) -> str:
    """Return the quality of service to request, so that the offered one is sufficient."""
    reliability = "best_effort" if offered.reliability == "best_effort" else requested.reliability
    durability = "volatile" if offered.durability == "volatile" else requested.durability
    if durability == "volatile" and requested.deadline is None:
        return "qos: sensor_data" if reliability == "best_effort" else "qos: default"
    deadline = "" if offered.deadline is None else f", deadline: {offered.deadline:g}"
    return f"qos: {{reliability: {reliability}, durability: {durability}{deadline}}}"


def _of_type(written: Written | None, found: Iterable[str], place: FilePosition) -> list[Problem]:
    """Compare the type in the file with the types found; `place` is that of the name."""
    types = [each for each in found if each]
    if len(types) > 1:
        text = f"conflicting types: {', '.join(types)}"
        return [place.problem(text, "a node uses another type: `jacaros ros show` lists its nodes")]
    if written is None or not types or written.text == types[0]:
        return []
    return [
        written.place.problem(f"expected the type `{types[0]}`, found `{written.text}`", f"type: {types[0]}")
    ]


def _of_operation(names: ResolvedNames, operation: OperationPart) -> Iterator[Problem]:
    if operation.kind is OperationKind.PUBLISH:
        yield from _of_publishing(names, operation)
    if operation.kind not in _VERBS:
        return
    contents, written = names.joined.contents, operation.target
    things = contents.services if operation.kind is OperationKind.SERVICE else contents.actions
    name = names.resolve(written.text)
    if name in things:
        yield from _of_type(operation.type_name, [things[name]], written.place)
    else:
        types = {each: (type_name,) for each, type_name in things.items()}
        near = near_names(name, things, alike(_text(operation.type_name), types))
        yield _absent(names, written, f"no node {_VERBS[operation.kind]} `{name}`", near)


def _of_publishing(names: ResolvedNames, operation: OperationPart) -> Iterator[Problem]:
    written = operation.target
    name = names.resolve(written.text)
    info = names.joined.contents.topics.get(name)
    if info is None or not info.subscriptions:
        near = names.joined.contents.near_topics(name, _text(operation.type_name), "subscriptions")
        yield _absent(names, written, f"no node subscribes to `{name}`", near)
        return
    yield from _of_type(operation.type_name, info.types, written.place)
    for end in info.subscriptions:
        latched = end.qos is not None and end.qos.durability == "transient_local"
        help = "qos: latched" if latched else "qos: default"
        yield from _of_qos(written.place, name, end, operation.qos or DEFAULT_QOS, end.qos, help)


def _absent(names: ResolvedNames, written: Written, what: str, near: Iterable[str]) -> Problem:
    """Return the problem for a missing name, with the names that it may mean."""
    help = did_you_mean([_as_written(names, each) for each in near])
    return written.place.problem(what, help or "start its node; `jacaros ros list` shows all names")


def _text(type_name: Written | None) -> str:
    return "" if type_name is None else type_name.text


def _as_written(names: ResolvedNames, name: str) -> str:
    """Return an absolute name as written in the file."""
    prefix = names.resolve("x").removesuffix("x")
    return name.removeprefix(prefix) if name.startswith(prefix) else name


def _of_frame(names: ResolvedNames, part: FramePart, frames: dict[str, str]) -> Iterator[Problem]:
    target, source = names.frame(part.target), names.frame(part.source)
    if not frames:
        yield part.place.problem("no frames on /tf and /tf_static", "start the node that publishes them")
        return
    unknown = [frame for frame in dict.fromkeys((target, source)) if frame not in frames]
    for frame in unknown:
        near = near_names(frame, list(frames))
        help = did_you_mean(near) or f"frames: {_first(sorted(frames))}"
        prefix = names.tf_prefix
        if prefix and frame.startswith(f"{prefix}/") and frame.removeprefix(f"{prefix}/") in frames:
            help = 'frames of this robot have no prefix: write tf_prefix: ""'
        yield part.place.problem(f"unknown frame `{frame}`", help)
    if not unknown and root(frames, target) != root(frames, source):
        yield part.place.problem(
            f"frames `{target}` and `{source}` are not connected: their roots are `{root(frames, target)}` and "
            f"`{root(frames, source)}`",
            "start the node that connects them, such as localisation",
        )


async def _of_parameter(
    names: ResolvedNames, node: str, parameter: str, place: FilePosition
) -> Problem | None:
    joined = names.joined
    if Capability.PARAMETERS not in joined.backend.capabilities:
        return place.problem("this graph has no parameters", "remove the entry")
    name = names.resolve(node)
    if name not in joined.contents.nodes:
        near = near_names(name, joined.contents.nodes)
        return place.problem(
            f"unknown node `{name}`", did_you_mean(near, "`jacaros ros list` shows all nodes")
        )
    try:
        there = await joined.backend.parameters(name).names(joined.timeout)
    except RosError as error:
        text = f"node `{name}` does not report its parameters: {error}"
        return place.problem(text, "check that it is running")
    if parameter in there:
        return None
    help = did_you_mean(near_names(parameter, there)) or f"its parameters: {_first(there) or 'none'}"
    return place.problem(f"unknown parameter `{parameter}` of node `{name}`", help)


def _first(names: Sequence[str]) -> str:
    return ", ".join(names[:MOST_NAMES]) + (", ..." if len(names) > MOST_NAMES else "")


def nodes_of(endpoints: Iterable[Endpoint]) -> str:
    """Return the names of the nodes of some endpoints."""
    return ", ".join(sorted({each.node or "an unknown node" for each in endpoints}))
