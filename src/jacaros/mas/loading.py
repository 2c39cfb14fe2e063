"""From a file to a deployment."""

from collections.abc import Sequence
from pathlib import Path

from jacaros.agents.language.diagnostics import Diagnostic
from jacaros.files.texts import is_file
from jacaros.mas.deployment import AgentSpec, Deployment, ProjectError
from jacaros.mas.source_path import PROJECTS, source_folders


def load_deployment(path: str | Path) -> Deployment:
    """Return what the project file *path* declares. A lone `.asl` or `.py` file is a system of one agent with its name.

    Raises:
        ProjectError: all errors of the file, including missing programs of agents.
    """
    path = Path(path)
    if path.suffix in (".asl", ".py"):
        return _lone_agent(path)
    if path.suffix not in PROJECTS:
        raise ProjectError(
            [Diagnostic("error", f"unsupported file type: {path} (expected .mas2j, .jcm, .asl or .py)")]
        )
    from jacaros.mas.project.reading import read_project  # here: a lone program starts sooner without it

    deployment = read_project(path).deployment
    if any(diagnostic.severity == "error" for diagnostic in deployment.ignored):
        raise ProjectError(deployment.ignored)
    return deployment


def mapped(deployment: Deployment, names: Sequence[str | Path]) -> Deployment:
    """Return the deployment with the artifacts of mapping files. A lone program focuses all of them.

    Raises:
        ProjectError: all errors in the files.
    """
    if not names:
        return deployment
    from jacaros.mas.mappings import with_mappings  # here: most runs have none

    return with_mappings(deployment, tuple(map(str, names)))


def _lone_agent(path: Path) -> Deployment:
    if not is_file(path):
        raise ProjectError([Diagnostic("error", f"file not found: {path}")])
    agent = AgentSpec(path.stem, path, path.stem)
    base = path.parent
    return Deployment(path.stem, base, (agent,), artifact_environment=True, source_paths=source_folders(base))
