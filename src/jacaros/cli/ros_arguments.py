"""What ROS's own tools add to a command line, read as options of ours.

``ros2 run`` and launch files of ROS 2 say names and parameters behind ``--ros-args`` (design.ros2.org, "ROS Command Line
Arguments"); rosrun and roslaunch write ``name:=value`` between the others (wiki.ros.org, "Remapping Arguments").
"""

import os
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any

from jacaros.errors import UsageError
from jacaros.text_files import file_text

_SIGN = ":="
_ROS2_VALUES = {
    "-r": "--remap",
    "--remap": "--remap",
    "-p": "--param",
    "--param": "--param",
    "--params-file": "--params-file",
    "--log-level": "",
    "--log-config-file": "",
    "-e": "",
    "--enclave": "",
}
"""Arguments of ROS 2 with a value, by the name under which it is read; those without a name have no effect here."""
_ROS2_FLAGS = {
    "--enable-rosout-logs": "--rosout",
    "--disable-rosout-logs": "--no-rosout",
    "--enable-stdout-logs": "",
    "--disable-stdout-logs": "",
    "--enable-external-lib-logs": "",
    "--disable-external-lib-logs": "",
}
_NAMES = {"__ns": "--namespace", "__node": "--node-name", "__name": "--node-name", "__master": "--master"}
_ROS1_WITHOUT_EFFECT = ("__log",)


def has_ros_arguments(arguments: Sequence[str]) -> bool:
    """Whether ROS's tools have added something to a command that joins a graph."""
    if not arguments or (arguments[0] not in ("run", "sim", "guard") and "." not in arguments[0]):
        return False
    return any(each == "--ros-args" for each in arguments) or any(_ros1_arguments(arguments))


def as_options(arguments: Sequence[str], warn: Callable[[str], None]) -> list[str]:
    """Give *arguments* with options of ours in place of what ROS's tools have added.

    ``--ros ros2`` (or ``ros1``) is added where nothing says another kind of graph.

    Args:
        arguments: of the process, without its name.
        warn: takes a line about something that has no effect.

    Raises:
        UsageError: an argument is not ROS's, or is not written as it should be.
    """
    own, of_ros2 = _divided(arguments)
    places = set(_ros1_arguments(own))
    of_ros1 = [own[place] for place in sorted(places)]
    own = [each for place, each in enumerate(own) if place not in places]
    added = [*_ros1_options(of_ros1), *_Ros2Arguments(of_ros2).options()]
    if own[:1] == ["sim"]:
        added = _without_parameters(added, warn)
    if not _given(own, "--ros") and not os.environ.get("JACAROS_ROS"):
        added += ["--ros", "ros1" if of_ros1 and "--ros-args" not in arguments else "ros2"]
    return [*own, *added]


def _without_parameters(options: list[str], warn: Callable[[str], None]) -> list[str]:
    """Leave out parameters: a world declares none, and its time is nobody else's."""
    kept: dict[str, list[str]] = {
        "--param": [],
        "--params-file": [],
        "--namespace": [""],
        "--node-name": ["world"],
    }
    rest = []
    for option, value in _paired(options):
        if option in kept:
            kept[option].append(value)
        if option not in ("--param", "--params-file"):
            rest += [option] if option in _ROS2_FLAGS.values() else [option, value]
    node = f"{kept['--namespace'][-1]}/{kept['--node-name'][-1]}"
    given = read_parameters(kept["--param"], [Path(file) for file in kept["--params-file"]], node)
    for name in given:
        if name != "use_sim_time":
            warn(f"the parameter {name} has no effect: a world declares none, its file says how it is")
    return rest


def _paired(options: Iterable[str]) -> Iterator[tuple[str, str]]:
    """Give options with their values; flags have none."""
    rest = iter(options)
    for option in rest:
        yield option, "" if option in _ROS2_FLAGS.values() else next(rest)


def _divided(arguments: Sequence[str]) -> tuple[list[str], list[str]]:
    """Divide what is ours from what stands between ``--ros-args`` and ``--``."""
    own: list[str] = []
    of_ros: list[str] = []
    within = False
    for each in arguments:
        if each == "--ros-args":
            within = True
        elif within and each == "--":
            within = False
        else:
            (of_ros if within else own).append(each)
    return own, of_ros


def _given(own: Sequence[str], option: str) -> bool:
    return any(each == option or each.startswith(f"{option}=") for each in own)


def _ros1_arguments(arguments: Sequence[str]) -> Iterator[int]:
    """Give the places of ``name:=value`` that are no values of ``--remap`` or ``--param``."""
    for place, each in enumerate(arguments):
        if each == "--ros-args":
            return
        if _SIGN in each and not each.startswith("-") and not _is_value(arguments, place):
            yield place


def _is_value(arguments: Sequence[str], place: int) -> bool:
    """Whether an argument is the value of an option of ours."""
    return place > 0 and arguments[place - 1] in ("--remap", "--param")


def _ros1_options(written: Iterable[str]) -> Iterator[str]:
    for each in written:
        name, _, value = each.partition(_SIGN)
        if name in _NAMES:
            yield from (_NAMES[name], value)
        elif name in _ROS1_WITHOUT_EFFECT:
            continue
        elif name.startswith("__"):
            raise UsageError(
                f"unsupported argument {each}; set the address with the variables ROS_IP and ROS_HOSTNAME"
            )
        elif name.startswith("_"):
            yield from ("--param", each[1:])
        else:
            yield from ("--remap", each)


class _Ros2Arguments:
    """What stands behind ``--ros-args``."""

    def __init__(self, written: Sequence[str]) -> None:
        self._options: list[str] = []
        self._rules: list[str] = []
        self._parameters: list[str] = []
        self._files: list[str] = []
        rest = iter(written)
        for each in rest:
            if each in _ROS2_FLAGS:
                self._options += [_ROS2_FLAGS[each]] if _ROS2_FLAGS[each] else []
            elif each in _ROS2_VALUES:
                self._take(each, _ROS2_VALUES[each], next(rest, None))
            else:
                known = ", ".join([*_ROS2_VALUES, *_ROS2_FLAGS])
                raise UsageError(
                    f"unknown argument {each} after --ros-args; expected {known}, or -- before other arguments"
                )

    def _take(self, written: str, name: str, value: str | None) -> None:
        if value is None:
            raise UsageError(f"missing value after {written} of --ros-args")
        if name == "--params-file":
            self._files.append(value)
        elif name:
            left, sign, right = value.partition(_SIGN)
            if not sign or not left:
                raise UsageError(f"{written} of --ros-args is written {written} NAME:=VALUE, not {value!r}")
            if ":" in left:
                raise UsageError(
                    f"{written} {value}: leave out the name of the node; this process has one node"
                )
            if name == "--param":
                self._parameters.append(value)
            elif left in _NAMES:
                self._options += [_NAMES[left], right]
            else:
                self._rules.append(value)

    def options(self) -> list[str]:
        """Give our options for all of it."""
        return [
            *self._options,
            *(part for rule in self._rules for part in ("--remap", rule)),
            *(part for parameter in self._parameters for part in ("--param", parameter)),
            *(part for file in self._files for part in ("--params-file", file)),
        ]


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
