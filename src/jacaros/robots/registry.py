"""From the type name in ``makeArtifact`` to the Python class."""

import importlib
import importlib.util
import os
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from pathlib import Path
from types import ModuleType

from jacaros.artifacts import Artifact, InvalidArtifact, UnknownArtifactType
from jacaros.runtime.files.python_modules import ModuleUnreadable, NotImported, ProjectModules
from jacaros.runtime.files.texts import shown_from

_MODULES = {
    "jacaros.artifacts.env.environment": "Blackboard Console",
    "jacaros.artifacts.tools": "Barrier Clock Latch",
    "jacaros.robots.map.robot_map": "ArtMap",
    "jacaros.robots.map.slam_data": "ArtSlamData",
    "jacaros.robots.artifacts.battery": "ArtSimBattery",
    "jacaros.robots.artifacts.connection_artifact": "ArtRos",
    "jacaros.robots.artifacts.odometry": "ArtOdometry ArtOdometryOnDemand",
    "jacaros.robots.artifacts.operator_artifact": "Operator",
    "jacaros.robots.artifacts.sensors": "ArtBaseScan ArtBumper ArtCliff ArtScan",
    "jacaros.robots.artifacts.velocity": "ArtCmdVel ArtCmdVelAndOdometry ArtCmdVelMux ArtCmdVelMuxAndOdometry ArtVelocity",
    "jacaros.robots.artifacts.thesis": "ArtCleaning ArtPerception ArtTutorial",
}
"""The built-in artifacts by their modules, which are imported on first use."""


class _BuiltIn(Mapping[str, type[Artifact]]):
    def __init__(self) -> None:
        self._modules = {name: module for module, names in sorted(_MODULES.items()) for name in names.split()}

    def __getitem__(self, name: str) -> type[Artifact]:
        found: type[Artifact] = getattr(importlib.import_module(self._modules[name]), name)
        return found

    def __contains__(self, name: object) -> bool:
        return name in self._modules

    def __iter__(self) -> Iterator[str]:
        return iter(sorted(self._modules))

    def __len__(self) -> int:
        return len(self._modules)


BUILT_IN: Mapping[str, type[Artifact]] = _BuiltIn()
"""The built-in artifacts by their bare names."""
ARTIFACTS = "artifacts"
"""Name of the module with a project's own artifacts."""

ALIASES = ("jason.architecture.", "jacaros.")
"""Package names by which programs of the thesis refer to the built-in artifacts."""

MAPPING_ENDINGS = (".yaml", ".yml")
"""Suffixes of mapping files."""

TOOLS = {
    "cartago.tools.Barrier": "Barrier",
    "cartago.tools.Clock": "Clock",
    "cartago.tools.Console": "Console",
    "cartago.tools.Latch": "Latch",
    "cartago.tools.TupleSpace": "Blackboard",
}
"""Names of the tool artifacts of CArtAgO, by their names there."""


def type_finder(project: ProjectModules | Path | str | None) -> Callable[[str], type[Artifact]]:
    """Return the look-up for a project (its modules, or its folder), with its own artifacts loaded once.

    The artifacts of a project are in ``artifacts.py``, in a package ``artifacts/``, or in another module next to it
    that the name refers to (``gripper.Gripper``); None: no project.

    Raises:
        ModuleUnreadable: the project's artifact file has a mistake.
    """
    if isinstance(project, Path | str):
        project = ProjectModules(project)
    if project is None:
        return find_type
    own = project
    modules = own.load(ARTIFACTS)

    def find(name: str) -> type[Artifact]:
        mapped = _mapped(name, own.folders)
        found = mapped or _of_project(name, own)
        if found is not None:
            return found
        near = (*_beside(name, own), *modules)
        by_path = own.unseen is None or name.startswith("jacaros.")
        try:
            return find_type(name, near, by_path=by_path)
        except UnknownArtifactType:
            for module in near:
                own.require_seen(module, name.rpartition(".")[2])
            if (source := _java_source(name, own.folders)) is not None:
                raise _in_java(name, source, own.folders[0]) from None
            if not by_path and _is_installed(name):
                raise NotImported(f"{name} is not imported") from None
            raise

    return find


def find_type(
    name: str,
    search_modules: Sequence[ModuleType] = (),
    built_in: Mapping[str, type[Artifact]] = BUILT_IN,
    by_path: bool = True,
) -> type[Artifact]:
    """Find the artifact type called *name*.

    The name of a mapping file (``turtlebot.yaml``, ``fleet.yaml#arm``) refers to the type that it declares. Any other
    name is, in this order: a dotted Python path (``my_robot.gripper.Gripper``); a class of the project's own modules,
    ignoring a package in front of the name (``tools.Counter``, as Java programs write); a built-in artifact by its
    bare name; a built-in artifact by its name in the thesis (``jason.architecture.ArtOdometry``). Names that begin
    with ``cartago.tools.`` always refer to a tool of CArtAgO. Without *by_path* no dotted path is imported.

    Raises:
        UnknownArtifactType: no type has this name.
    """
    found = (
        _mapped(name, (Path(),))
        or BUILT_IN.get(TOOLS.get(name, ""))
        or (_by_path(name) if by_path else None)
        or _of_modules(name.rpartition(".")[2], search_modules)
        or built_in.get(name)
        or _by_alias(name, built_in)
    )
    if found is None:
        text = _other_class(name.rpartition(".")[2], search_modules)
        raise UnknownArtifactType(name, () if text else _candidates(name, search_modules, built_in), text)
    return found


def _mapped(name: str, folders: Sequence[Path]) -> type[Artifact] | None:
    """Return the type of a mapping file; None for any other name."""
    if not name.partition("#")[0].endswith(MAPPING_ENDINGS):
        return None
    # Imported here, so that projects without mapping files do not load their reader.
    from jacaros.robots.mapping.artifact import find_mapped_type

    return find_mapped_type(name, folders)


def _other_class(name: str, modules: Iterable[ModuleType]) -> str:
    """Return the message for a class of that name that is not an artifact type; empty if there is no such class."""
    for module in modules:
        if isinstance(vars(module).get(name), type):
            file = Path(module.__file__ or module.__name__).name
            return f"`{name}` in {file} is not an artifact type; derive it from jacaros.artifacts.Artifact"
    return ""


def _of_project(name: str, project: ProjectModules) -> type[Artifact] | None:
    """Find a class by its module in the project: ``gripper.Gripper`` is in ``gripper.py``."""
    path, _, last = name.rpartition(".")
    if not path or project.place(path) is None:
        return None
    try:
        modules = project.load(path)
    except ModuleUnreadable as error:
        raise InvalidArtifact(str(error)) from error
    return _of_modules(last, modules)


def _beside(name: str, project: ProjectModules) -> Sequence[ModuleType]:
    """Return the project's modules that a name refers to; a misspelt name may mean a class in them."""
    path = name.rpartition(".")[0]
    return project.load(path) if path and project.place(path) is not None else ()


_JAVA_FOLDERS = ("", "src", "src/env", "src/java", "src/main/java", "src/agt", "../env", "../java")
"""Folders of a JaCaMo project in which Java classes are."""


def _java_source(name: str, folders: Iterable[Path]) -> Path | None:
    """Return the Java file of a class; None without one."""
    file = f"{name.replace('.', '/')}.java"
    paths = (folder / inner / file for folder in folders for inner in _JAVA_FOLDERS)
    return next(filter(os.path.isfile, paths), None)


def _in_java(name: str, source: Path, folder: Path) -> UnknownArtifactType:
    """Return the error for a type in Java, with the command that ports it into the folder of the project."""
    path, _, last = name.rpartition(".")
    own = f"{ARTIFACTS}/{last.lower()}.py"
    if (folder / f"{ARTIFACTS}.py").exists():  # a folder of that name would be ignored
        own = f"{path.replace('.', '/') or last.lower()}.py"
    java, python = (shown_from(Path.cwd(), each) for each in (source, folder / own))
    what = f"artifact type `{name}` is in Java ({java}), which JaCaROS does not run"
    return UnknownArtifactType(name, (), what, f"jacaros port {java} -o {python}")


def _is_installed(name: str) -> bool:
    """Return whether a dotted name begins with an installed package, which is not imported."""
    top, dot, _ = name.partition(".")
    if not dot or not top.isidentifier():
        return False
    found = importlib.util.find_spec(top)
    return found is not None and found.origin is not None  # otherwise any folder of that name


def _by_path(name: str) -> type[Artifact] | None:
    path, _, last = name.rpartition(".")
    if not path or not all(part.isidentifier() for part in path.split(".")):
        return None
    try:
        module = importlib.import_module(path)
    except ModuleNotFoundError as error:
        if error.name is not None and f"{path}.".startswith(f"{error.name}."):
            return None
        raise
    return _artifact_type(getattr(module, last, None))


def _of_modules(name: str, modules: Iterable[ModuleType]) -> type[Artifact] | None:
    for module in modules:
        if (found := _artifact_type(vars(module).get(name))) is not None:
            return found
    return None


def _by_alias(name: str, built_in: Mapping[str, type[Artifact]]) -> type[Artifact] | None:
    for package in ALIASES:
        if name.startswith(package) and (found := built_in.get(name.removeprefix(package))) is not None:
            return found
    return None


def _artifact_type(candidate: object) -> type[Artifact] | None:
    if isinstance(candidate, type) and issubclass(candidate, Artifact) and candidate is not Artifact:
        return candidate
    return None


def _candidates(name: str, modules: Iterable[ModuleType], built_in: Mapping[str, object]) -> list[str]:
    """Return the names of all types that may be meant; those of the project also with the package of *name*."""
    own = {key for module in modules for key, value in vars(module).items() if _artifact_type(value)}
    package = name.rpartition(".")[0]
    within = own | set(built_in) if f"{package}." in ALIASES else own
    return [
        *sorted(own | set(built_in)),
        *TOOLS,
        *(f"{package}.{each}" for each in sorted(within) if package),
    ]
