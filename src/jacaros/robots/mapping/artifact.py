"""The artifact that a mapping file declares, and the construction of its class. Types have the names of mapping
files: ``turtlebot.yaml``, ``fleet.yaml#arm``."""

import inspect
from collections.abc import Callable, Mapping, Sequence
from functools import partial
from pathlib import Path
from typing import Any, ClassVar

from jacaros.artifacts.env.arbiter import WHEELS
from jacaros.artifacts.env.artifact import Out, operation
from jacaros.artifacts.env.errors import UnknownArtifactType
from jacaros.robots.kit.connection import MATCH_OPTIONS
from jacaros.robots.kit.options import text
from jacaros.robots.mapping.checking import type_problems
from jacaros.robots.mapping.deriving import Derivation
from jacaros.robots.mapping.fields import unlike, value_names
from jacaros.robots.mapping.file import (
    ArtifactPart,
    MappingError,
    MappingFile,
    find_mapping,
    load_mapping,
    shipped_mappings,
)
from jacaros.robots.mapping.frames import FrameUpdater
from jacaros.robots.mapping.host import MappingHost
from jacaros.robots.mapping.manual import Documentation, parameter_words
from jacaros.robots.mapping.mapped_topic import MappedTopic, Updater, find_types
from jacaros.robots.mapping.operating import runners_of
from jacaros.robots.mapping.operations import OperationKind, OperationPart
from jacaros.robots.mapping.parameters import OwnParameter, kept_by_master
from jacaros.robots.ros.guarded import VELOCITIES
from jacaros.runtime.files.yaml import Problem


class MappedArtifact(MappingHost):
    """An artifact made from a mapping file; `mapped_type` makes a class for each.

    Options:
        tf_prefix(P): prefix of frame names, in place of the namespace (including the node's).
        match_timeout(S): how long operations that publish wait for a subscriber (3 s).
        unmatched(W): effect of a missing subscriber: ``warn`` or ``fail``.
    """

    known_options: ClassVar[Mapping[str, Callable[[object], object]]] = {"tf_prefix": text, **MATCH_OPTIONS}

    def open(self) -> None:
        """Check the mapping against the types of this middleware, and open everything."""
        super().open()
        for folder in self.part.interfaces:
            self.ros.add_interfaces(folder)
        self._require_none(type_problems(self.part, self.ros))
        if self.part.connected is not False and "watch_connection" not in self.options:
            self.options = {**self.options, "watch_connection": self.part.connected}
        self.own_parameters = self._declare_parameters()
        for each in self.part.derived:
            if each.spec is not None:
                Derivation(self, each, each.spec)
        self.operating = runners_of(self)
        groups: dict[object, list[Updater]] = {}
        for part in self.part.topics:
            assert part.topic is not None
            key = (part.topic.text, part.type_name and part.type_name.text, part.qos)
            groups.setdefault(key, []).append(Updater(self, part))
        untyped = []
        for updaters in groups.values():
            topic, typed = MappedTopic(self, updaters), updaters[0].part.type_name
            if typed is not None:
                topic.listen(typed.text)
            else:
                untyped.append(topic)
        for frame in self.part.frames:
            self.kept(FrameUpdater(self, frame))
        if untyped:
            self.start(self.run_process, partial(find_types, self, untyped))

    def _declare_parameters(self) -> list[OwnParameter]:
        own = [self.kept(OwnParameter(self, part)) for part in self.part.parameters]
        problems = [problem for each in own if (problem := each.declare()) is not None]
        self._require_none(problems)
        return own

    def _require_none(self, problems: list[Problem]) -> None:
        if problems:
            self.dispose()
            error = MappingError(self.mapping.file, self.mapping.text, problems)
            self.fail(str(error), "wrong_mapping", self.mapping.file)


class TunedArtifact(MappedArtifact):
    """A mapped artifact with parameters of our own node, which it may have to request before it is made."""

    async def init(self, *arguments: object) -> None:  # type: ignore[override]
        """Read the robot's name and options, both optional; on ROS 1 request the parameters from the master."""
        super().init(*arguments)
        if kept_by_master(self.ros):
            for each in self.own_parameters:
                await each.ask()


def mapped_type(mapping: MappingFile, name: str) -> type[MappedArtifact]:
    """Make the class of one artifact of a file; its operations are ordinary operations."""
    part = mapping.artifacts[name]
    members: dict[str, Any] = {
        "__doc__": Documentation(mapping, part),
        "__module__": __name__,
        "mapping": mapping,
        "part": part,
        "further_uses": motion_uses(part),
        **methods(part),
    }
    plain = "".join(c if c.isalnum() or c == "_" else "_" for c in name)
    return type(plain, (TunedArtifact if part.parameters else MappedArtifact,), members)


_made: dict[tuple[Path, int, str], type[MappedArtifact]] = {}
"""Classes by file, modification time and artifact: an unchanged file gives the same class."""


def find_mapped_type(name: str, folders: Sequence[Path]) -> type[MappedArtifact]:
    """Return the type that ``FILE`` or ``FILE#ARTIFACT`` refers to.

    Args:
        name: name of the file, with the name of the artifact if the file has several.
        folders: searched before the mappings that come with the package.

    Raises:
        UnknownArtifactType: the file or artifact does not exist, or the file has mistakes.
    """
    file, _, artifact = name.partition("#")
    path = find_mapping(file, folders)
    if path is None:
        beside = [each.name for folder in folders if folder.is_dir() for each in folder.glob("*.y*ml")]
        text = f"mapping file not found: {file}"
        raise UnknownArtifactType(file, [*beside, *shipped_mappings()], text)
    path = path.resolve()
    key = (path, path.stat().st_mtime_ns, artifact)
    if key not in _made:
        _made[key] = _make(path, file, artifact)
    return _made[key]


def _make(path: Path, file: str, artifact: str) -> type[MappedArtifact]:
    try:
        mapping = load_mapping(path)
    except MappingError as error:
        raise UnknownArtifactType(file, (), str(error)) from None
    names = list(mapping.artifacts)
    if not artifact and len(names) == 1:
        artifact = names[0]
    if artifact not in mapping.artifacts:
        write = " or ".join(f"{file}#{each}" for each in names)
        what = f"has no artifact {artifact}" if artifact else f"has {len(names)} artifacts"
        raise UnknownArtifactType(f"{file}#{artifact}", (), f"`{file}` {what}; write {write}")
    return mapped_type(mapping, artifact)


# Operations of a mapping as methods, with names, arities and outputs as if written in Python.


def methods(artifact: ArtifactPart) -> dict[str, Callable[..., Any]]:
    """Return the operations of an artifact, by names that cannot clash with methods of a class."""
    return {f"mapped {number}": _method(artifact, number) for number in range(len(artifact.operations))}


def _method(artifact: ArtifactPart, number: int) -> Callable[..., Any]:
    part = artifact.operations[number]
    inputs = len(part.parameters)

    async def run(self: Any, *arguments: object) -> None:
        outs = [out for out in arguments[inputs:] if isinstance(out, Out)]
        await self.operating[number].run(arguments[:inputs], outs)

    names = [*part.parameters, *unlike(part.parameters, value_names(part.outputs))]
    kind = inspect.Parameter.POSITIONAL_OR_KEYWORD
    run.__signature__ = inspect.Signature(  # type: ignore[attr-defined]  # read by inspect.signature
        [inspect.Parameter(name, kind) for name in ("self", *names)]
    )
    run.__annotations__ = dict.fromkeys(names[inputs:], Out)
    run.__qualname__ = run.__name__ = part.name
    run.__doc__ = description(part)
    run.parameter_words = lambda: parameter_words(artifact, part)  # type: ignore[attr-defined]  # for manuals
    expect, meanwhile = (tuple(each for _, each in found) for found in (part.expect, part.meanwhile))
    return operation(
        name=part.name, pausable=is_pausable(part), uses=part.uses, expect=expect, meanwhile=meanwhile
    )(run)


def is_pausable(part: OperationPart) -> bool:
    """Return whether it reacts when its intention is suspended."""
    return part.kind is OperationKind.PUBLISH or (
        part.kind is OperationKind.ACTION and part.suspend != "go_on"
    )


def motion_uses(artifact: ArtifactPart) -> tuple[str, ...]:
    """Return the resources of operations that are motions without declaring resources: repeated velocities."""
    moves = any(
        part.kind is OperationKind.PUBLISH
        and part.rate is not None
        and not part.uses
        and (part.type_name is None or part.type_name.text in VELOCITIES)
        for part in artifact.operations
    )
    return (WHEELS,) if moves else ()


def description(part: OperationPart) -> str:
    """Describe an operation."""
    of_type = f" ({part.type_name.text})" if part.type_name is not None else ""
    named = ", ".join(each.text for each in part.properties)
    usual = {
        OperationKind.PUBLISH: f"Publishes on {part.target.text}{of_type}.",
        OperationKind.SERVICE: f"Calls the service {part.target.text}{of_type}.",
        OperationKind.ACTION: f"Runs a goal of the action {part.target.text}{of_type}.",
        OperationKind.SET: f"Sets the parameter {part.target.text} of {part.node or 'our own node'}.",
        OperationKind.REFRESH: f"Updates {named} to the newest values.",
    }
    told = part.description or usual[part.kind]
    expected = [
        f"{each}, else {each.reason}" if each.reason else str(each)
        for _, each in (*part.expect, *part.meanwhile)
    ]
    return f"{told} Expects {'; '.join(expected)}." if expected else told
