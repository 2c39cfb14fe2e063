"""The declarations of a project: agents, workspaces with artifacts, and settings of the run."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from types import MappingProxyType

from jacaros.agents.language.diagnostics import Diagnostic, SourceError, Span

CARTAGO_ENVIRONMENTS = frozenset(
    {"jaca.CartagoEnvironment", "c4jason.CartagoEnvironment", "CartagoEnvironment", "jacaros.Environment"}
)
"""Class names in `.mas2j` files for an artifact environment."""


def has_own_artifacts(folder: Path) -> bool:
    """Return whether a project in *folder* has artifacts: a file ``artifacts.py`` or a folder ``artifacts``."""
    return (folder / "artifacts.py").is_file() or (folder / "artifacts").is_dir()


_NO_OPTIONS: Mapping[str, str] = MappingProxyType({})


class ProjectError(SourceError):
    """An invalid project file."""


@dataclass(frozen=True)
class FocusSpec:
    """An artifact that an agent focuses at its start. ``workspace`` is None if the project does not name it."""

    artifact: str
    workspace: str | None = None
    namespace: str | None = None


@dataclass(frozen=True)
class AgentSpec:
    """One agent, that is, one instance: ``agents: a #3;`` declares three of them, ``a1`` to ``a3``.

    Attributes:
        name: name of the agent in the run.
        declared_name: name in the project file, without the number of the instance.
        source_path: its AgentSpeak program, or the Python file of its class.
        options: settings such as ``verbose`` and ``events``, and user-defined keys, as text.
        beliefs, goals: literals separated by commas, as text (see `jacaros.agents.language.loader.parse_literals`).
        join: workspaces it joins at its start, in order. They include all workspaces of ``focus``.
        focus: artifacts it focuses at its start, in order.
        join_later: those of ``join`` that need not exist at the start, as workspaces of other nodes: it joins them, and
            focuses their artifacts, as soon as they appear.
        node: the node that it runs at; None if the project does not say.
        agent_class: name of the class as written.
        python_class: the class of a Python agent, in place of a file.
        span: location of the declaration.
    """

    name: str
    source_path: Path
    declared_name: str = ""
    options: Mapping[str, str] = field(default_factory=lambda: _NO_OPTIONS)
    beliefs: str = ""
    goals: str = ""
    join: tuple[str, ...] = ()
    focus: tuple[FocusSpec, ...] = ()
    join_later: tuple[str, ...] = ()
    node: str | None = None
    agent_class: str | None = None
    python_class: type | None = None
    span: Span | None = field(default=None, compare=False, repr=False)

    @property
    def is_situated(self) -> bool:
        """Whether it joins workspaces or focuses artifacts at its start."""
        return bool(self.join or self.focus)

    @property
    def is_python(self) -> bool:
        """Whether it is a Python agent."""
        return self.python_class is not None or str(self.source_path).endswith(".py")


@dataclass(frozen=True)
class ArtifactSpec:
    """An artifact to be created at the start.

    ``arguments`` are plain values: numbers, Booleans, strings, lists, `jacaros.artifacts.env.values.Atom` for names without
    quotes, and `jacaros.artifacts.env.values.Structure`. ``focused_by`` are agents as written (``*``: all); they also have
    it in their ``focus``. ``span`` and ``type_span`` are the locations of its name and type.
    """

    name: str
    type_name: str
    arguments: tuple[object, ...] = ()
    focused_by: tuple[str, ...] = ()
    span: Span | None = field(default=None, compare=False, repr=False)
    type_span: Span | None = field(default=None, compare=False, repr=False)


@dataclass(frozen=True)
class WorkspaceSpec:
    """A workspace to be created at the start: a child of ``parent``, or of ``/main`` without one.

    ``artifacts`` are created in this order. ``agents`` are as written (``*``: all); they also have it in their ``join``.
    ``node`` is the node that it is at, or that its parent is at; None if the project does not say.
    """

    name: str
    artifacts: tuple[ArtifactSpec, ...] = ()
    agents: tuple[str, ...] = ()
    parent: str | None = None
    node: str | None = None
    span: Span | None = field(default=None, compare=False, repr=False)


@dataclass(frozen=True)
class NodeSpec:
    """A node: one process of the system, on any computer. ``address`` is ``host`` or ``host:port`` as written."""

    name: str
    address: str | None = None
    span: Span | None = field(default=None, compare=False, repr=False)


@dataclass(frozen=True)
class Deployment:
    """A whole multi-agent system as declared.

    Attributes:
        name: name of the system.
        base_path: folder of the project file.
        agents, workspaces: in the order of the file, but a workspace comes after its parent.
        nodes: in the order of the file. What names none runs at the first one.
        environment: the class of ``environment:`` in a `.mas2j` file as written; None without one.
        artifact_environment: whether agents use artifacts: in a `.jcm` file, a lone `.asl` file, or with one of the known
            environment classes.
        world: the world file (a path that exists, or the name as written).
        world_span: location of its name.
        source_paths: folders that are searched for agent programs and included files, in order.
        ignored: warnings about declarations without effect.
    """

    name: str
    base_path: Path
    agents: tuple[AgentSpec, ...] = ()
    workspaces: tuple[WorkspaceSpec, ...] = ()
    nodes: tuple[NodeSpec, ...] = ()
    environment: str | None = None
    artifact_environment: bool = False
    world: str | None = None
    world_span: Span | None = field(default=None, compare=False, repr=False)
    source_paths: tuple[Path, ...] = ()
    ignored: tuple[Diagnostic, ...] = ()
