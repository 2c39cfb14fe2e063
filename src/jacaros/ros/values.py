"""Check single values and arrays of numbers against the type of a field."""

from array import array
from collections.abc import Iterable, Mapping, Set
from typing import Any

from jacaros.ros.fields import FLOATS, INTEGER_RANGES, FieldType


def written(value: object) -> str:
    """Format a value for an error message: ``repr`` for built-in types, ``str`` for others, such as terms."""
    return repr(value) if type(value).__module__ == "builtins" else str(value)


def single_value(field: FieldType, value: Any) -> bool | int | float | str:
    """Return *value* as a plain Python value of the base type of *field* (not as an array).

    Integer fields accept whole floating-point numbers, and all fields accept numpy scalars.

    Raises:
        TypeError: the value has the wrong type.
        ValueError: the number is out of range, or the string too long.
    """
    if hasattr(value, "item") and getattr(value, "shape", None) == ():
        value = value.item()
    if field.base == "string":
        return _text(field, value)
    if field.base == "bool":
        if isinstance(value, bool):
            return value
    elif not isinstance(value, bool):
        if field.base in FLOATS and isinstance(value, int | float):
            return float(value)
        if field.base in INTEGER_RANGES:
            return _integer(field.base, value)
    raise TypeError(f"{written(value)} is given")


def _text(field: FieldType, value: Any) -> str:
    if isinstance(value, str):
        if field.bound and len(value) > field.bound:
            raise ValueError(f"a string of {len(value)} characters is given")
        return str.__str__(value)  # convert subclasses, such as atoms, to plain strings
    raise TypeError(f"{written(value)} is given")


def _integer(base: str, value: Any) -> int:
    if base == "byte" and isinstance(value, bytes) and len(value) == 1:
        return value[0]
    if isinstance(value, float) and value.is_integer():
        value = int(value)
    if not isinstance(value, int):
        raise TypeError(f"{written(value)} is given")
    low, high = INTEGER_RANGES[base]
    if not low <= value <= high:
        raise ValueError(f"{value} is given; it must be from {low} to {high}")
    return value


_TYPECODES = {
    "float64": "d",
    "float32": "f",
    "int8": "b",
    "uint8": "B",
    "byte": "B",
    "char": "B",
    "int16": "h",
    "uint16": "H",
    "int32": "i",
    "uint32": "I",
    "int64": "q",
    "uint64": "Q",
}
"""Type codes of `array.array`, the same as in rclpy."""


def array_of_numbers(field: FieldType, values: Any) -> Any:
    """Return *values* as an `array.array` of the field's type, or as a list for booleans.

    Accepts lists, tuples, ranges, bytes, numpy arrays and any other iterable.

    Raises:
        TypeError: an element is not a number, or has a fraction in an integer field.
        ValueError: wrong length or out of range.
    """
    if isinstance(values, str | Mapping | Set) or not isinstance(values, Iterable):
        raise TypeError(f"{_shortened(values)} is given")
    made = _converted(field, values)
    if field.length and (len(made) != field.length if field.fixed else len(made) > field.length):
        raise ValueError(f"{len(made)} elements are given")
    return made


def _converted(field: FieldType, values: Any) -> Any:
    if isinstance(values, bytes | bytearray | memoryview):
        values = array("B", bytes(values))  # one number per byte, not raw bytes of wider numbers
    code = _TYPECODES.get(field.base)
    if code is not None and isinstance(values, array):
        if values.typecode == code:
            return values
    elif hasattr(values, "tolist"):
        values = values.tolist()
    if code is not None:
        try:
            return array(code, values)
        except (OverflowError, TypeError):
            pass  # an element is invalid, or is a whole float for an integer field: check each one below
    checked: list[Any] = [single_value(field.element, each) for each in values]
    return checked if code is None else array(code, checked)


def zeros(field: FieldType, length: int) -> Any:
    """Make *length* zeros of the field's type: an `array.array`, or a list for booleans."""
    code = _TYPECODES.get(field.base)
    return [False] * length if code is None else array(code, bytes(length * array(code).itemsize))


def _shortened(values: Any) -> str:
    text = repr(values)
    return text if len(text) <= 60 else text[:57] + "..."
