"""What can be wrong with a world file."""

from jacaros.yaml_nodes import Problem, YamlFileError

__all__ = ["Problem", "WorldError"]


class WorldError(YamlFileError):
    """A wrong world file."""
