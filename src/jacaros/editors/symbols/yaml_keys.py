"""Keys and values of mapping, world and fault files, by the JSON Schemas that are made from their declarations."""

import re
from collections.abc import Iterator, Mapping
from functools import cache
from typing import Final

from jacaros.agents.language.diagnostics import SourceFile, Span
from jacaros.editors.schemas import SCHEMAS, Schema
from jacaros.editors.symbols.model import Completion, Hover, Position
from jacaros.editors.symbols.project_keys import project_completions
from jacaros.editors.symbols.yaml_places import Path, keys_in, place_in
from jacaros.runtime.mas.checks.files import PROJECTS

_WORD: Final = re.compile(r"[\w$./-]+")


def yaml_completions(file: SourceFile, at: Position) -> list[Completion]:
    """Return the keys or values that can be written at a position of a mapping, world, fault or project file.

    The keys of the file say which of them it is; nothing is known of a file with other keys. Project files have a
    language of their own.
    """
    if file.name.endswith(PROJECTS):
        return project_completions(file, at)
    place = place_in(_before(file, at))
    beside = keys_in(file.text).get(place.path, {})
    start = at.column - len(place.partial)
    replaces = Span(file, at.line, start, at.line, at.column)
    around = _schemas(file.text, place.path)
    found: dict[str, Completion] = {}
    if place.key:
        for each in _at_key(around, place.key):
            for value in _values(each):
                if value.startswith(place.partial.strip("\"'")):
                    found.setdefault(value, Completion(value, "value", value, replaces, _about(each)))
        return list(found.values())
    for each in around:
        for key, inner in each.get("properties", {}).items():
            if key.startswith(place.partial) and (key not in beside or key == place.partial):
                needed = key in each.get("required", ())
                ends = ":" if _is_section(inner) else ": "
                proposal = Completion(key, "key", f"{key}{ends}", replaces, _about(inner), rank=1 - needed)
                found.setdefault(key, proposal)
    return list(found.values())


def yaml_hover(file: SourceFile, at: Position) -> Hover | None:
    """Return what is declared of the key or value at a position of a mapping, world or fault file."""
    line = file.lines[at.line - 1] if at.line <= len(file.lines) else ""
    word = next((each for each in _WORD.finditer(line) if each.start() < at.column <= each.end() + 1), None)
    if word is None:
        return None
    place = place_in(_before(file, Position(at.line, word.end() + 1)))
    key = place.key or place.partial
    texts = dict.fromkeys(filter(None, map(_told, _at_key(_schemas(file.text, place.path), key))))
    span = Span(file, at.line, word.start() + 1, at.line, word.end() + 1)
    return Hover(f"`{key}`\n\n" + "\n\n".join(texts), span) if texts else None


def _before(file: SourceFile, at: Position) -> str:
    lines = file.lines[: at.line]
    return "\n".join([*lines[:-1], lines[-1][: at.column - 1]]) if lines else ""


@cache
def _every() -> tuple[Schema, ...]:
    return tuple([make() for make in SCHEMAS.values()])


def _kinds(keys: Mapping[str, str]) -> list[Schema]:
    """Return the schemas of files with these keys; all of them for an empty file."""
    known = [len(keys.keys() & each["properties"].keys()) for each in _every()]
    most = max(known)
    if keys and not most:
        return []
    return [each for each, count in zip(_every(), known, strict=True) if count == most]


def _schemas(text: str, path: Path) -> list[Schema]:
    """Return the schemas of the mapping at a path that fit the keys which it has."""
    keys = keys_in(text)
    walked: Path = ()
    found = _kinds(keys.get(walked, {}))
    for step in path:
        walked = (*walked, step)
        beside = keys.get(walked, {})
        items = (each["items"] for each in found if "items" in each)
        inner = items if isinstance(step, int) else _at_key(found, step)
        found = [each for one in inner for each in _fitting(one, beside)]
    return found


def _fitting(schema: Schema, keys: Mapping[str, str]) -> list[Schema]:
    """Return the alternatives of a schema that allow these keys and values; all of them if none does."""
    every = list(_alternatives(schema))
    return [each for each in every if _allows(each, keys)] or every


def _alternatives(schema: Schema) -> Iterator[Schema]:
    if "anyOf" not in schema:
        yield schema
    for each in schema.get("anyOf", ()):
        yield from _alternatives(each)


def _allows(schema: Schema, keys: Mapping[str, str]) -> bool:
    known = schema.get("properties", {})
    if keys and schema.get("type", "object") != "object":
        return False
    if schema.get("additionalProperties") is False and not keys.keys() <= known.keys():
        return False
    return all(
        value == known[key]["const"] for key, value in keys.items() if value and "const" in known.get(key, {})
    )


def _at_key(schemas: list[Schema], key: str) -> Iterator[Schema]:
    for schema in schemas:
        inner = schema.get("properties", {}).get(key, schema.get("additionalProperties"))
        if isinstance(inner, dict):
            yield inner


def _values(schema: Schema) -> Iterator[str]:
    """Yield the words that a value can be."""
    for each in _alternatives(schema):
        yield from map(str, each.get("enum", ()))
        if "const" in each:
            yield str(each["const"])
        if each.get("type") == "boolean":
            yield from ("true", "false")


def _is_section(schema: Schema) -> bool:
    """Return whether a value is written in the lines below its key."""
    return all(each.get("type") in ("object", "array") for each in _alternatives(schema))


def _about(schema: Schema) -> str:
    return str(schema.get("description", ""))


def _told(schema: Schema) -> str:
    values = ", ".join(f"`{each}`" for each in _values(schema))
    about = _about(schema)
    return about if about else f"one of {values}" if values else ""
