"""What is read from one project file, before names are resolved and files are found."""

from dataclasses import dataclass, field

from jacaros.asl.source import Span
from jacaros.mas.deployment import ArtifactSpec

Written = tuple[str, Span]
"""A piece of text and its place."""


AgentName = tuple[str, str | None, Span]
"""``[namespace::]agent`` (or ``*``): the agent, the namespace and the place."""


@dataclass
class FocusPart:
    """``[namespace::][workspace.]artifact`` in an agent's ``focus:``."""

    artifact: str
    workspace: str | None
    namespace: str | None
    span: Span


@dataclass
class AgentPart:
    """One declared agent; ``instances`` is a number or the names of the instances."""

    name: str
    span: Span
    source: str | None = None
    instances: int | list[str] | None = None
    options: dict[str, str] = field(default_factory=dict)
    option_places: dict[str, Span] = field(default_factory=dict)
    beliefs: list[Written] = field(default_factory=list)
    goals: list[Written] = field(default_factory=list)
    join: list[Written] = field(default_factory=list)
    focus: list[FocusPart] = field(default_factory=list)
    agent_class: str | None = None
    architecture_classes: list[str] = field(default_factory=list)
    belief_base_class: str | None = None
    host: str | None = None


@dataclass
class ArtifactPart:
    """One declared artifact; ``focused_by`` are agents with an optional namespace."""

    spec: ArtifactSpec
    focused_by: list[AgentName] = field(default_factory=list)


@dataclass
class WorkspacePart:
    """One declared workspace."""

    name: str
    span: Span
    parent: str | None = None
    artifacts: list[ArtifactPart] = field(default_factory=list)
    agents: list[Written] = field(default_factory=list)


@dataclass
class ProjectPart:
    """One project file."""

    name: str = "mas"
    uses: list[Written] = field(default_factory=list)
    agents: list[AgentPart] = field(default_factory=list)
    workspaces: list[WorkspacePart] = field(default_factory=list)
    environment: str | None = None
    infrastructure: list[str] = field(default_factory=list)
    world: str | None = None
    source_paths: list[str] = field(default_factory=list)
