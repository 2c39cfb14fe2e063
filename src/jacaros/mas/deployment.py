"""What a project file declares: agents, workspaces with their artifacts, and the settings of the run."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from types import MappingProxyType

from jacaros.asl.diagnostics import Diagnostic, render_all
from jacaros.asl.source import Span
from jacaros.errors import JacarosError

CARTAGO_ENVIRONMENTS = frozenset(
    {"jaca.CartagoEnvironment", "c4jason.CartagoEnvironment", "CartagoEnvironment", "jacaros.Environment"}
)
"""Class names of `.mas2j` files that mean: agents with an artifact environment."""

CARTAGO_2 = "c4jason.CartagoEnvironment"
"""The one of CArtAgO 2: percepts have its annotations, too."""


def has_own_artifacts(folder: Path) -> bool:
    """Whether a project in *folder* has artifacts of its own: a file ``artifacts.py`` or a folder ``artifacts``."""
    return (folder / "artifacts.py").is_file() or (folder / "artifacts").is_dir()


_NO_OPTIONS: Mapping[str, str] = MappingProxyType({})


class ProjectError(JacarosError):
    """A wrong project file.  ``diagnostics`` holds all errors and warnings, ``str()`` shows them."""

    def __init__(self, diagnostics: Sequence[Diagnostic]) -> None:
        self.diagnostics = tuple(diagnostics)
        super().__init__(render_all(self.diagnostics))


@dataclass(frozen=True)
class FocusSpec:
    """An artifact an agent focuses on at its start; ``workspace`` is None if the project does not tell."""

    artifact: str
    workspace: str | None = None
    namespace: str | None = None


@dataclass(frozen=True)
class AgentSpec:
    """One agent, that is, one instance: ``agents: a #3;`` gives three of them, ``a1`` to ``a3``.

    Attributes:
        name: the name of the agent in the run.
        declared_name: the name in the project file, without the number of the instance.
        source_path: its AgentSpeak program, or the Python file of its class.
        options: settings such as ``verbose`` and ``events``, and keys of the user's own, as text.
        beliefs, goals: literals separated by commas, as text (see `jacaros.asl.loader.parse_literals`).
        join: workspaces it joins at its start, in order; all workspaces of ``focus`` are among them.
        focus: artifacts it focuses on at its start, in order.
        agent_class, architecture_classes, belief_base_class: class names as written; without use here.
        host: the computer that is asked for, without use here.
        python_class: the class of an agent written in Python, in place of a file.
        span: where it is declared.
    """

    name: str
    source_path: Path
    declared_name: str = ""
    options: Mapping[str, str] = field(default_factory=lambda: _NO_OPTIONS)
    beliefs: str = ""
    goals: str = ""
    join: tuple[str, ...] = ()
    focus: tuple[FocusSpec, ...] = ()
    agent_class: str | None = None
    architecture_classes: tuple[str, ...] = ()
    belief_base_class: str | None = None
    host: str | None = None
    python_class: type | None = None
    span: Span | None = field(default=None, compare=False, repr=False)

    @property
    def is_python(self) -> bool:
        """Whether it is an agent written in Python."""
        return self.python_class is not None or str(self.source_path).endswith(".py")


@dataclass(frozen=True)
class ArtifactSpec:
    """An artifact to be made at the start.

    ``arguments`` are plain values: numbers, truth values, strings, lists, `jacaros.env.values.Atom` for names
    without quotes, `jacaros.env.values.Structure`.  ``focused_by`` are agents as written (``*``: all); they
    have it in their ``focus``.  ``span`` and ``type_span`` are where its name and its type are written.
    """

    name: str
    type_name: str
    arguments: tuple[object, ...] = ()
    focused_by: tuple[str, ...] = ()
    span: Span | None = field(default=None, compare=False, repr=False)
    type_span: Span | None = field(default=None, compare=False, repr=False)


@dataclass(frozen=True)
class WorkspaceSpec:
    """A workspace to be made at the start: a child of ``parent``, or of ``/main`` without one.

    ``artifacts`` are to be made in this order.  ``agents`` are as written (``*``: all); they have it in their
    ``join``.
    """

    name: str
    artifacts: tuple[ArtifactSpec, ...] = ()
    agents: tuple[str, ...] = ()
    parent: str | None = None
    span: Span | None = field(default=None, compare=False, repr=False)


@dataclass(frozen=True)
class Deployment:
    """A whole multi-agent system as declared.

    Attributes:
        name: of the system.
        base_path: the folder of the project file.
        agents, workspaces: in the order of the file, but a workspace comes after its parent.
        environment: the class of ``environment:`` in a `.mas2j` file as written; None if there is none.
        artifact_environment: whether the agents live among artifacts: in a `.jcm` file, a lone `.asl` file, or
            with one of the known environment classes.
        infrastructure: of a `.mas2j` file, or the platforms of a `.jcm` file, as written.
        world: the world file (a path that exists, or the name as written).
        world_span: where the project names it.
        source_paths: folders in which agent programs and included files are looked for, in order.
        ignored: warnings about what is declared and has no effect here.
    """

    name: str
    base_path: Path
    agents: tuple[AgentSpec, ...] = ()
    workspaces: tuple[WorkspaceSpec, ...] = ()
    environment: str | None = None
    artifact_environment: bool = False
    infrastructure: tuple[str, ...] = ()
    world: str | None = None
    world_span: Span | None = field(default=None, compare=False, repr=False)
    source_paths: tuple[Path, ...] = ()
    ignored: tuple[Diagnostic, ...] = ()
