"""What can be wrong with a mapping file."""

from jacaros.yaml_nodes import YamlFileError


class MappingError(YamlFileError):
    """A wrong mapping file, with all its mistakes."""
