"""Every message type can be mapped, with all its fields, nested ones and arrays too."""

from collections.abc import Iterator
from typing import Any

import numpy
import pytest
from hypothesis import given, settings
from hypothesis import strategies as some

from jacaros.artifacts.env.values import Atom, Structure, plain
from jacaros.robots.mapping.decoding import extractor
from jacaros.robots.mapping.fields import FieldPart, FilePosition, read_path
from jacaros.robots.mapping.interfaces import known_types, stored_interfaces
from jacaros.robots.mapping.properties import TopicPart
from jacaros.robots.ros.fields import FLOATS, INTEGER_RANGES, FieldType
from jacaros.robots.ros.message import TIMES

KNOWN = stored_interfaces()
TYPES = [name for name in known_types("msg") if not name.endswith(("_Request", "_Response"))]
HERE = FilePosition(1, 1)


def leaves(type_name: str, before: str = "") -> Iterator[tuple[str, FieldType]]:
    """The paths of all fields that are not messages themselves, of arrays of messages those of all elements."""
    for name, kind in KNOWN.fields(type_name).items():
        path = f"{before}{name}"
        if not kind.is_message or kind.base in TIMES:
            yield path, kind
        elif kind.array:
            yield from leaves(kind.base, f"{path}[*].")
        else:
            yield from leaves(kind.base, f"{path}.")


def value(draw: Any, kind: FieldType, depth: int) -> Any:
    if kind.array:
        length = kind.length if kind.fixed else draw(some.integers(0, min(2, kind.length or 2)))
        return [value(draw, FieldType(kind.base), depth) for _ in range(length)]
    if kind.base in TIMES:
        return draw(some.integers(0, 2**20))
    if kind.is_message:
        return content(draw, kind.base, depth + 1)
    if kind.base in INTEGER_RANGES:
        return draw(some.integers(*INTEGER_RANGES[kind.base]))
    if kind.base in FLOATS:
        return draw(some.floats(-1e6, 1e6, width=32))
    return draw(some.booleans() if kind.base == "bool" else some.text("ab", max_size=3))


def content(draw: Any, type_name: str, depth: int = 0) -> dict[str, Any]:
    return {name: value(draw, kind, depth) for name, kind in KNOWN.fields(type_name).items()}


def expected(path: str, message: dict[str, Any]) -> Any:
    """What stands at a path of leaves."""
    here: Any = message
    parts = path.split(".")
    for place, part in enumerate(parts):
        here = here[part.removesuffix("[*]")]
        if part.endswith("[*]"):
            return [expected(".".join(parts[place + 1 :]), each) for each in here]
    return here


def is_python(found: object) -> bool:
    if isinstance(found, list):
        return all(map(is_python, found))
    if isinstance(found, Structure):
        return all(map(is_python, found.arguments))
    return type(found) in (bool, int, float, str, Atom)


@pytest.mark.parametrize("type_name", TYPES)
@settings(max_examples=3)
@given(data=some.data())
def test_every_leaf_of_every_type_arrives_as_a_python_value(type_name: str, data: Any) -> None:
    told = content(data.draw, type_name)
    message = KNOWN.message(type_name, **told)
    paths = [path for path, _ in leaves(type_name)]
    fields = tuple(FieldPart(read_path(path), HERE) for path in paths)
    for part in (TopicPart("a", HERE, None, fields=fields), TopicPart("a", HERE, None)):
        problems: list[Any] = []
        extract = extractor(part, type_name, KNOWN, problems)
        assert problems == []
        assert extract is not None
        [row] = extract(message)
        assert all(map(is_python, row.values))
        assert tuple(map(plain, row.values)) == row.values
        if part.fields is not None and type_name not in TIMES:
            wanted = [expected(path, told) for path in paths]
            assert _rounded(list(row.values)) == _rounded(wanted)


def _rounded(found: Any) -> Any:
    """Numbers of single precision are near enough."""
    if isinstance(found, list):
        return [_rounded(each) for each in found]
    if isinstance(found, bool | str):
        return found
    return float(numpy.float32(found))
