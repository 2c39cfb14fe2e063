"""The types of message fields, read from the notations of the client libraries, and from message definitions.

Each line of a definition (``.msg``, and the parts of ``.srv`` and ``.action``) of ROS 1 or ROS 2 is a field,
``float64[<=3] name default``, a constant, ``uint8 NAME=7``, or a comment. Default values are ignored: few definitions have
them, and `jacaros.robots.ros.message.DEFAULTS` holds those.
"""

import ast
import re
from collections.abc import Mapping
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


_LINE = re.compile(
    r"""\s* (?:@[a-z]+\s+)?                                   # an annotation of ROS 2
    (?P<base>[A-Za-z]\w*(?:/\w+)*) (?:<=(?P<bound>\d+))?
    (?P<array>\[(?:(?P<most><=)?(?P<length>\d+))?\])?
    \s+ (?P<name>[A-Za-z]\w*) (?:\s*=\s*(?P<constant>.*\S)|\s*|\s+[^\s=].*)""",
    re.VERBOSE,
)
_PLAIN = frozenset({*INTEGER_RANGES, *FLOATS, "bool", "string"})
_OTHER_NAMES = {"time": TIME, "duration": DURATION, "Header": "std_msgs/msg/Header", "wstring": "string"}
_COMMENT = re.compile(r"\s*#.*")


@dataclass(frozen=True)
class MessageDefinition:
    """A parsed message definition.

    Attributes:
        fields: types by name, in order.
        constants: values by name, in order.
    """

    fields: Mapping[str, FieldType]
    constants: Mapping[str, object]


def parse_definition(text: str, package: str) -> MessageDefinition:
    """Parse the definition of a message.

    Args:
        text: text of the definition.
        package: package of types that are named without one.

    Raises:
        ValueError: a line is neither a field nor a constant, or a name occurs twice.
    """
    fields: dict[str, FieldType] = {}
    constants: dict[str, object] = {}
    for number, line in enumerate(text.splitlines(), 1):
        if _COMMENT.sub("", line).strip():
            match = _LINE.fullmatch(line) or _LINE.fullmatch(_COMMENT.sub("", line))
            if match is None:
                raise ValueError(f"line {number}: expected a field or a constant, found `{line.strip()}`")
            name = match["name"]
            if name in fields or name in constants:
                raise ValueError(f"line {number}: the name `{name}` occurs twice")
            try:
                if match["constant"] is None:
                    fields[name] = _field(match, package)
                else:
                    constants[name] = _constant(match["base"], match["constant"])
            except ValueError as problem:
                raise ValueError(f"line {number}: {problem}") from None
    return MessageDefinition(fields, constants)


def from_ros1(text: str) -> FieldType:
    """Read the notation of ROS 1's Python classes: ``float64[36]``, ``geometry_msgs/Pose``, ``time``."""
    match = _LINE.fullmatch(f"{text} name")
    if match is None:
        raise ValueError(f"not a ROS 1 field type: {text!r}")
    field = _field(match, "")
    return replace(field, base={"byte": "int8", "char": "uint8"}.get(field.base, field.base))


def _field(match: re.Match[str], package: str) -> FieldType:
    base = _OTHER_NAMES.get(match["base"], match["base"])
    if base not in _PLAIN:
        parts = base.split("/")
        base = f"{parts[0] if len(parts) > 1 else package}/msg/{parts[-1]}" if len(parts) < 3 else base
    length = int(match["length"] or 0)
    fixed = length > 0 and not match["most"]
    return FieldType(base, match["array"] is not None, length, fixed, int(match["bound"] or 0))


def _constant(base: str, text: str) -> object:
    if base in ("string", "wstring"):
        return ast.literal_eval(text) if re.fullmatch(r"'.*'|\".*\"", text) else text
    text = _COMMENT.sub("", text)
    if base == "bool" and text.lower() in ("true", "false", "0", "1"):
        return text.lower() in ("true", "1")
    if base in FLOATS:
        return float(text)
    if base in INTEGER_RANGES:
        # ROS 1 and ROS 2 read a leading zero as C does: octal.
        return int(text, 8) if re.fullmatch(r"[+-]?0[0-7]+", text) else int(text, 0)
    raise ValueError(f"`{text}` is not a value of {base}")
