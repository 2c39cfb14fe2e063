"""``jacaros ros map``: a first mapping file for a graph, for you to edit."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from itertools import product

from jacaros.robots.ros.guarded import VELOCITIES
from jacaros.runtime.cli.graph.joining import Joined, NothingThere, root
from jacaros.runtime.cli.graph.listing import GraphEntry, GraphKind
from jacaros.runtime.cli.graph.standard_topics import robot_of, robots
from jacaros.runtime.cli.graph.suggestions import (
    MappingEntry,
    acting,
    calling,
    looking,
    plain_name,
    property_of,
    publishing,
)

_SECTIONS = ("properties", "signals", "frames", "operations")
_NAMES = {
    "navigate_to_pose": "navigate_to",
    "move_base": "navigate_to",
    "dock_robot": "dock",
    "undock_robot": "undock",
    "dock_drive_action": "dock",
    "cmd_vel": "drive",
    "battery_state": "battery",
}
"""ROS names, and better names for plans."""
_VAGUE = ("compressed", "compressed_depth", "data", "feedback", "info", "raw", "state", "status", "value")
"""Last parts of names that mean nothing without the part before."""
_COMMENT_AT = 41
"""Column where comments begin."""
_LEFT_AT_MOST = 12
_BODIES = ("base_link", "base_footprint")


@dataclass
class _Artifact:
    name: str
    namespace: str
    entries: list[MappingEntry] = field(default_factory=list)

    def free_name(self, ros_name: str) -> str:
        """Return a free name: the last part of the ROS name, with further parts in front or a number if that is taken."""
        taken = {entry.name for entry in self.entries}
        parts = [part for part in ros_name.split("/") if part]
        plain = [plain_name("_".join(parts[-count:])) for count in range(1, len(parts) + 1)]
        if plain[0] in _VAGUE:
            plain = plain[1:] or plain
        names = [_NAMES.get(plain[0], plain[0]), *plain]
        names += [f"{plain[-1]}{number}" for number in range(2, len(taken) + 3)]
        return next(name for name in names if name not in taken)

    def relative(self, name: str) -> str:
        """Return a ROS name as written in the file, relative to the namespace."""
        inside = f"/{self.namespace}/" if self.namespace else "/"
        return name.removeprefix(inside) if name.startswith(inside) else name


def lines_for(joined: Joined, thing: GraphEntry) -> list[str]:
    """Return the lines of a mapping file for one topic, service or action."""
    artifact = _Artifact("robot", robot_of(thing.name, robots(joined.contents)))
    _add(joined, artifact, thing)
    return [*_namespace(artifact), *_body(artifact)]


def mapping_for(
    joined: Joined,
    things: Sequence[GraphEntry],
    frames: dict[str, str],
    file: str,
    options: str,
    left: Sequence[GraphEntry],
) -> str:
    """Return the text of a mapping file.

    Args:
        joined: the graph.
        things: topics, services and actions, see `find_mappable`.
        frames: result of `joining.frames`; empty for no frames.
        file: name of the file, for the comments.
        options: options of the commands in the comments, such as ``--ros ros2``.
        left: topics, services and actions that were left out, for a comment.

    Raises:
        UnknownInterface: the definition of a type is not available.
    """
    spaces = robots(joined.contents)
    homes = {thing: robot_of(thing.name, spaces) for thing in things}
    used = sorted(set(homes.values()))
    artifacts = [_Artifact(plain_name(space) if space else "common", space) for space in used]
    if len(list(filter(None, used))) <= 1:  # one robot, which has the rest, too
        artifacts = [_Artifact("robot", "".join(used))]
    for artifact in artifacts:
        for thing, space in homes.items():
            if len(artifacts) == 1 or space == artifact.namespace:
                _add(joined, artifact, thing)
        artifact.entries += _frame(artifact, frames)
    return "\n".join([*_file(artifacts, file, options), *_left(left, options)]) + "\n"


def _add(joined: Joined, artifact: _Artifact, thing: GraphEntry) -> None:
    if not thing.type_name:
        raise NothingThere(f"unknown type of {thing.kind} `{thing.name}`\n  = help: write this entry by hand")
    types, name, written = joined.backend, artifact.free_name(thing.name), artifact.relative(thing.name)
    if thing.kind is not GraphKind.TOPIC:
        suggest = calling if thing.kind is GraphKind.SERVICE else acting
        artifact.entries.append(suggest(types, name, written, thing.type_name))
        return
    info = joined.contents.topics[thing.name]
    if info.subscriptions and (not info.publishers or thing.type_name in VELOCITIES):
        artifact.entries += publishing(types, name, written, info)
        return
    entry = property_of(types, name, written, info)
    artifact.entries += filter(None, (entry, looking(entry)))


def _frame(artifact: _Artifact, frames: dict[str, str]) -> list[MappingEntry]:
    """Return an entry for the pose of the robot in the map, from tf; without a map, odometry gives the same pose."""
    prefix = f"{artifact.namespace}/" if artifact.namespace else ""
    for body, inside in product(_BODIES, dict.fromkeys((prefix, ""))):
        targets = dict.fromkeys(("map", f"{inside}map"))
        target = next((each for each in targets if _joins(frames, each, f"{inside}{body}")), None)
        if target is None:
            continue
        name = "pose" if all(entry.name != "pose" for entry in artifact.entries) else "pose_in_tf"
        lines = (
            f"target: {target.removeprefix(inside)}",
            f"source: {body}",
            "fields: [{path: x, round: 2}, {path: y, round: 2}, {path: yaw, unit: degrees, round: 1}]",
            "rate: 5",
            "dead_band: [0.02, 0.02, 1]",
        )
        pose = MappingEntry("frames", name, f"{name}(X, Y, Yaw) in {target}: metres, metres, degrees", lines)
        if not prefix or inside:
            return [pose]
        return [
            MappingEntry("", "tf_prefix", "frames of this robot have no prefix", ('tf_prefix: ""',)),
            pose,
        ]
    return []


def _joins(frames: dict[str, str], target: str, source: str) -> bool:
    return target in frames and source in frames and root(frames, target) == root(frames, source)


def _file(artifacts: list[_Artifact], file: str, options: str) -> Iterator[str]:
    yield from _head(artifacts, file, options)
    several = len(artifacts) > 1
    if several:
        yield "artifacts:"
    for artifact in artifacts:
        lines = (*_namespace(artifact), *_connected(artifact), *_body(artifact))
        if several:
            lines = (f"  {artifact.name}:", *(f"    {line}".rstrip() for line in lines), "")
        yield from lines


def _head(artifacts: list[_Artifact], file: str, options: str) -> Iterator[str]:
    yield "# A first mapping file for a robot, written by `jacaros ros map`, for you to edit."
    yield "#"
    yield "# Properties become beliefs, signals become events, and agents call operations. The comments show how to write"
    yield '# each in a plan. The reference page "Mapping files" lists all keys.'
    yield "#"
    yield f"#   jacaros check {file}"
    yield f"#   jacaros ros check {file}{options}"
    yield f"#   jacaros run agent.asl --mapping {file}{options}"
    example = _example(artifacts)
    if example:
        yield "#"
        yield "# A first agent.asl for it:"
        yield "#"
        yield f"#   {example}"
    yield ""


def _left(left: Sequence[GraphEntry], options: str) -> Iterator[str]:
    """Yield a comment with the rest of the graph, so that the file does not look complete."""
    if not left:
        return
    yield ""
    yield f"# Not in this file; `jacaros ros show NAME{options}` prints the entry for one of them:"
    yield "#"
    for thing in left[:_LEFT_AT_MOST]:
        yield f"#   {thing.kind} {thing.name}"
    if len(left) > _LEFT_AT_MOST:
        yield f"#   and {len(left) - _LEFT_AT_MOST} more: `jacaros ros list{options}`"


def _example(artifacts: list[_Artifact]) -> str:
    """Return a plan that prints a belief."""
    for entry in (each for artifact in artifacts for each in artifact.entries):
        head = entry.comment.partition(":")[0]
        if entry.section in ("properties", "frames") and head.startswith(f"{entry.name}("):
            arguments = head.partition("(")[2].split(")")[0]
            printed = ', " ", '.join(arguments.split(", "))
            return f'+{entry.name}({arguments}) <- .print("{entry.name} ", {printed}).'
    return ""


def _namespace(artifact: _Artifact) -> Iterator[str]:
    if artifact.namespace:
        yield _with_comment(f"namespace: {artifact.namespace}", "makeArtifact can override it")
    for entry in artifact.entries:
        if not entry.section:
            yield _with_comment(entry.lines[0], entry.comment)


def _connected(artifact: _Artifact) -> Iterator[str]:
    if any(entry.section == "properties" for entry in artifact.entries):
        odometry = f"/{artifact.namespace}/odom" if artifact.namespace else "/odom"
        comment = f'connected("{odometry}") and so on, while the topic has a publisher'
        yield _with_comment("connected: true", comment)


def _body(artifact: _Artifact) -> Iterator[str]:
    for section in _SECTIONS:
        entries = [entry for entry in artifact.entries if entry.section == section]
        if not entries:
            continue
        yield ""
        yield f"{section}:"
        for entry in entries:
            yield _with_comment(f"  {entry.name}:", entry.comment)
            yield from (_aligned(f"    {line}") for line in entry.lines)


def _aligned(line: str) -> str:
    """Align the comment of a line with all other comments."""
    key, sign, comment = line.partition("  # ")
    return _with_comment(key.rstrip(), comment) if sign and key.strip() else line


def _with_comment(line: str, comment: str) -> str:
    return f"{line.ljust(_COMMENT_AT - 2)}  # {comment}"
