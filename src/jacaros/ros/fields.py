"""The types of message fields, read from the notations of the client libraries of ROS 1 and ROS 2."""

import re
from dataclasses import dataclass, replace

TIME = "builtin_interfaces/msg/Time"
DURATION = "builtin_interfaces/msg/Duration"

INTEGER_RANGES = {
    f"{sign}int{bits}": (0 if sign else -(2 ** (bits - 1)), 2 ** (bits if sign else bits - 1) - 1)
    for sign in ("", "u")
    for bits in (8, 16, 32, 64)
} | {"byte": (0, 255), "char": (0, 255)}
FLOATS = ("float32", "float64")


@dataclass(frozen=True)
class FieldType:
    """The type of one field.

    Attributes:
        base: ``bool``, ``byte``, ``char``, ``int8`` … ``uint64``, ``float32``, ``float64``, ``string``, or the full
            name of a message type. ROS 1's time and duration are ``builtin_interfaces/msg/Time`` and ``…/Duration``,
            as on ROS 2.
        array: whether it is an array or sequence of *base*.
        length: exact length of an array, maximum length of a bounded sequence, 0: no limit.
        fixed: whether *length* is exact.
        bound: maximum number of characters of a string, or of each in an array; 0: no limit.
    """

    base: str
    array: bool = False
    length: int = 0
    fixed: bool = False
    bound: int = 0

    @property
    def element(self) -> "FieldType":
        """The type of a single element of an array."""
        return FieldType(self.base, bound=self.bound)

    @property
    def is_message(self) -> bool:
        """Whether the elements are messages."""
        return "/" in self.base

    @property
    def is_numeric(self) -> bool:
        """Whether the elements are numbers or booleans."""
        return self.base in INTEGER_RANGES or self.base in FLOATS or self.base == "bool"

    def __str__(self) -> str:
        single = f"{self.base}<={self.bound}" if self.bound else self.base
        if not self.array:
            return single
        if self.fixed:
            return f"{single}[{self.length}]"
        return f"{single}[<={self.length}]" if self.length else f"{single}[]"


_ROS1 = re.compile(r"(?P<base>[\w/]+)(?P<array>\[(?P<length>\d*)\])?")
_ROS1_BASES = {
    "byte": "int8",
    "char": "uint8",
    "time": TIME,
    "duration": DURATION,
    "Header": "std_msgs/msg/Header",
}


def from_ros1(text: str) -> FieldType:
    """Read ROS 1's notation: ``float64[36]``, ``geometry_msgs/Pose``, ``time``."""
    match = _ROS1.fullmatch(text)
    if match is None:
        raise ValueError(f"not a ROS 1 field type: {text!r}")
    base = _ROS1_BASES.get(match["base"], match["base"])
    length = int(match["length"] or 0)
    return FieldType(_full(base), match["array"] is not None, length, fixed=length > 0)


_ROS2_ARRAY = re.compile(r"(?P<base>.+)\[(?P<length>\d+)\]")
_ROS2_SEQUENCE = re.compile(r"sequence<(?P<base>.+?)(?:,\s*(?P<length>\d+))?>")
_ROS2_STRING = re.compile(r"w?string(<(?P<bound>\d+)>)?")
_ROS2_BASES = {"boolean": "bool", "octet": "byte", "float": "float32", "double": "float64"}


def from_ros2(text: str) -> FieldType:
    """Read the notation of ROS 2's Python classes: ``sequence<double, 3>``, ``double[36]``, ``string``."""
    if match := _ROS2_SEQUENCE.fullmatch(text):
        return replace(_ros2_single(match["base"]), array=True, length=int(match["length"] or 0))
    if match := _ROS2_ARRAY.fullmatch(text):
        return replace(_ros2_single(match["base"]), array=True, length=int(match["length"]), fixed=True)
    return _ros2_single(text)


def _ros2_single(text: str) -> FieldType:
    if match := _ROS2_STRING.fullmatch(text):
        return FieldType("string", bound=int(match["bound"] or 0))
    return FieldType(_full(_ROS2_BASES.get(text, text)))


def _full(base: str) -> str:
    return base.replace("/", "/msg/") if base.count("/") == 1 else base
