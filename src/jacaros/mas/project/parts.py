"""The declarations of one project file, before names are resolved and files are found."""

from dataclasses import dataclass, field
from pathlib import Path

from jacaros.agents.language.diagnostics import Span
from jacaros.mas.deployment import ArtifactSpec
from jacaros.mas.project.unsupported import Unsupported

Written = tuple[str, Span]
"""A piece of text and its location."""


AgentName = tuple[str, str | None, Span]
"""``[namespace::]agent`` (or ``*``): the agent, the namespace and the location."""


@dataclass
class FocusPart:
    """``[namespace::][workspace.]artifact`` in an agent's ``focus:``. ``elsewhere`` is true if it is on another node."""

    artifact: str
    workspace: str | None
    namespace: str | None
    span: Span
    elsewhere: bool = False


@dataclass
class JoinPart:
    """A workspace in an agent's ``join:``. ``elsewhere`` is true if it is on another node."""

    workspace: str
    span: Span
    elsewhere: bool = False


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
    beliefs: list[Written] = field(default_factory=list)
    goals: list[Written] = field(default_factory=list)
    join: list[JoinPart] = field(default_factory=list)
    focus: list[FocusPart] = field(default_factory=list)
    agent_class: str | None = None
    host: str | None = None
    folders: tuple[Path, ...] = ()

    def instance_names(self) -> list[str]:
        """Return the names of its instances in the run."""
        if isinstance(self.instances, list):
            return self.instances
        if self.instances is None or self.instances == 1:
            return [self.name]
        return [f"{self.name}{number}" for number in range(1, self.instances + 1)]


@dataclass
class ArtifactPart:
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
    artifacts: list[ArtifactPart] = field(default_factory=list)
    agents: list[Written] = field(default_factory=list)


@dataclass
class OrganisationPart:
    """An organisation or institution, with the agents and workspaces that it mentions."""

    name: str
    span: Span
    agents: list[Written] = field(default_factory=list)
    workspaces: list[Written] = field(default_factory=list)


@dataclass
class ProjectPart:
    """One project file. ``mapped`` are the artifacts of its mapping files."""

    name: str = "mas"
    uses: list[Written] = field(default_factory=list)
    agents: list[AgentPart] = field(default_factory=list)
    workspaces: list[WorkspacePart] = field(default_factory=list)
    organisations: list[OrganisationPart] = field(default_factory=list)
    environment: str | None = None
    infrastructure: list[str] = field(default_factory=list)
    world: str | None = None
    world_span: Span | None = None
    mappings: list[Written] = field(default_factory=list)
    mapped: list[ArtifactPart] = field(default_factory=list)
    source_paths: list[str] = field(default_factory=list)
    code_paths: list[str] = field(default_factory=list)
    folders: tuple[Path, ...] = ()
    unsupported: list[Unsupported] = field(default_factory=list)
