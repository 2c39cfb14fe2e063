"""Message packages, such as ``geometry_msgs.msg``, with the types of the memory graph."""

import importlib.abc
import importlib.machinery
import re
import sys
from collections.abc import Callable, Mapping, Sequence
from functools import partial
from types import ModuleType
from typing import Any

from jacaros.robots.ros.errors import UnknownInterface
from jacaros.robots.ros.message import constant
from jacaros.robots.ros.names import feedback_type, goal_type, request_type, response_type, result_type
from jacaros.robots.ros.typestore import DefinitionSchema

_SCHEMA = DefinitionSchema()
_PACKAGE = re.compile(r"(\w+_msgs|std_srvs|\w+_interfaces)(?:\.(msg|srv|action))?")
_PARTS: Mapping[str, Mapping[str, Callable[[str], str]]] = {
    "action": {"Goal": goal_type, "Result": result_type, "Feedback": feedback_type},
    "srv": {"Request": request_type, "Response": response_type},
}


class Interface:
    """A message, service or action type: called, a message type makes a message.

    Args:
        type_name: such as ``geometry_msgs/msg/Twist``.

    Raises:
        UnknownInterface: the memory graph does not know the type.
    """

    def __init__(self, type_name: str) -> None:
        self.type_name = type_name
        self.__name__ = type_name.split("/")[-1]
        self._parts = _PARTS.get(type_name.split("/")[1], {})
        if not self._parts or type_name.endswith(tuple(f"_{part}" for part in self._parts)):
            _SCHEMA.fields(type_name)
        else:
            _SCHEMA.load(type_name)

    def __call__(self, **fields: Any) -> Any:
        message = _SCHEMA.new(self.type_name)
        for name, value in fields.items():
            getattr(message, name)  # raises AttributeError for an unknown field
            setattr(message, name, value)
        return message

    def __getattr__(self, name: str) -> Any:
        if name in self._parts:
            return Interface(self._parts[name](self.type_name))
        return constant(_SCHEMA.new(self.type_name), name)


def is_message_package(name: str) -> bool:
    """Return whether a module's name is that of a message package, or of its part ``msg``, ``srv`` or ``action``."""
    return _PACKAGE.fullmatch(name) is not None


class MessagePackages(importlib.abc.MetaPathFinder, importlib.abc.Loader):
    """Finds message packages while it is in ``sys.meta_path``."""

    def find_spec(
        self, fullname: str, path: Sequence[str] | None, target: ModuleType | None = None
    ) -> importlib.machinery.ModuleSpec | None:
        """Find ``PACKAGE``, ``PACKAGE.msg``, ``PACKAGE.srv`` and ``PACKAGE.action``."""
        if not is_message_package(fullname):
            return None
        return importlib.machinery.ModuleSpec(fullname, self, is_package="." not in fullname)

    def create_module(self, spec: importlib.machinery.ModuleSpec) -> ModuleType:
        """Make the module; its types are made at first use."""
        module = ModuleType(spec.name)
        if "." in spec.name:
            module.__getattr__ = partial(_type_in, spec.name.replace(".", "/"))  # type: ignore[method-assign]
        return module

    def exec_module(self, module: ModuleType) -> None:
        """Nothing is to be executed."""

    def close(self) -> None:
        """Forget the modules, so that genuine ones can be imported."""
        for name in [name for name in sys.modules if is_message_package(name)]:
            if getattr(sys.modules[name].__spec__, "loader", None) is self:
                del sys.modules[name]


def _type_in(folder: str, name: str) -> Interface:
    if name.startswith("__"):
        raise AttributeError(name)
    try:
        return Interface(f"{folder}/{name}")
    except UnknownInterface as unknown:
        raise AttributeError(str(unknown)) from None
