"""What project files declare and what has no effect here: nothing of it is passed over in silence."""

from collections.abc import Sequence
from typing import Final, NamedTuple

from jacaros.asl.diagnostics import Diagnostic
from jacaros.asl.source import Span

CODE: Final = "no-effect"
_NAMED: Final = 3
"""So many things are told by name; of more only the number is told."""


class Topic(NamedTuple):
    """A kind of declaration without effect; ``plural`` names several of them, ``why`` ends the sentence."""

    plural: str
    why: str
    help: str | None = None


ROLES: Final = Topic(
    "roles",
    "roles in organisations are not supported",
    "give the agent its duties as goals, and let agents agree by messages or through an artifact",
)
ORGANISATIONS: Final = Topic(
    "organisations",
    "organisations are not supported",
    "let agents agree by messages or through an artifact",
)
INSTITUTIONS: Final = Topic("institutions", "institutions are not supported")
NODES: Final = Topic("nodes and hosts", "a run is one process")
PACKAGES: Final = Topic(
    "packages", "Java packages are not used", "install Python packages where jacaros is installed"
)
PATHS: Final = Topic(
    "paths",
    "no Java classes and no organisations are read",
    "put artifacts in Python beside the project file, or into src/env",
)
PLATFORMS: Final = Topic("platforms", "a run is one process, and agents reach each other in it")
INSPECTORS: Final = Topic("inspectors", "JaCaROS has no windows", "watch a run with --view or --record")
JAVA: Final = Topic("sections", "that is about Java code")
INFRASTRUCTURES: Final = Topic("infrastructures", "a run is one process, and agents reach each other in it")
JAVA_ENVIRONMENT: Final = Topic(
    "environments",
    "environments in Java are not used",
    "write it as an artifact in Python, and here: environment: jacaros.Environment",
)


class Unsupported(NamedTuple):
    """One declaration without effect; a *detail* is part of another one that is told."""

    topic: Topic
    what: str
    span: Span
    detail: bool = False


def each(found: Sequence[Unsupported]) -> list[Diagnostic]:
    """A message for each of them, as `jacaros check` tells them: details are notes."""
    return [
        Diagnostic("note", _message(one), one.span, None, CODE)
        if one.detail
        else Diagnostic("warning", _message(one), one.span, one.topic.help, CODE)
        for one in found
    ]


def condensed(found: Sequence[Unsupported]) -> list[Diagnostic]:
    """One warning for each topic and file, without the details, as a run tells them."""
    groups: dict[tuple[str, Topic], list[Unsupported]] = {}
    for one in sorted(found, key=lambda one: one.span[1:]):
        if not one.detail:
            groups.setdefault((one.span.file.name, one.topic), []).append(one)
    return [
        each(group)[0] if len(group) == 1 else _together(topic, group) for (_, topic), group in groups.items()
    ]


def _together(topic: Topic, group: Sequence[Unsupported]) -> Diagnostic:
    names = list(dict.fromkeys(one.what for one in group))
    lines = list(dict.fromkeys(str(one.span.line) for one in group))
    what = (
        f"{', '.join(names[:-1])} and {names[-1]}"
        if 1 < len(names) <= _NAMED
        else f"{len(group)} {topic.plural}"
    )
    where = f" (lines {', '.join(lines)})" if len(lines) > 1 else ""
    message = f"{what} have no effect: {topic.why}{where}"
    return Diagnostic("warning", message, group[0].span, topic.help, CODE)


def _message(one: Unsupported) -> str:
    return f"{one.what} has no effect: {one.topic.why}"
