"""The message, service and action classes of ROS 1 as a `Schema`; classes of missing packages are generated."""

import hashlib
import os
import re
import tempfile
from collections.abc import Callable, Iterator, Mapping, Sequence
from importlib import import_module
from importlib.util import module_from_spec, spec_from_file_location
from pathlib import Path
from types import ModuleType, SimpleNamespace
from typing import Any

from jacaros.robots.ros.errors import UnknownInterface
from jacaros.robots.ros.fields import DURATION, TIME, FieldType, from_ros1
from jacaros.robots.ros.interfaces import definition, how_to_define, split
from jacaros.robots.ros.message import DEFAULTS, Memo, Schema
from jacaros.runtime.files.texts import kept_files

ROS1_PACKAGES = {"example_interfaces/srv/AddTwoInts": "rospy_tutorials"}
"""Types that are in another package on ROS 1 than on ROS 2."""

ACTION_SUFFIXES = ("ActionGoal", "ActionResult", "ActionFeedback", "Action", "Goal", "Result", "Feedback")
"""Suffixes of the messages of an action, longer ones first."""

_ON_DEBIAN = {
    *("actionlib_msgs", "diagnostic_msgs", "geometry_msgs", "map_msgs", "move_base_msgs", "nav_msgs"),
    *("pcl_msgs", "rosgraph_msgs", "sensor_msgs", "shape_msgs", "std_msgs", "stereo_msgs", "tf2_msgs"),
    *("trajectory_msgs", "visualization_msgs"),
}
"""Packages of messages that Debian has, as ``python3-NAME``."""

_TIME_FIELDS = {
    TIME: {"sec": FieldType("uint32"), "nanosec": FieldType("uint32")},
    DURATION: {"sec": FieldType("int32"), "nanosec": FieldType("int32")},
}


class GenpySchema(Schema):
    """Classes of the installed ROS 1 packages, and of definitions.

    Args:
        roots: folders with further definitions; see `jacaros.robots.ros.interfaces`.
    """

    def __init__(self, roots: Sequence[Path] = ()) -> None:
        super().__init__(roots)
        self._setters: Memo[str, tuple[Callable[[Any], None], ...]] = Memo(
            lambda type_name: tuple(self._find_defaults(type_name, ()))
        )
        self._services, self._actions = Memo(self._find_service), Memo(self._find_action)

    def new(self, type_name: str) -> Any:
        """Make a message with the defaults of ROS 2, which genpy does not know. Raises `UnknownInterface`."""
        message = super().new(type_name)
        for set_default in self._setters[type_name]:
            set_default(message)
        return message

    def numbers(self, field: FieldType, values: Any) -> Any:
        """Convert an array to ``bytes`` for octets, otherwise to a list, which genpy serialises."""
        return values.tobytes() if field.base == "uint8" else list(values)

    def service_class(self, type_name: str) -> Any:
        """Return the class of a service type in full form. Raises `UnknownInterface`."""
        return self._services[type_name]

    def action_class(self, type_name: str, part: str) -> Any:
        """Return the class of one of actionlib's messages of an action.

        Args:
            type_name: action type in full form.
            part: ``ActionGoal``, ``ActionResult``, ``ActionFeedback``, ``Action``, ``Goal``, ``Result`` or
                ``Feedback``.

        Raises:
            UnknownInterface: the action is neither installed nor defined.
        """
        return self._actions[type_name, part]

    def _read_fields(self, type_name: str) -> Mapping[str, FieldType]:
        if type_name in _TIME_FIELDS:
            return _TIME_FIELDS[type_name]
        kind = self.message_class(type_name)
        return {name: from_ros1(text) for name, text in zip(kind.__slots__, kind._slot_types, strict=True)}

    def _find_class(self, type_name: str) -> Any:
        if type_name in (TIME, DURATION):
            return getattr(import_module("genpy"), type_name.rsplit("/", 1)[1])
        package, kind, name = type_name.split("/")
        whole, _, part = type_name.rpartition("_")
        if kind == "srv":
            return getattr(self.service_class(whole), f"_{part.lower()}_class")
        if kind == "action":
            return self.action_class(whole, part)
        found = _imported(package, kind, name) or self._generated_message(package, name)
        if found is None:
            help = f"install {package}"
            if package in _ON_DEBIAN:
                help += f" (on Debian: apt-get install python3-{package.replace('_', '-')})"
            raise UnknownInterface(
                f"message type {type_name} is not installed for ROS 1; {help}, or {how_to_define(type_name)}"
            )
        return found

    def _generated_message(self, package: str, name: str) -> Any:
        """Return the class of a message from its definition, alone or as a part of an action; None without a
        definition."""
        text = definition(f"{package}/msg/{name}", self._roots)
        if text is not None:
            return self._generate(generated_message, f"{package}/{name}", text)
        for suffix in ACTION_SUFFIXES:
            action_text = definition(f"{package}/action/{name.removesuffix(suffix)}", self._roots)
            if name.endswith(suffix) and action_text is not None:
                return self._generated_part(package, name.removesuffix(suffix), suffix, action_text)
        return None

    def _find_defaults(self, type_name: str, path: tuple[str, ...]) -> Iterator[Callable[[Any], None]]:
        for name, value in DEFAULTS.get(type_name, {}).items():
            yield _setter(path, name, value)
        if type_name not in _TIME_FIELDS:
            for name, field in self.fields(type_name).items():
                if field.is_message and not field.array:
                    yield from self._find_defaults(field.base, (*path, name))

    def _find_service(self, type_name: str) -> Any:
        package, kind, name = type_name.split("/")
        ros1_package = ROS1_PACKAGES.get(type_name, package)
        found = _imported(ros1_package, kind, name)
        if found is not None:
            return found
        text = definition(type_name, self._roots)
        if text is None:
            raise UnknownInterface(
                f"service type {type_name} is not installed for ROS 1; install its package, or "
                f"{how_to_define(type_name)}"
            )
        return self._generate(generated_service, f"{ros1_package}/{name}", text)

    def _find_action(self, wanted: tuple[str, str]) -> Any:
        type_name, part = wanted
        package, _, name = type_name.split("/")
        if part not in ACTION_SUFFIXES:
            raise UnknownInterface(f"an action has no part {part!r} ({type_name})")
        installed = _imported(package, "msg", f"{name}Action") is not None
        if not installed and definition(type_name, self._roots) is None:
            guess = name.removesuffix("Action")
            help = "" if guess == name else f"; is it {package}/action/{guess}?"
            raise UnknownInterface(
                f"action type {type_name} is not installed for ROS 1 ({package}.msg has no {name}Action){help}; "
                f"install its package, or {how_to_define(type_name)}"
            )
        return self.message_class(f"{package}/msg/{name}{part}")

    def _generated_part(self, package: str, name: str, part: str, text: str) -> Any:
        action = f"{package}/action/{name}"
        try:
            texts = {full.removeprefix(f"{action}_"): each for full, each in split(action, text).items()}
        except ValueError as problem:
            raise UnknownInterface(f"invalid definition of {action}: {problem}") from None
        texts |= {wrapper: wrapping.format(name=name) for wrapper, wrapping in ACTION_PARTS.items()}
        return self._generate(generated_message, f"{package}/{name}{part}", texts[part])

    def _generate(self, generate: Callable[..., Any], full_name: str, text: str) -> Any:
        try:
            return generate(full_name, text, self._named_as_on_ros1)
        except _definition_errors() as problem:
            raise UnknownInterface(f"invalid definition of {full_name} for ROS 1: {problem}") from None

    def _named_as_on_ros1(self, full_name: str) -> Any:
        package, name = full_name.split("/")
        return self.message_class(f"{package}/msg/{name}")


def _setter(path: tuple[str, ...], name: str, value: object) -> Callable[[Any], None]:
    def set_default(message: Any) -> None:
        for step in path:
            message = getattr(message, step)
        setattr(message, name, value)

    return set_default


def _imported(package: str, kind: str, name: str) -> Any:
    try:
        return getattr(import_module(f"{package}.{kind}"), name, None)
    except ImportError:
        return None


def _definition_errors() -> tuple[type[Exception], ...]:
    return (import_module("genmsg").InvalidMsgSpec, import_module("genmsg").MsgGenerationException)


FindClass = Callable[[str], Any]
"""Returns the class of a message type with its ROS 1 name, ``geometry_msgs/Pose``. Raises `UnknownInterface`."""

ACTION_PARTS = {
    "ActionGoal": "Header header\nactionlib_msgs/GoalID goal_id\n{name}Goal goal\n",
    "ActionResult": "Header header\nactionlib_msgs/GoalStatus status\n{name}Result result\n",
    "ActionFeedback": "Header header\nactionlib_msgs/GoalStatus status\n{name}Feedback feedback\n",
    "Action": (
        "{name}ActionGoal action_goal\n{name}ActionResult action_result\n"
        "{name}ActionFeedback action_feedback\n"
    ),
}
"""The wrappers that actionlib adds to goal, result and feedback (``actionlib_msgs/scripts/genaction.py``)."""


def generated_message(full_name: str, text: str, find: FindClass) -> Any:
    """Return the class of a message.

    Args:
        full_name: ROS 1 name, ``nav2_msgs/Costmap``.
        text: its definition, in the notation of ROS 1 or ROS 2.
        find: finds the classes that the definition mentions.
    """
    text = ros1_notation(text)
    context, classes = _context([(full_name, text)], find)
    module = _module(full_name, _digest(text, classes), lambda: _message_source(context, full_name), classes)
    return getattr(module, full_name.split("/")[1])


def generated_service(full_name: str, text: str, find: FindClass) -> Any:
    """Return the class of a service; the arguments are those of `generated_message`."""
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


_FIELD = re.compile(r"^(?P<base>[\w/]+)(?P<bound><=\d+)?(?P<array>\[[^\]]*\])?\s+(?P<name>\w+)(?P<rest>.*)$")
_ROS1_BASES = {
    "builtin_interfaces/Time": "time",
    "builtin_interfaces/Duration": "duration",
    "wstring": "string",
    "octet": "uint8",
}


def ros1_notation(text: str) -> str:
    """Convert a definition to ROS 1's notation: no bounds, no default values, ``time`` and ``duration``.

    ROS 1's own definitions are unchanged, and so are their md5 sums.
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
    """Load definitions and all that they mention. Return genmsg's context and the mentioned classes, by name."""
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
            # genpy appends the definitions of nested messages to the message's own.
            waiting.append((mentioned, re.split(r"^={80}$", found._full_text, flags=re.MULTILINE)[0]))
    return context, classes


def _message_source(context: Any, full_name: str) -> str:
    generator = import_module("genpy.generator")
    return _joined(generator.msg_generator(context, context.get_registered(full_name), {}))


def _joined(lines: Iterator[str]) -> str:
    """Return the source without imports of message packages: their names are set in the module, see `_packages`."""
    source = "\n".join(lines) + "\n"
    return re.sub(r"^import \w+\.msg$", "", source, flags=re.MULTILINE)


def _digest(text: str, classes: dict[str, Any]) -> str:
    used = "".join(f"{name} {found._md5sum}\n" for name, found in sorted(classes.items()))
    return hashlib.sha256(f"{used}\n{text}".encode()).hexdigest()[:16]


def _module(full_name: str, digest: str, source: Callable[[], str], classes: dict[str, Any]) -> ModuleType:
    """Load the module of a definition; write it first if it is not in the cache."""
    package, name = full_name.split("/")
    path = _cache_folder() / f"{package}_{name}_{digest}.py"
    if not path.is_file():
        # Written to a temporary file and renamed: another process may load or write the same file.
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
    """Return stand-ins for ``import geometry_msgs.msg`` and the like: those packages may be generated, too."""
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
