"""Values of parameters in rclpy's terms."""

from typing import Any

from rclpy.parameter import Parameter  # type: ignore[import-not-found]

from jacaros.ros.errors import ParameterRefused

_KINDS: dict[type, Any] = {
    bool: Parameter.Type.BOOL,
    int: Parameter.Type.INTEGER,
    float: Parameter.Type.DOUBLE,
    str: Parameter.Type.STRING,
    bytes: Parameter.Type.BYTE_ARRAY,
}
_LIST_KINDS: dict[type, Any] = {
    bool: Parameter.Type.BOOL_ARRAY,
    int: Parameter.Type.INTEGER_ARRAY,
    float: Parameter.Type.DOUBLE_ARRAY,
    str: Parameter.Type.STRING_ARRAY,
}
_ARRAYS = {*_LIST_KINDS.values(), Parameter.Type.BYTE_ARRAY}
_WIDEST = 2**63


def parameter(name: str, value: Any, kind: Any = None) -> Any:
    """Make rclpy's object for a parameter.

    Args:
        name: its name.
        value: plain value.
        kind: rclpy's type of an empty list, which does not tell it by itself.

    Raises:
        ParameterRefused: no parameter can hold such a value.
    """
    if isinstance(value, list | tuple):
        elements = list(value)
        if not elements:
            return Parameter(name, kind if kind in _ARRAYS else Parameter.Type.STRING_ARRAY, [])
        if any(isinstance(element, int) and not -_WIDEST <= element < _WIDEST for element in elements):
            raise ParameterRefused(
                f"parameter {name}: {value!r} is too large for a parameter, which has 64 bits"
            )
        kinds = {_LIST_KINDS.get(type(element)) for element in elements}
        if len(kinds) == 1 and (kind := kinds.pop()) is not None:
            return Parameter(name, kind, elements)
    elif isinstance(value, bytes | bytearray):
        return Parameter(name, Parameter.Type.BYTE_ARRAY, [bytes([octet]) for octet in value])
    elif isinstance(value, int) and not -_WIDEST <= value < _WIDEST:
        raise ParameterRefused(f"parameter {name}: {value} is too large for a parameter, which has 64 bits")
    else:
        for python, kind in _KINDS.items():  # bool is an int, and comes first
            if isinstance(value, python):
                return Parameter(name, kind, python(value))
    raise ParameterRefused(
        f"parameter {name}: a parameter holds a bool, a number, a text, bytes, or a list of bools, ints, floats or "
        f"texts; not {value!r}"
    )


def plain_value(told: Any) -> Any:
    """Read a value that rclpy gives; None for a parameter without one."""
    if isinstance(told, str | bool | int | float) or told is None:
        return told
    elements = list(told)
    return b"".join(elements) if elements and isinstance(elements[0], bytes) else elements
