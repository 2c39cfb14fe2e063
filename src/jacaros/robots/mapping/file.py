"""Mapping files: found, read, and checked as far as possible without message types."""

import os
import re
from collections import Counter
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Annotated

from jacaros.robots.mapping.fields import (
    START,
    UNNAMED,
    FilePosition,
    Written,
    each_of,
    entry,
    place_of,
    read_namespace,
    value_names,
)
from jacaros.robots.mapping.offers import OfferPart, read_offers
from jacaros.robots.mapping.operations import OperationKind, OperationPart, read_operation
from jacaros.robots.mapping.properties import (
    DerivedPart,
    FramePart,
    ParameterPart,
    TopicPart,
    read_derived,
    read_frame,
    read_parameter,
    read_property,
    read_signal,
)
from jacaros.robots.streams import OPERATORS, Spec
from jacaros.runtime.files.entries import FieldSpec, declared_entries, values
from jacaros.runtime.files.texts import close_matches, did_you_mean, is_file, suggestion
from jacaros.runtime.files.yaml import Problem, YamlFileError, YamlNode, read_document, read_text, top_keys

SHIPPED = Path(__file__).parent.parent / "mappings"
"""Folder of the mappings that come with the package."""

_NAME = re.compile(r"[^\s#/]+")


def _operations(node: YamlNode) -> tuple[OperationPart, ...]:
    """Read operations; a list has several of one name."""
    found: list[OperationPart] = []
    for name, value in node.entries():
        if isinstance(value.value, list) and any(isinstance(item, dict) for item in value.value):
            for item in value.sequence():
                named = YamlNode(name.value, item.line, item.column, item.problems, name.what)
                found.append(read_operation(named, item))
        else:
            found.append(read_operation(name, value))
    return tuple(found)


def _tf_prefix(node: YamlNode) -> str:
    if node.value is not None:
        node.text()
    return str(node.value).strip("/") if node.value else ""


def _connected(node: YamlNode) -> bool | float:
    if isinstance(node.value, bool):
        return node.value
    value = node.value
    if isinstance(value, int | float) and 0.0 < value < float("inf"):
        return float(value)
    help = "write true" if str(value).lower() in ("yes", "on") else "write true, or a number such as 2"
    node.wrong("`connected` must be true, false, or a number of seconds above zero", help)
    return True


def _named(read: Callable[[YamlNode, YamlNode], object], words: str) -> FieldSpec:
    """Return the entry of a mapping from names to parts, each read by *read*."""
    return entry(lambda node: tuple(read(*pair) for pair in node.entries()), words=words)


@dataclass(frozen=True, slots=True)
class ArtifactPart:
    """One artifact.

    Attributes:
        tf_prefix: None: the namespace.
        connected: whether to show that topics are connected; a number: seconds without a message after which they are
            not.
        interfaces: folders with definitions of types.
        properties, signals: from topics.
        derived: properties derived from events of others.
    """

    name: str
    place: FilePosition
    description: Annotated[str, entry(YamlNode.text, words="text for `jacaros describe` and editors")] = ""
    namespace: Annotated[str, entry(read_namespace, words="prefix of relative names")] = ""
    tf_prefix: Annotated[str | None, entry(_tf_prefix, words="prefix of frames (default: namespace)")] = None
    connected: Annotated[bool | float, entry(_connected, words="true or seconds: `connected(Topic)`")] = False
    interfaces: Annotated[tuple[Path, ...], FieldSpec("folders with definitions of message types")] = ()
    properties: Annotated[tuple[TopicPart, ...], _named(read_property, "properties from topics")] = ()
    signals: Annotated[tuple[TopicPart, ...], _named(read_signal, "signals from topics")] = ()
    frames: Annotated[tuple[FramePart, ...], _named(read_frame, "properties from poses of frames")] = ()
    parameters: Annotated[tuple[ParameterPart, ...], _named(read_parameter, "properties of parameters")] = ()
    derived: Annotated[tuple[DerivedPart, ...], _named(read_derived, "properties made from others")] = ()
    operations: Annotated[tuple[OperationPart, ...], entry(_operations, words="what agents can do")] = ()

    @property
    def topics(self) -> tuple[TopicPart, ...]:
        """Properties and signals from topics."""
        return (*self.properties, *self.signals)


_KEYS = tuple(declared_entries(ArtifactPart))
"""The keys of an artifact."""


@dataclass(frozen=True, slots=True)
class MappingFile:
    """A complete file.

    Attributes:
        file: its name, as shown in messages.
        text: its text, for excerpts.
        artifacts: by name, in the order of the file.
        offers: what agents offer, by name; see `jacaros.robots.mapping.offers`.
        roles: roles of all callers in the graph; empty for the usual one.
    """

    file: str
    text: str = field(repr=False)
    artifacts: dict[str, ArtifactPart] = field(default_factory=dict)
    offers: dict[str, OfferPart] = field(default_factory=dict)
    roles: tuple[str, ...] = ()

    @property
    def interfaces(self) -> tuple[Path, ...]:
        """The folders with definitions of all its artifacts."""
        return tuple(dict.fromkeys(each for part in self.artifacts.values() for each in part.interfaces))

    def where(self, place: FilePosition) -> str:
        """Format a position for the log."""
        return f"{self.file}:{place.line}"


class MappingError(YamlFileError):
    """Raised for a mapping file with mistakes; holds all of them."""


def shipped_mappings() -> list[str]:
    """Return the file names of the mappings that come with the package."""
    return sorted(path.name for path in SHIPPED.glob("*.yaml"))


def find_mapping(name: str, folders: Sequence[Path] = (Path(),)) -> Path | None:
    """Return the file of a mapping, first below *folders*, then among those of the package; None if it does not
    exist."""
    for folder in folders:
        if is_file(path := folder / name):
            return path
    shipped = SHIPPED / name
    return shipped if "/" not in name and is_file(shipped) else None


def is_mapping(path: Path) -> bool:
    """Return whether a YAML file is a mapping file, even a faulty one: it declares artifacts or parts of one."""
    return bool(top_keys(path) & {"artifacts", "properties", "signals", "operations", "offers"})


def load_mapping(path: Path) -> MappingFile:
    """Read a mapping file.

    Raises:
        MappingError: with all its mistakes.
    """
    mapping, problems = read_with_problems(path)
    if problems:
        raise MappingError(mapping.file, mapping.text, problems)
    return mapping


def read_with_problems(path: Path) -> tuple[MappingFile, list[Problem]]:
    """Return the readable content of a file, and its mistakes."""
    name = _shown(path)
    try:
        text, wrong = read_text(path)
    except FileNotFoundError:
        help = f"give the path of a mapping file, or one that comes with jacaros: {', '.join(shipped_mappings())}"
        return MappingFile(name, ""), [Problem(1, 1, "mapping file not found", help)]
    except OSError as error:
        return MappingFile(name, ""), [Problem(1, 1, f"cannot read the file: {error}")]
    if wrong is not None:
        return MappingFile(name, text), [wrong]
    problems: list[Problem] = []
    parts = _read(read_document(text, problems, "a mapping file"), path, problems)
    return MappingFile(name, text, *parts), sorted(problems, key=lambda each: (each.line, each.column))


def _shown(path: Path) -> str:
    """Return a path relative to the current folder if it is below it."""
    whole, here = path.resolve(), Path.cwd()
    return str(whole.relative_to(here)) if whole.is_relative_to(here) else str(path)


def read_mapping(text: str, name: str = "mapping.yaml") -> MappingFile:
    """Read the text of a mapping file called *name*.

    Raises:
        MappingError: with all its mistakes.
    """
    problems: list[Problem] = []
    parts = _read(read_document(text, problems, "a mapping file"), Path(name), problems)
    if problems:
        raise MappingError(name, text, problems)
    return MappingFile(name, text, *parts)


_OF_FILE = ("offers", "roles")
"""Keys of a whole file, beside those of an artifact."""
_Parts = tuple[dict[str, ArtifactPart], dict[str, OfferPart], tuple[str, ...]]


def _read(document: YamlNode, path: Path, problems: list[Problem]) -> _Parts:
    if document.value is None and not problems:
        document.wrong("the file is empty", "begin with properties: or operations:")
    if document.value is None:
        return {}, {}, ()
    of_file = {
        key.value: value
        for key, value in (document.entries() if isinstance(document.value, dict) else ())
        if key.value in _OF_FILE
    }
    offers = read_offers(of_file["offers"]) if "offers" in of_file else {}
    roles = tuple(each.text() for each in each_of(of_file["roles"])) if "roles" in of_file else ()
    if of_file and not set(document.value) - {*_OF_FILE}:
        return {}, offers, roles
    return _artifacts(document, path, problems), offers, roles


def _artifacts(document: YamlNode, path: Path, problems: list[Problem]) -> dict[str, ArtifactPart]:
    if not isinstance(document.value, dict) or "artifacts" not in document.value:
        return {path.stem: _artifact(path.stem, START, document, path.parent)}
    entries = document.mapping("artifacts", *_KEYS, *_OF_FILE, anchors=True)
    for name, _ in document.entries():
        if name.value in _KEYS and name.value != "interfaces":
            text = f"`{name.value}` is on the same level as `artifacts`"
            name.wrong(text, "indent it, below the name of an artifact")
    shared = _interfaces(entries["interfaces"], path.parent) if "interfaces" in entries else ()
    found = {}
    for name, node in entries["artifacts"].entries():
        if not isinstance(name.value, str) or not _NAME.fullmatch(name.value):
            name.wrong(f"{name.value!r} is not a name for an artifact", "write a word")
            continue
        found[str(name.value)] = _artifact(str(name.value), place_of(name), node, path.parent, shared)
    if not found and not problems:
        entries["artifacts"].wrong("no artifacts", "write the name of one below `artifacts`")
    return found


def _interfaces(node: YamlNode, folder: Path) -> tuple[Path, ...]:
    """Return the folders with definitions of types; relative paths start at the file's folder."""
    found = []
    for item in each_of(node):
        path = (folder / item.text()).resolve()
        if os.path.isdir(path):
            found.append(path)
        elif isinstance(item.value, str):
            text = f"folder not found: `{item.value}`"
            item.wrong(text, "name a folder, relative to this file, that contains PACKAGE/msg/NAME.msg")
    return tuple(found)


def _artifact(
    name: str, place: FilePosition, node: YamlNode, folder: Path, shared: tuple[Path, ...] = ()
) -> ArtifactPart:
    part = ArtifactPart(name, place, interfaces=shared)
    found = values(
        node.mapping(*_KEYS, *(_OF_FILE if place == START else ()), anchors=True),
        part,
        interfaces=lambda folders, _: (*shared, *_interfaces(folders, folder)),
    )
    part = replace(part, **found)
    for check in (_names, _arities, _references, _expectations, _streams, _own_parameters):
        node.problems += check(part)
    return part


# What is checked of a whole artifact.


def _observable(part: ArtifactPart) -> Iterator[tuple[str, str, FilePosition]]:
    """Yield kind, name and position of everything that agents perceive."""
    for topic in part.topics:
        yield ("signal" if topic.signal else "property"), topic.name, topic.place
    for kind, parts in (
        ("frame", part.frames),
        ("parameter", part.parameters),
        ("derived entry", part.derived),
    ):
        for each in parts:
            yield kind, each.name, each.place
    for operation in part.operations:
        for feedback in operation.feedback:
            yield "feedback", feedback.name, feedback.place


def _names(part: ArtifactPart) -> Iterator[Problem]:
    """Yield names that are used twice in an artifact. A signal may share one with a property, as events do with
    beliefs."""
    seen: dict[str, tuple[str, FilePosition]] = {}
    for kind, name, place in _observable(part):
        if name == UNNAMED:
            continue  # already reported
        if name in seen and (kind != "feedback" or seen[name][0] != "feedback"):
            first, before = seen[name]
            text = f"the {kind} `{name}` has the same name as the {first} on line {before.line}"
            yield place.problem(text, "give it another name")
        seen.setdefault(name, (kind, place))


def _arities(part: ArtifactPart) -> Iterator[Problem]:
    """Yield operations that agents cannot tell apart: same name, same number of arguments."""
    seen: dict[tuple[str, int], FilePosition] = {}
    for operation in part.operations:
        key = (operation.name, len(operation.parameters) + len(value_names(operation.outputs)))
        before = seen.setdefault(key, operation.place)
        if before is not operation.place and operation.name != UNNAMED:
            yield operation.place.problem(
                f"duplicate operation `{operation.name}` with {key[1]} arguments; the first is on line {before.line}",
                "give it another name, or other parameters",
            )


def _own_parameters(part: ArtifactPart) -> Iterator[Problem]:
    """Yield operations on parameters of our own that the artifact does not declare."""
    own = [each.parameter for each in part.parameters]
    for operation in part.operations:
        if operation.kind is not OperationKind.SET or operation.node:
            continue
        if operation.target.text not in own:
            yield operation.target.place.problem(
                f"`{operation.name}` names no node, and `{operation.target.text}` is not a parameter of our own",
                f"our own parameters: {', '.join(own)}"
                if own
                else "write the node that has the parameter: node: controller_server",
            )


def _expectations(part: ArtifactPart) -> Iterator[Problem]:
    """Yield expectations that properties of the artifact itself cannot fulfil."""
    own = {each.name: each for each in part.properties}
    for operation in part.operations:
        for place, expected in (*operation.expect, *operation.meanwhile):
            topic = own.get(expected.name)
            if topic is None or expected.signal:
                continue
            if topic.policy.on_demand:
                text = f"`{topic.name}` is updated on demand, so it shows no effect"
                yield place.problem(text, "expect another property, or leave out its `mode`")
            count = sum(field.count for field in topic.fields or ())
            if topic.fields is not None and count != len(expected.values):
                text = f"`{topic.name}` has {count} value{'s' * (count != 1)}, not {len(expected.values)}"
                yield place.problem(text, "write a pattern for each value, _ for any")


def misspelt_expectations(mapping: MappingFile, beside: Sequence[Path] = ()) -> Iterator[Problem]:
    """Yield expected properties and signals that are similar to one of the file, or of those *beside* it in a project,
    and are in no file of the package.
    """
    own, here = _perceived(mapping), "project" if beside else "file"
    for operation in (each for part in mapping.artifacts.values() for each in part.operations):
        for place, expected in (*operation.expect, *operation.meanwhile):
            if expected.name in own:
                continue
            known = own.union(*(_perceived(read_with_problems(each)[0]) for each in beside))
            near = close_matches(expected.name, known) if expected.name not in known else []
            others = (load_mapping(SHIPPED / name) for name in (shipped_mappings() if near else ()))
            if near and not any(expected.name in _perceived(each) for each in others):
                kind = "signal" if expected.signal else "property"
                yield place.problem(
                    f"no artifact of this {here} has the {kind} `{expected.name}`", did_you_mean(near)
                )


def _perceived(mapping: MappingFile) -> set[str]:
    return {name for part in mapping.artifacts.values() for _, name, _ in _observable(part)}


def _references(part: ArtifactPart) -> Iterator[Problem]:
    """Yield unknown properties in operations, and properties on demand without an operation that
    requests them."""
    own: dict[str, TopicPart | None] = {each.name: each for each in part.properties}
    own |= {each.name: None for each in part.frames}
    told = ", ".join(own) or "none"
    asked: Counter[str] = Counter()
    for operation in part.operations:
        for wanted in operation.properties:
            asked[wanted.text] += 1
            if wanted.text not in own:
                text = f"unknown property `{wanted.text}`"
                yield wanted.place.problem(text, f"properties from topics and frames: {told}")
                continue
            topic = own[wanted.text]
            if topic is not None and topic.each is not None:
                text = f"`{wanted.text}` is one property for each element, and always up to date"
                yield wanted.place.problem(text, "leave it out")
    for topic in part.topics:
        if topic.policy.on_demand and topic.name not in asked:
            text = f"no operation requests `{topic.name}`, which is updated on demand"
            yield topic.place.problem(text, f"add an operation: look: {{refresh: {topic.name}}}")


_EVENTS = frozenset({"count", "absent"})
"""Operators that use only the events, not their values, so each element of an array may be one."""


def _streams(part: ArtifactPart) -> Iterator[Problem]:
    """Yield streams that the artifact does not have, or that an operator cannot use."""
    topics: dict[str, TopicPart] = {each.name: each for each in part.topics}
    known = [*topics, *(each.name for each in part.frames)]
    for derived in part.derived:
        for source in derived.sources:
            if source.text and source.text not in known:
                yield _unknown_stream(source, known)
            elif (topic := topics.get(source.text)) is not None and derived.spec is not None:
                yield from _unfit(derived.spec, topic, source.place)
        known.append(derived.name)


def _unknown_stream(source: Written, known: list[str]) -> Problem:
    listed = f"properties, signals, frames and entries above this one: {', '.join(known) or 'none'}"
    return source.place.problem(f"unknown property `{source.text}`", suggestion(source.text, known, listed))


def _unfit(spec: Spec, topic: TopicPart, place: FilePosition) -> Iterator[Problem]:
    if topic.each is not None and spec.operator not in _EVENTS:
        text = f"`{topic.name}` is one property for each element, but `{spec.operator}` needs a single one"
        yield place.problem(text, f"use one of {', '.join(sorted(_EVENTS))}, or a property without `each`")
    needed = spec.place + 1
    if OPERATORS[spec.operator].valued and topic.fields is not None:
        count = sum(field.count for field in topic.fields)
        if count < needed:
            yield place.problem(f"`{topic.name}` has {count} values, not {needed}", "write a smaller `value`")
