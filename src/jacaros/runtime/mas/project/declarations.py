"""The declarations of one project file, before names are resolved and files are found; and those without effect."""

from collections.abc import Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Final, NamedTuple

from jacaros.agents.language.diagnostics import Diagnostic, Span
from jacaros.runtime.mas.deployment import ArtifactSpec, NodeSpec

CODE: Final = "no-effect"
_NAMED: Final = 3
"""Up to this number of declarations are named in a warning; beyond it, only their number is given."""


class Ignored(NamedTuple):
    """A kind of declaration without effect. ``plural`` names several of them; ``why`` ends the message."""

    plural: str
    why: str
    help: str | None = None


ROLES: Final = Ignored(
    "roles",
    "roles in organisations are not supported",
    "declare the duties as goals, and coordinate agents by messages or through an artifact",
)
ORGANISATIONS: Final = Ignored(
    "organisations",
    "organisations are not supported",
    "coordinate agents by messages or through an artifact",
)
INSTITUTIONS: Final = Ignored("institutions", "institutions are not supported")
PACKAGES: Final = Ignored(
    "packages", "Java packages are not supported", "install Python packages beside jacaros with pip"
)
PATHS: Final = Ignored(
    "paths",
    "Java classes and organisations are not supported",
    "put Python artifacts beside the project file, or in src/env",
)
PLATFORMS: Final = Ignored(
    "platforms", "nodes distribute agents", "declare `node lab`, and write `node: lab` in an agent"
)
INSPECTORS: Final = Ignored(
    "inspectors", "JaCaROS opens no windows", "watch the run with --view, or record it with --record"
)
JAVA: Final = Ignored("sections", "JaCaROS runs no Java code")
INFRASTRUCTURES: Final = Ignored(
    "infrastructures", "nodes distribute agents", 'write `at "lab"` after an agent'
)
JAVA_ENVIRONMENT: Final = Ignored(
    "environments",
    "Java environments are not supported",
    "port it with `jacaros port FILE.java`, and declare `environment: jacaros.Environment`",
)
ARCHITECTURES: Final = Ignored(
    "agent architectures",
    "JaCaROS runs no architectures of projects",
    "write percepts and actions as an artifact, as docs/how-to/come_from_jason.md shows",
)
BELIEF_BASES: Final = Ignored(
    "belief bases",
    "JaCaROS runs no belief bases of projects",
    "keep data in an artifact or a file, as docs/how-to/come_from_jason.md shows",
)
_REPLACED: Final = ("jaca.", "c4jason.", "jason.architecture.AgArch", "jason.bb.DefaultBeliefBase")
"""Beginnings of class names, of other systems, whose work JaCaROS does itself."""


class Unsupported(NamedTuple):
    """One declaration without effect."""

    topic: Ignored
    what: str
    span: Span

    def diagnostic(self) -> Diagnostic:
        """Return the message, as `jacaros check` prints it."""
        message = f"{self.what} has no effect: {self.topic.why}"
        return Diagnostic("warning", message, self.span, self.topic.help, CODE)


def class_without_effect(key: str, written: str) -> tuple[Ignored, str] | None:
    """Return what to report about the class of an agent; None if JaCaROS does its work itself.

    Args:
        key: such as ``agentArchClass`` or ``ag-bb-class``.
        written: the class, optionally with arguments.
    """
    if not written or written.startswith(_REPLACED):
        return None
    topic, what = (ARCHITECTURES, "architecture") if "rch" in key else (BELIEF_BASES, "belief base")
    return topic, f"the {what} `{written.partition('(')[0].strip()}`"


def condensed(found: Sequence[Unsupported]) -> list[Diagnostic]:
    """Return one warning for each topic and file, as a run prints them."""
    groups: dict[tuple[str, Ignored], list[Unsupported]] = {}
    for one in sorted(found, key=lambda one: one.span[1:]):
        groups.setdefault((one.span.file.name, one.topic), []).append(one)
    return [
        group[0].diagnostic() if len(group) == 1 else _together(topic, group)
        for (_, topic), group in groups.items()
    ]


def _together(topic: Ignored, group: Sequence[Unsupported]) -> Diagnostic:
    names = list(dict.fromkeys(one.what for one in group))
    lines = list(dict.fromkeys(str(one.span.line) for one in group))
    several = f"{', '.join(names[:-1])} and {names[-1]}"
    what = several if 1 < len(names) <= _NAMED else f"{len(group)} {topic.plural}"
    where = f" (lines {', '.join(lines)})" if len(lines) > 1 else ""
    message = f"{what} have no effect: {topic.why}{where}"
    return Diagnostic("warning", message, group[0].span, topic.help, CODE)


WrittenName = tuple[str, Span]
"""A piece of text and its location."""


AgentName = tuple[str, str | None, Span]
"""``[namespace::]agent`` (or ``*``): the agent, the namespace and the location."""


@dataclass
class FocusPart:
    """``[namespace::][workspace.]artifact[@node]`` in an agent's ``focus:``."""

    artifact: str
    workspace: str | None
    namespace: str | None
    span: Span
    node: WrittenName | None = None


@dataclass
class JoinPart:
    """``workspace[@node]`` in an agent's ``join:``."""

    workspace: str
    span: Span
    node: WrittenName | None = None


@dataclass
class AgentPart:
    """One declared agent.

    Attributes:
        instances: a number, or the names of the instances.
        folders: searched for its program; set once the file that declares it has been read.
    """

    name: str
    span: Span
    source: str | None = None
    source_span: Span | None = None
    instances: int | list[str] | None = None
    options: dict[str, str] = field(default_factory=dict)
    option_places: dict[str, Span] = field(default_factory=dict)
    beliefs: list[WrittenName] = field(default_factory=list)
    goals: list[WrittenName] = field(default_factory=list)
    join: list[JoinPart] = field(default_factory=list)
    focus: list[FocusPart] = field(default_factory=list)
    agent_class: str | None = None
    node: WrittenName | None = None
    folders: tuple[Path, ...] = ()

    def instance_names(self) -> list[str]:
        """Return the names of its instances in the run."""
        if isinstance(self.instances, list):
            return self.instances
        if self.instances is None or self.instances == 1:
            return [self.name]
        return [f"{self.name}{number}" for number in range(1, self.instances + 1)]


@dataclass
class ArtifactDeclaration:
    """One declared artifact. ``focused_by`` are agents with an optional namespace."""

    spec: ArtifactSpec
    focused_by: list[AgentName] = field(default_factory=list)


@dataclass
class WorkspacePart:
    """One declared workspace. ``name`` may be a path."""

    name: str
    span: Span
    parent: str | None = None
    parent_span: Span | None = None
    artifacts: list[ArtifactDeclaration] = field(default_factory=list)
    agents: list[WrittenName] = field(default_factory=list)
    node: WrittenName | None = None


@dataclass
class ProjectPart:
    """One project file. ``organisations`` are also institutions; ``mapped`` are the artifacts of its mapping files."""

    name: str = "mas"
    uses: list[WrittenName] = field(default_factory=list)
    agents: list[AgentPart] = field(default_factory=list)
    workspaces: list[WorkspacePart] = field(default_factory=list)
    nodes: list[NodeSpec] = field(default_factory=list)
    organisations: dict[str, Ignored] = field(default_factory=dict)
    environment: str | None = None
    world: str | None = None
    world_span: Span | None = None
    mappings: list[WrittenName] = field(default_factory=list)
    mapped: list[ArtifactDeclaration] = field(default_factory=list)
    source_paths: list[str] = field(default_factory=list)
    code_paths: list[str] = field(default_factory=list)
    folders: tuple[Path, ...] = ()
    unsupported: list[Unsupported] = field(default_factory=list)
