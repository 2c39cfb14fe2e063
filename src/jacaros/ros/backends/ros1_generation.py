"""Message, service and action classes made by genpy from definitions that no installed ROS 1 package offers.

The classes are those that the definition's own package would have: same names, same fields, same md5 sums, so nodes that
have the genuine package understand them.  The Python source that genpy writes is kept in a cache folder.
"""

import hashlib
import os
import re
import tempfile
from collections.abc import Callable, Iterator
from importlib import import_module
from importlib.util import module_from_spec, spec_from_file_location
from pathlib import Path
from types import ModuleType, SimpleNamespace
from typing import Any

from jacaros.ros.interfaces import split_action
from jacaros.text_files import kept_files

FindClass = Callable[[str], Any]
"""Gives the class of a message type named as on ROS 1, ``geometry_msgs/Pose``; raises `UnknownInterface`."""

ACTION_PARTS = {
    "ActionGoal": "Header header\nactionlib_msgs/GoalID goal_id\n{name}Goal goal\n",
    "ActionResult": "Header header\nactionlib_msgs/GoalStatus status\n{name}Result result\n",
    "ActionFeedback": "Header header\nactionlib_msgs/GoalStatus status\n{name}Feedback feedback\n",
    "Action": (
        "{name}ActionGoal action_goal\n{name}ActionResult action_result\n"
        "{name}ActionFeedback action_feedback\n"
    ),
}
"""What actionlib wraps around goal, result and feedback (``actionlib_msgs/scripts/genaction.py``)."""


def generated_message(full_name: str, text: str, find: FindClass) -> Any:
    """Give the class of a message.

    Args:
        full_name: as on ROS 1, ``nav2_msgs/Costmap``.
        text: its definition, in the notation of ROS 1 or ROS 2.
        find: finds the classes that the definition mentions.
    """
    text = ros1_notation(text)
    context, classes = _context([(full_name, text)], find)
    module = _module(full_name, _digest(text, classes), lambda: _message_source(context, full_name), classes)
    return getattr(module, full_name.split("/")[1])


def generated_service(full_name: str, text: str, find: FindClass) -> Any:
    """Give the class of a service; the arguments are those of `generated_message`."""
    loader = import_module("genmsg.msg_loader")
    text = ros1_notation(text)
    parts = loader.load_srv_from_string(loader.MsgContext.create_default(), text, full_name)
    context, classes = _context(
        [(f"{full_name}Request", parts.request.text), (f"{full_name}Response", parts.response.text)], find
    )

    def source() -> str:
        service = loader.load_srv_from_string(context, text, full_name)
        return _joined(import_module("genpy.generator").srv_generator(context, service, {}))

    return getattr(_module(full_name, _digest(text, classes), source, classes), full_name.split("/")[1])


def action_texts(name: str, text: str) -> dict[str, str]:
    """Split an action's definition into those of its seven messages, by what follows the action's name in theirs.

    Args:
        name: of the action without its package.
        text: the three parts of the definition.
    """
    goal, result, feedback = split_action(text)
    return {
        "Goal": goal,
        "Result": result,
        "Feedback": feedback,
        **{part: wrapping.format(name=name) for part, wrapping in ACTION_PARTS.items()},
    }


_FIELD = re.compile(r"^(?P<base>[\w/]+)(?P<bound><=\d+)?(?P<array>\[[^\]]*\])?\s+(?P<name>\w+)(?P<rest>.*)$")
_ROS1_BASES = {
    "builtin_interfaces/Time": "time",
    "builtin_interfaces/Duration": "duration",
    "wstring": "string",
    "octet": "uint8",
}


def ros1_notation(text: str) -> str:
    """Write a definition as ROS 1 does: no bounds, no default values, ``time`` and ``duration``.

    ROS 1's own definitions are not changed, so neither are their md5 sums.
    """
    return "\n".join(_ros1_line(line) for line in text.splitlines()) + "\n"


def _ros1_line(line: str) -> str:
    code = line.split("#", 1)[0].rstrip()
    match = _FIELD.match(code.strip())
    if match is None:
        return line
    rest = match["rest"].strip()
    base = _ROS1_BASES.get(match["base"], match["base"])
    array = re.sub(r"\[<=\d+\]", "[]", match["array"] or "")
    if rest.startswith("="):  # a constant
        return line if base == match["base"] and not match["bound"] else f"{base} {match['name']}{rest}"
    if base == match["base"] and array == (match["array"] or "") and not rest and not match["bound"]:
        return line
    return f"{base}{array} {match['name']}"


def _context(definitions: list[tuple[str, str]], find: FindClass) -> tuple[Any, dict[str, Any]]:
    """Load definitions and all that they mention; give genmsg's context and the classes mentioned, by name."""
    loader, messages = import_module("genmsg.msg_loader"), import_module("genmsg.msgs")
    context = loader.MsgContext.create_default()
    classes: dict[str, Any] = {}
    waiting = list(definitions)
    while waiting:
        name, text = waiting.pop()
        spec = loader.load_msg_from_string(context, text, name)
        for field in spec.types:
            mentioned = messages.resolve_type(messages.bare_msg_type(field), spec.package)
            if messages.is_builtin(mentioned) or mentioned in classes:
                continue
            found = classes[mentioned] = find(mentioned)
            # genpy puts the definitions of nested messages behind the message's own.
            waiting.append((mentioned, re.split(r"^={80}$", found._full_text, flags=re.MULTILINE)[0]))
    return context, classes


def _message_source(context: Any, full_name: str) -> str:
    generator = import_module("genpy.generator")
    return _joined(generator.msg_generator(context, context.get_registered(full_name), {}))


def _joined(lines: Iterator[str]) -> str:
    """The source without imports of message packages: their names are given to the module, see `_packages`."""
    source = "\n".join(lines) + "\n"
    return re.sub(r"^import \w+\.msg$", "", source, flags=re.MULTILINE)


def _digest(text: str, classes: dict[str, Any]) -> str:
    used = "".join(f"{name} {found._md5sum}\n" for name, found in sorted(classes.items()))
    return hashlib.sha256(f"{used}\n{text}".encode()).hexdigest()[:16]


def _module(full_name: str, digest: str, source: Callable[[], str], classes: dict[str, Any]) -> ModuleType:
    """Load the module of a definition, after writing it when it is not in the cache yet."""
    package, name = full_name.split("/")
    path = _cache_folder() / f"{package}_{name}_{digest}.py"
    if not path.is_file():
        # Written aside and renamed: another process may be loading or writing the same file.
        handle, aside = tempfile.mkstemp(dir=path.parent, suffix=".part")
        with os.fdopen(handle, "w", encoding="utf-8") as file:
            file.write(source())
        Path(aside).replace(path)
    spec = spec_from_file_location(f"jacaros_generated_{package}_{name}", path)
    assert spec is not None
    assert spec.loader is not None
    module = module_from_spec(spec)
    vars(module).update(_packages(classes))
    spec.loader.exec_module(module)
    return module


def _packages(classes: dict[str, Any]) -> dict[str, SimpleNamespace]:
    """What stands for ``import geometry_msgs.msg`` and the like: those packages may be generated themselves."""
    packages: dict[str, SimpleNamespace] = {}
    for full_name, found in classes.items():
        package, name = full_name.split("/")
        made = packages.setdefault(package, SimpleNamespace(msg=SimpleNamespace()))
        setattr(made.msg, name, found)
    return packages


def _cache_folder() -> Path:
    root = kept_files()
    if root is not None:
        folder = root / "ros1"
        try:
            folder.mkdir(parents=True, exist_ok=True)
            if os.access(folder, os.W_OK):
                return folder
        except OSError:  # a read-only or missing home directory
            pass
    return Path(tempfile.mkdtemp(prefix="jacaros-ros1-"))
