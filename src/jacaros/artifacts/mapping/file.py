"""Mapping files: found, read, and checked as far as possible without message types."""

import re
from collections import Counter
from collections.abc import Iterator, Sequence
from pathlib import Path

from jacaros.artifacts.mapping.declared import (
    NOTHING,
    ArtifactPart,
    MappingError,
    MappingFile,
    OperationKind,
    Place,
    TopicPart,
)
from jacaros.artifacts.mapping.read_fields import UNNAMED, each_of, namespace, place_of
from jacaros.artifacts.mapping.read_operations import read_operation
from jacaros.artifacts.mapping.read_properties import (
    derived_problems,
    read_derived,
    read_frame,
    read_parameter,
    read_property,
    read_signal,
)
from jacaros.files.texts import is_file
from jacaros.files.yaml import Node, Problem, read_document, read_text, top_keys

SHIPPED = Path(__file__).parent.parent / "mappings"
"""Folder of the mappings that come with the package."""

ENDINGS = (".yaml", ".yml")

_NAME = re.compile(r"[^\s#/]+")
_KEYS = (
    "description",
    "namespace",
    "tf_prefix",
    "connected",
    "interfaces",
    "properties",
    "signals",
    "frames",
    "parameters",
    "derived",
    "operations",
)


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
    return bool(top_keys(path) & {"artifacts", "properties", "signals", "operations"})


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
    artifacts = _read(read_document(text, problems, "a mapping file"), path, problems)
    return MappingFile(name, text, artifacts), sorted(problems, key=lambda each: (each.line, each.column))


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
    artifacts = _read(read_document(text, problems, "a mapping file"), Path(name), problems)
    if problems:
        raise MappingError(name, text, problems)
    return MappingFile(name, text, artifacts)


def _read(document: Node, path: Path, problems: list[Problem]) -> dict[str, ArtifactPart]:
    if document.value is None:
        if not problems:
            document.wrong("the file is empty", "begin with properties: or operations:")
        return {}
    if not isinstance(document.value, dict) or "artifacts" not in document.value:
        return {path.stem: _artifact(path.stem, Place(1, 1), document, path.parent)}
    entries = document.mapping("artifacts", *_KEYS, anchors=True)
    for name, _ in document.entries():
        if name.value in _KEYS and name.value != "interfaces":
            name.wrong(
                f"`{name.value}` is on the same level as `artifacts`",
                "indent it, below the name of an artifact",
            )
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


def _interfaces(node: Node, folder: Path) -> tuple[Path, ...]:
    """Return the folders with definitions of types; relative paths start at the file's folder."""
    found = []
    for item in each_of(node):
        path = (folder / item.text()).resolve()
        if path.is_dir():
            found.append(path)
        elif isinstance(item.value, str):
            item.wrong(
                f"folder not found: `{item.value}`",
                "name a folder, relative to this file, that contains PACKAGE/msg/NAME.msg",
            )
    return tuple(found)


def _artifact(
    name: str, place: Place, node: Node, folder: Path, shared: tuple[Path, ...] = ()
) -> ArtifactPart:
    entries = node.mapping(*_KEYS, anchors=True)
    topics = [read_property(*pair) for pair in _pairs(entries, "properties")]
    topics += [read_signal(*pair) for pair in _pairs(entries, "signals")]
    prefix = entries.get("tf_prefix")
    if prefix is not None and prefix.value is not None:
        prefix.text()
    part = ArtifactPart(
        name,
        place,
        entries["description"].text() if "description" in entries else "",
        namespace(entries["namespace"]) if "namespace" in entries else "",
        (str(prefix.value).strip("/") if prefix.value else "") if prefix is not None else None,
        _connected(entries["connected"]) if "connected" in entries else False,
        tuple(topics),
        tuple(read_frame(*pair) for pair in _pairs(entries, "frames")),
        tuple(read_parameter(*pair) for pair in _pairs(entries, "parameters")),
        tuple(read_operation(*pair) for pair in _variants(entries)),
        (*shared, *(_interfaces(entries["interfaces"], folder) if "interfaces" in entries else ())),
        tuple(read_derived(*pair) for pair in _pairs(entries, "derived")),
    )
    node.problems += _names(part)
    node.problems += _arities(part)
    node.problems += _references(part)
    node.problems += derived_problems(part)
    node.problems += _switches(part)
    node.problems += _own_parameters(part)
    return part


def _pairs(entries: dict[str, Node], key: str) -> Iterator[tuple[Node, Node]]:
    return entries[key].entries() if key in entries else iter(())


def _variants(entries: dict[str, Node]) -> Iterator[tuple[Node, Node]]:
    """Yield names and values of operations; a list has several of one name."""
    for name, node in _pairs(entries, "operations"):
        if not isinstance(node.value, list) or not any(isinstance(item, dict) for item in node.value):
            yield name, node
            continue
        for item in node.sequence():
            yield Node(name.value, item.line, item.column, item.problems, name.what), item


def _connected(node: Node) -> bool | float:
    if isinstance(node.value, bool):
        return node.value
    value = node.value
    if isinstance(value, int | float) and 0.0 < value < float("inf"):
        return float(value)
    help = "write true" if str(value).lower() in ("yes", "on") else "write true, or a number such as 2"
    node.wrong("`connected` must be true, false, or a number of seconds above zero", help)
    return True


def _observable(part: ArtifactPart) -> Iterator[tuple[str, str, Place]]:
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
    seen: dict[str, tuple[str, Place]] = {}
    for kind, name, place in _observable(part):
        if name == UNNAMED:
            continue  # already reported
        if name in seen and (kind != "feedback" or seen[name][0] != "feedback"):
            first, before = seen[name]
            yield place.problem(
                f"the {kind} `{name}` has the same name as the {first} on line {before.line}",
                "give it another name",
            )
        seen.setdefault(name, (kind, place))


def _arities(part: ArtifactPart) -> Iterator[Problem]:
    """Yield operations that agents cannot tell apart: same name, same number of arguments."""
    seen: dict[tuple[str, int], Place] = {}
    for operation in part.operations:
        key = (operation.name, part.arity(operation))
        before = seen.setdefault(key, operation.place)
        if before is not operation.place and operation.name != UNNAMED:
            yield operation.place.problem(
                f"duplicate operation `{operation.name}` with {key[1]} arguments; the first is on line {before.line}",
                "give it another name, or other parameters",
            )


def _switches(part: ArtifactPart) -> Iterator[Problem]:
    """Yield operations that are named to pause and resume others, but do not exist or are not able to."""
    plain = {each.name: each for each in part.operations if part.arity(each) == 0}
    able = [name for name, each in plain.items() if each.is_switch]
    for operation in part.operations:
        for wanted in (operation.pause, operation.resume):
            if wanted is NOTHING or not wanted.text or wanted.text in able:
                continue
            known = any(each.name == wanted.text for each in part.operations)
            yield wanted.place.problem(
                f"`{wanted.text}` cannot pause or resume a goal: it takes arguments, or runs for a while"
                if known
                else f"unknown operation `{wanted.text}`",
                "name one without arguments that calls a service, publishes once or sets a parameter; "
                f"{'possible: ' + ', '.join(able) if able else 'none exists yet'}",
            )


def _own_parameters(part: ArtifactPart) -> Iterator[Problem]:
    """Yield operations on parameters of our own that the artifact does not declare."""
    own = [each.parameter for each in part.parameters if not each.node]
    for operation in part.operations:
        if operation.kind not in (OperationKind.SET, OperationKind.GET) or operation.node:
            continue
        if operation.target.text not in own:
            yield operation.target.place.problem(
                f"`{operation.name}` names no node, and `{operation.target.text}` is not a parameter of our own",
                f"our own parameters: {', '.join(own)}"
                if own
                else "write the node that has the parameter: node: controller_server",
            )


def _references(part: ArtifactPart) -> Iterator[Problem]:
    """Yield unknown properties in operations and ranges of view, and properties on demand without an operation that
    requests them."""
    own: dict[str, TopicPart | None] = {each.name: each for each in part.properties}
    own |= {each.name: None for each in part.frames}
    told = ", ".join(own) or "none"
    asked: Counter[str] = Counter()
    for operation in part.operations:
        for wanted in operation.properties:
            asked[wanted.text] += 1
            if wanted.text not in own:
                yield wanted.place.problem(
                    f"unknown property `{wanted.text}`", f"properties from topics and frames: {told}"
                )
                continue
            topic = own[wanted.text]
            if topic is not None and topic.each is not None:
                yield wanted.place.problem(
                    f"`{wanted.text}` is one property for each element, and always up to date", "leave it out"
                )
            elif operation.kind is OperationKind.READ and topic is not None and topic.fields is None:
                yield wanted.place.problem(
                    f"the number of values of `{wanted.text}` is not known", f"give `{wanted.text}` fields"
                )
    for topic in part.topics:
        if topic.view is not None and (origin := topic.view.origin) is not None and origin.text not in own:
            yield origin.place.problem(
                f"unknown property `{origin.text}`", f"properties from topics and frames: {told}"
            )
        if topic.policy.on_demand and topic.name not in asked:
            yield topic.place.problem(
                f"no operation requests `{topic.name}`, which is updated on demand",
                f"add an operation: look: {{refresh: {topic.name}}}",
            )
