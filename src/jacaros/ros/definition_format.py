"""The format of message definitions (``.msg``, and the parts of ``.srv`` and ``.action``) of ROS 1 and ROS 2.

Each line is a field, ``float64[<=3] name default``, a constant, ``uint8 NAME=7``, or a comment. Default values are ignored:
few definitions have them, and `jacaros.ros.message.DEFAULTS` holds those.
"""

import ast
import re
from collections.abc import Mapping
from dataclasses import dataclass

from jacaros.ros.fields import DURATION, FLOATS, INTEGER_RANGES, TIME, FieldType

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
class Definition:
    """A parsed message definition.

    Attributes:
        fields: types by name, in order.
        constants: values by name, in order.
    """

    fields: Mapping[str, FieldType]
    constants: Mapping[str, object]


def parse_definition(text: str, package: str) -> Definition:
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
    return Definition(fields, constants)


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
