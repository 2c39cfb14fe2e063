"""Checking of single values and arrays of numbers against the type of a field."""

from typing import Any

from jacaros.ros.fields import FLOATS, INTEGER_RANGES, FieldType


def written(value: object) -> str:
    """A value as messages to people have it: those of a user's own classes, such as terms, as ``str`` gives them."""
    return repr(value) if type(value).__module__ == "builtins" else str(value)


def single_value(field: FieldType, value: Any) -> bool | int | float | str:
    """Give *value* as the plain Python value that fits *field* (its base, not an array).

    Whole floating-point numbers are taken for integer fields, numpy scalars for all.

    Raises:
        TypeError: another kind of value is needed.
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
        return str.__str__(value)  # subclasses, such as atoms of the agents' language, become plain texts
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


def array_of_numbers(field: FieldType, values: Any) -> Any:
    """Give *values* as a one-dimensional numpy array of the field's type.

    Raises:
        TypeError: these are no numbers, or floating-point numbers for integers.
        ValueError: wrong length or out of range.
    """
    import numpy  # not at the top: many systems send no array at all, and numpy takes 0.1 s to import

    if isinstance(values, bytes | bytearray | memoryview):
        given = numpy.frombuffer(values, dtype=numpy.uint8)
    elif isinstance(values, str | dict):
        raise TypeError(f"{values!r} is given")
    else:
        given = numpy.asarray(values)
    if given.size == 0:
        given = zeros(field, 0)
    dtype = zeros(field, 0).dtype
    if given.ndim != 1 or given.dtype.kind not in ("b" if field.base == "bool" else "iuf"):
        raise TypeError(f"{_shortened(values)} is given")
    if field.length and (len(given) != field.length if field.fixed else len(given) > field.length):
        raise ValueError(f"{len(given)} elements are given")
    if given.dtype == dtype:
        return given
    if dtype.kind != "f":
        if given.dtype.kind == "f" and not bool((given == numpy.floor(given)).all()):
            raise TypeError("numbers with fractions are given")
        low, high = INTEGER_RANGES[field.base]
        if given.size and (given.min() < low or given.max() > high):
            raise ValueError(
                f"numbers from {given.min()} to {given.max()} are given; allowed: {low} to {high}"
            )
    return given.astype(dtype)


def zeros(field: FieldType, length: int) -> Any:
    """Make a numpy array of *length* zeros of the field's type."""
    import numpy

    return numpy.zeros(length, {"byte": "uint8", "char": "uint8"}.get(field.base, field.base))


def _shortened(values: Any) -> str:
    text = repr(values)
    return text if len(text) <= 60 else text[:57] + "..."
