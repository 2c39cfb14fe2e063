"""Declarations of project files that have no effect here. Each one is reported."""

from collections.abc import Sequence
from typing import Final, NamedTuple

from jacaros.agents.language.diagnostics import Diagnostic, Span

CODE: Final = "no-effect"
_NAMED: Final = 3
"""Up to this number of declarations are named in a warning; beyond it, only their number is given."""


class Topic(NamedTuple):
    """A kind of declaration without effect. ``plural`` names several of them; ``why`` ends the message."""

    plural: str
    why: str
    help: str | None = None


ROLES: Final = Topic(
    "roles",
    "roles in organisations are not supported",
    "declare the duties as goals, and coordinate agents by messages or through an artifact",
)
ORGANISATIONS: Final = Topic(
    "organisations",
    "organisations are not supported",
    "coordinate agents by messages or through an artifact",
)
INSTITUTIONS: Final = Topic("institutions", "institutions are not supported")
NODES: Final = Topic("nodes and hosts", "all agents run in one process")
PACKAGES: Final = Topic(
    "packages", "Java packages are not supported", "install Python packages beside jacaros with pip"
)
PATHS: Final = Topic(
    "paths",
    "Java classes and organisations are not supported",
    "put Python artifacts beside the project file, or in src/env",
)
PLATFORMS: Final = Topic("platforms", "all agents run in one process")
INSPECTORS: Final = Topic(
    "inspectors", "JaCaROS opens no windows", "watch the run with --view, or record it with --record"
)
JAVA: Final = Topic("sections", "JaCaROS runs no Java code")
INFRASTRUCTURES: Final = Topic("infrastructures", "all agents run in one process")
JAVA_ENVIRONMENT: Final = Topic(
    "environments",
    "Java environments are not supported",
    "write artifacts in Python, and declare `environment: jacaros.Environment`",
)
ARCHITECTURES: Final = Topic(
    "agent architectures",
    "JaCaROS runs no architectures of projects",
    "write percepts and actions as an artifact, as docs/how-to/come_from_jason.md shows",
)
BELIEF_BASES: Final = Topic(
    "belief bases",
    "JaCaROS runs no belief bases of projects",
    "keep data in an artifact or a file, as docs/how-to/come_from_jason.md shows",
)
_REPLACED: Final = ("jaca.", "c4jason.", "jason.architecture.AgArch", "jason.bb.DefaultBeliefBase")
"""Beginnings of class names, of other systems, whose work JaCaROS does itself."""


class Unsupported(NamedTuple):
    """One declaration without effect. A *detail* belongs to another one that is reported."""

    topic: Topic
    what: str
    span: Span
    detail: bool = False


def class_without_effect(key: str, written: str) -> tuple[Topic, str] | None:
    """Return what to report about the class of an agent; None if JaCaROS does its work itself.

    Args:
        key: such as ``agentArchClass`` or ``ag-bb-class``.
        written: the class, optionally with arguments.
    """
    if not written or written.startswith(_REPLACED):
        return None
    topic, what = (ARCHITECTURES, "architecture") if "rch" in key else (BELIEF_BASES, "belief base")
    return topic, f"the {what} `{written.partition('(')[0].strip()}`"


def each(found: Sequence[Unsupported]) -> list[Diagnostic]:
    """Return a message for each declaration, as `jacaros check` prints them. Details are notes."""
    return [
        Diagnostic("note", _message(one), one.span, None, CODE)
        if one.detail
        else Diagnostic("warning", _message(one), one.span, one.topic.help, CODE)
        for one in found
    ]


def condensed(found: Sequence[Unsupported]) -> list[Diagnostic]:
    """Return one warning for each topic and file, without details, as a run prints them."""
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
