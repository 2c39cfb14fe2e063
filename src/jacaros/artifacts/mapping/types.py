"""Artifact types by the names of mapping files: ``turtlebot.yaml``, ``fleet.yaml#arm``."""

from collections.abc import Sequence
from pathlib import Path

from jacaros.artifacts.mapping.artifact import MappedArtifact, mapped_type
from jacaros.artifacts.mapping.errors import MappingError
from jacaros.artifacts.mapping.file import find_mapping, load_mapping, shipped_mappings
from jacaros.env.errors import UnknownArtifactType

_made: dict[tuple[Path, int, str], type[MappedArtifact]] = {}
"""Classes by file, its time and artifact: a file that has not changed gives the same class."""


def find_mapped_type(name: str, folders: Sequence[Path]) -> type[MappedArtifact]:
    """The type that ``FILE`` or ``FILE#ARTIFACT`` names.

    Args:
        name: of the file, with the name of the artifact where the file has several.
        folders: where it is looked for before the mappings that come with the package.

    Raises:
        UnknownArtifactType: there is no such file or artifact, or the file is wrong; the text tells.
    """
    file, _, artifact = name.partition("#")
    path = find_mapping(file, folders)
    if path is None:
        beside = [each.name for folder in folders if folder.is_dir() for each in folder.glob("*.y*ml")]
        text = f"there is no mapping file {file}"
        raise UnknownArtifactType(file, [*beside, *shipped_mappings()], text)
    path = path.resolve()
    key = (path, path.stat().st_mtime_ns, artifact)
    if key not in _made:
        _made[key] = _make(path, file, artifact)
    return _made[key]


def _make(path: Path, file: str, artifact: str) -> type[MappedArtifact]:
    try:
        mapping = load_mapping(path)
    except MappingError as error:
        raise UnknownArtifactType(file, (), str(error)) from None
    names = list(mapping.artifacts)
    if not artifact and len(names) == 1:
        artifact = names[0]
    if artifact not in mapping.artifacts:
        write = " or ".join(f"{file}#{each}" for each in names)
        what = f"has no artifact {artifact}" if artifact else f"has {len(names)} artifacts"
        raise UnknownArtifactType(f"{file}#{artifact}", (), f"{file} {what}; write {write}")
    return mapped_type(mapping, artifact)
