"""Arguments that ROS's own tools add to a command line, translated to our options.

``ros2 run`` and launch files of ROS 2 pass names and parameters after ``--ros-args`` (design.ros2.org, "ROS Command Line
Arguments"); rosrun and roslaunch mix ``name:=value`` with the other arguments (wiki.ros.org, "Remapping Arguments").
"""

import itertools
import os
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any

from jacaros.robots.ros.middleware import ROS_KINDS
from jacaros.runtime.cli.usage import usage_error
from jacaros.runtime.errors import UsageError
from jacaros.runtime.files.texts import file_text

OptionWords = tuple[str, ...]
"""The words of one of our options: its name, and its value; none for an argument without effect."""

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
"""ROS 2 arguments that take a value, and our option for each; an empty name marks arguments without effect here."""
_ROS2_FLAGS: Mapping[str, OptionWords] = {
    "--enable-rosout-logs": ("--rosout",),
    "--disable-rosout-logs": ("--no-rosout",),
    "--enable-stdout-logs": (),
    "--disable-stdout-logs": (),
    "--enable-external-lib-logs": (),
    "--disable-external-lib-logs": (),
}
_NAMES = {"__ns": "--namespace", "__node": "--node-name", "__name": "--node-name", "__master": "--master"}
_ROS1_WITHOUT_EFFECT = ("__log",)


def has_ros_arguments(arguments: Sequence[str]) -> bool:
    """Return whether a command that joins a graph has arguments added by ROS's tools."""
    if not arguments or (arguments[0] not in ("run", "sim", "guard") and "." not in arguments[0]):
        return False
    return any(each == "--ros-args" for each in arguments) or any(_ros1_arguments(arguments))


def as_options(arguments: Sequence[str], warn: Callable[[str], None]) -> list[str]:
    """Return *arguments* with the arguments of ROS's tools replaced by our options.

    Adds ``--ros ros2`` (or ``ros1``) unless another kind of graph is selected.

    Args:
        arguments: command line without the program name.
        warn: takes a warning about an argument without effect.

    Raises:
        UsageError: an argument of ROS is unknown or malformed.
    """
    own, of_ros2 = _divided(arguments)
    places = list(_ros1_arguments(own))
    added = list(filter(None, (*(_of_ros1(own[place]) for place in places), *_of_ros2(of_ros2))))
    own = [each for place, each in enumerate(own) if place not in places]
    if own[:1] == ["sim"]:
        added = _without_parameters(added, warn)
    kind = os.environ.get("JACAROS_ROS") or ("ros1" if places and "--ros-args" not in arguments else "ros2")
    # An unknown kind remains in the environment, so that the error names the variable.
    if not _given(own, "--ros") and (kind in ROS_KINDS or ":" in kind):
        added.append(("--ros", kind))
    return [*own, *itertools.chain.from_iterable(added)]


def _without_parameters(options: list[OptionWords], warn: Callable[[str], None]) -> list[OptionWords]:
    """Drop parameters: a world declares none, and keeps its own time."""
    values: dict[str, list[str]] = {"--namespace": [""], "--node-name": ["world"]}
    for option, *value in options:
        values.setdefault(option, []).extend(value)
    node = f"{values['--namespace'][-1]}/{values['--node-name'][-1]}"
    files = [Path(file) for file in values.get("--params-file", ())]
    for name in read_parameters(values.get("--param", ()), files, node):
        if name != "use_sim_time":
            warn(f"parameter `{name}` has no effect: worlds have no parameters; edit the world file instead")
    return [option for option in options if option[0] not in ("--param", "--params-file")]


def _divided(arguments: Sequence[str]) -> tuple[list[str], list[str]]:
    """Separate our arguments from those between ``--ros-args`` and ``--``."""
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
    """Yield the indices of ``name:=value`` arguments, except values of ``--remap`` and ``--param``."""
    for place, each in enumerate(arguments):
        if each == "--ros-args":
            return
        is_value = place > 0 and arguments[place - 1] in ("--remap", "--param")
        if _SIGN in each and not each.startswith("-") and not is_value:
            yield place


def _of_ros1(written: str) -> OptionWords:
    name, _, value = written.partition(_SIGN)
    if name in _NAMES:
        return _NAMES[name], value
    if name.startswith("__"):
        if name in _ROS1_WITHOUT_EFFECT:
            return ()
        raise usage_error(f"unsupported argument: `{written}`", "set ROS_IP or ROS_HOSTNAME for the address")
    return ("--param", written[1:]) if name.startswith("_") else ("--remap", written)


def _of_ros2(written: Iterable[str]) -> Iterator[OptionWords]:
    """Yield our options for the arguments after ``--ros-args``."""
    rest = iter(written)
    for each in rest:
        if each in _ROS2_FLAGS:
            yield _ROS2_FLAGS[each]
            continue
        if each not in _ROS2_VALUES:
            known = ", ".join([*_ROS2_VALUES, *_ROS2_FLAGS])
            raise usage_error(
                f"unknown argument after --ros-args: `{each}`",
                f"expected {known}, or `--` before other arguments",
            )
        option, value = _ROS2_VALUES[each], next(rest, None)
        if value is None:
            raise usage_error(f"missing value after `{each}` of --ros-args")
        if option in ("--remap", "--param"):
            left, sign, right = value.partition(_SIGN)
            if not sign or not left:
                raise usage_error(
                    f"invalid value of {each} in --ros-args: expected NAME:=VALUE, found `{value}`"
                )
            if ":" in left:
                raise usage_error(
                    f"unexpected node name: `{each} {value}`",
                    f"this process has one node: {each} {value.partition(':')[2]}",
                )
            if option == "--remap" and left in _NAMES:
                option, value = _NAMES[left], right
        if option:
            yield option, value


def read_parameters(
    written: Sequence[str], files: Sequence[Path], node: str, separator: str = "."
) -> dict[str, Any]:
    """Read the values of parameters. Single parameters override files, and later files override earlier ones.

    Args:
        written: ``NAME:=VALUE`` with a YAML value.
        files: ROS 2 parameter files.
        node: absolute name of our node.
        separator: separates the parts of a nested name: ``.``, or ``/`` on ROS 1.

    Raises:
        UsageError: a parameter or file is malformed, or a file does not exist.
    """
    found: dict[str, Any] = {}
    name = [part for part in node.split("/") if part]
    for file in files:
        found |= _flat(_of_node(_content(file), [], name), separator)
    return found | _flat(map(_written, written), separator)


def _written(each: str) -> tuple[str, Any]:
    name, sign, value = each.partition(":=")
    if not sign or not name:
        raise usage_error(
            f"invalid value of --param: expected NAME:=VALUE, found `{each}`", "--param speed:=0.5"
        )
    return name, _yaml(value, f"--param {name}")


def _content(file: Path) -> Any:
    try:
        text = file_text(file)
    except (OSError, UnicodeError) as error:
        raise usage_error(f"--params-file {file}: {getattr(error, 'strerror', '') or error}") from None
    content = _yaml(text, f"--params-file {file}")
    if content is not None and not isinstance(content, Mapping):
        raise usage_error(
            f"--params-file {file}: expected a mapping", "write NODE: {ros__parameters: {NAME: VALUE}}"
        )
    return content


def _flat(given: Iterable[tuple[str, Any]], separator: str) -> dict[str, Any]:
    """Return the values by parameter name, nested mappings flattened."""
    found: dict[str, Any] = {}
    for name, value in given:
        if isinstance(value, Mapping):
            parts = ((f"{name}{separator}{part}", each) for part, each in value.items())
            found |= _flat(parts, separator)
        elif value is None:
            raise usage_error(f"parameter `{name}` has no value", "write \"''\" for an empty string")
        else:
            found[name] = value
    return found


def _of_node(content: Any, path: list[str], node: list[str]) -> Iterator[tuple[str, Any]]:
    """Yield the parameters of *node* in a file, which nests namespaces and nodes."""
    if not isinstance(content, Mapping):
        return
    for key, value in content.items():
        if key == "ros__parameters":
            if isinstance(value, Mapping) and _suits(path, node):
                yield from ((str(name), each) for name, each in value.items())
        else:
            yield from _of_node(value, [*path, *filter(None, str(key).split("/"))], node)


def _suits(pattern: list[str], node: list[str]) -> bool:
    """Return whether a node name matches a pattern: ``*`` is one part of the name, ``**`` any number of parts."""
    if not pattern:
        return not node
    if pattern[0] == "**":
        return any(_suits(pattern[1:], node[begin:]) for begin in range(len(node) + 1))
    return bool(node) and pattern[0] in ("*", node[0]) and _suits(pattern[1:], node[1:])


def _yaml(text: str, where: str) -> Any:
    # Here: only for runs with parameters.
    from jacaros.runtime.files.yaml import plain_values, shown

    value, wrong = plain_values(text)
    if wrong is not None:
        raise UsageError(shown(where, text.splitlines(), wrong))
    return value
