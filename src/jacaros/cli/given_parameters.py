"""Parameters of our node as they are given on the command line, and in the files of ROS 2's launch files.

See "About parameters in ROS 2" in its documentation.
"""

from collections.abc import Iterable, Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any

from jacaros.errors import UsageError
from jacaros.text_files import file_text


def read_parameters(
    written: Sequence[str], files: Sequence[Path], node: str, separator: str = "."
) -> dict[str, Any]:
    """Read all that is given; what is written alone goes before what stands in files, later files before earlier ones.

    Args:
        written: ``NAME:=VALUE``, the value being YAML.
        files: of parameters.
        node: the absolute name of our node.
        separator: between the names of a mapping and of its parts: ``.``, on ROS 1 ``/``.

    Raises:
        UsageError: with what to write instead.
    """
    found: dict[str, Any] = {}
    name = [part for part in node.split("/") if part]
    for file in files:
        found |= _flat(_of_node(_content(file), [], name), separator)
    return found | _flat(map(_written, written), separator)


def _written(each: str) -> tuple[str, Any]:
    name, sign, value = each.partition(":=")
    if not sign or not name:
        raise UsageError(f"--param is written NAME:=VALUE, such as --param speed:=0.5, not {each!r}")
    return name, _yaml(value, f"--param {name}")


def _content(file: Path) -> Any:
    try:
        text = file_text(file)
    except FileNotFoundError as error:
        raise UsageError(f"--params-file {file}: {error.strerror}") from None
    except (OSError, UnicodeError) as error:
        raise UsageError(f"--params-file {file}: {error}") from None
    content = _yaml(text, f"--params-file {file}")
    if content is not None and not isinstance(content, Mapping):
        raise UsageError(f"--params-file {file}: write NODE: {{ros__parameters: {{NAME: VALUE}}}}")
    return content


def _flat(given: Iterable[tuple[str, Any]], separator: str) -> dict[str, Any]:
    """Give parts of mappings by the names that parameters have."""
    found: dict[str, Any] = {}
    for name, value in given:
        if isinstance(value, Mapping):
            parts = ((f"{name}{separator}{part}", each) for part, each in value.items())
            found |= _flat(parts, separator)
        elif value is None:
            raise UsageError(f"the parameter {name} has no value; for an empty text write \"''\"")
        else:
            found[name] = value
    return found


def _of_node(content: Any, path: list[str], node: list[str]) -> Iterator[tuple[str, Any]]:
    """Give the parameters of *node* in a file, below names of namespaces and nodes."""
    if not isinstance(content, Mapping):
        return
    for key, value in content.items():
        if key == "ros__parameters":
            if isinstance(value, Mapping) and _suits(path, node):
                yield from ((str(name), each) for name, each in value.items())
        else:
            yield from _of_node(value, [*path, *filter(None, str(key).split("/"))], node)


def _suits(pattern: list[str], node: list[str]) -> bool:
    """Whether a node's name suits a pattern: ``*`` is one part of it, ``**`` any number of them."""
    if not pattern:
        return not node
    if pattern[0] == "**":
        return any(_suits(pattern[1:], node[begin:]) for begin in range(len(node) + 1))
    return bool(node) and pattern[0] in ("*", node[0]) and _suits(pattern[1:], node[1:])


def _yaml(text: str, where: str) -> Any:
    # Here: only for those who have parameters.
    from jacaros.yaml_nodes import plain_values, shown

    value, wrong = plain_values(text)
    if wrong is not None:
        raise UsageError(shown(where, text.splitlines(), wrong))
    return value
