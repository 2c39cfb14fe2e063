"""Read ``derived``: events composed of those of other properties and signals of the file."""

from collections.abc import Iterator

from jacaros.artifacts.mapping.declared import ArtifactPart, DerivedPart, Place, TopicPart, Written
from jacaros.artifacts.mapping.read_fields import place_of
from jacaros.artifacts.mapping.read_names import belief_name
from jacaros.artifacts.mapping.read_topics import plain_constant
from jacaros.artifacts.streams.pattern import LONGEST, OPERATORS, PARTNERS_WAIT, Fault, Spec, faults, unknown
from jacaros.files.texts import suggestion
from jacaros.files.yaml import Node, Problem

_COMMON = ("value", "lateness", "description")
_EVENTS = frozenset({"count", "absent"})
"""Operators that use only the events, not their values, so each element of an array may be one."""
_EXAMPLE = "write one, such as {count: bump, within: 5, at_least: 3}"


def read_derived(name: Node, node: Node) -> DerivedPart:
    """Read one derived property."""
    place = place_of(name)
    if not isinstance(node.value, dict):
        node.wrong(f"`{name.value}` has no operator", _EXAMPLE)
        return DerivedPart(belief_name(name), place, None, ())
    entries = node.mapping()
    operator = _operator(name, node, entries)
    if operator is None:
        return DerivedPart(belief_name(name), place, None, ())
    sources = _sources(entries[operator], operator == "together")
    options = {key: _option(key, each) for key, each in entries.items() if key not in (operator, *_COMMON)}
    wrong = list(faults(operator, [each.text for each in sources], options))
    for fault in wrong:
        _report(fault, entries, node)
    if "value" in entries and not OPERATORS[operator].valued:
        entries["value"].wrong(f"`{operator}` does not use values", "leave `value` out")
    if "lateness" in entries and operator != "together":
        entries["lateness"].wrong(
            f"`{operator}` waits for nothing", "leave `lateness` out: delayed messages count"
        )
    spec = Spec(
        operator,
        tuple(each.text for each in sources),
        options,
        entries["value"].whole(1, 1) - 1 if "value" in entries else 0,
        _lateness(entries, operator),
    )
    told = entries["description"].text() if "description" in entries else ""
    return DerivedPart(belief_name(name), place, None if wrong else spec, sources, told)


def _lateness(entries: dict[str, Node], operator: str) -> float:
    if "lateness" in entries:
        return entries["lateness"].number(0.0, LONGEST)
    return PARTNERS_WAIT if operator == "together" else 0.0


def _operator(name: Node, node: Node, entries: dict[str, Node]) -> str | None:
    """Return the operator of an entry; None after reporting a mistake."""
    named = [key for key in entries if key in OPERATORS]
    if len(named) == 1:
        return named[0]
    if len(named) > 1:
        entries[named[1]].wrong(
            f"`{named[0]}` and `{named[1]}` are alternatives", "derive one name for each operator"
        )
    elif entries:
        first = next(iter(entries))
        fault = unknown(first)
        help_ = fault.help if fault.help.startswith("did") else f"{_EXAMPLE}; {fault.help}"
        _at_key(node, first).wrong(f"`{name.value}` has no operator", help_)
    else:
        name.wrong(f"`{name.value}` has no operator", _EXAMPLE)
    return None


def _sources(node: Node, several: bool) -> tuple[Written, ...]:
    if not several:
        return (Written(node.text(), place_of(node)),)
    if not isinstance(node.value, list):
        return (Written(node.text(), place_of(node)),)
    return tuple(Written(item.text(), place_of(item)) for item in node.sequence())


def _option(key: str, node: Node) -> object:
    """Read the value of an option in the form that the schema checks."""
    if key == "equals":
        return plain_constant(node)
    return node.value


def _report(fault: Fault, entries: dict[str, Node], node: Node) -> None:
    if fault.option in entries and fault.message.endswith(f"has no option `{fault.option}`"):
        _at_key(node, fault.option).wrong(fault.message, fault.help)
    else:
        entries.get(fault.option, node).wrong(fault.message, fault.help)


def _at_key(node: Node, key: str) -> Node:
    """Return the position of a key of a mapping."""
    return next((name for name, _ in node.entries() if str(name.value) == key), node)


def derived_problems(part: ArtifactPart) -> Iterator[Problem]:
    """Yield streams that the artifact does not have, or that an operator cannot use."""
    topics: dict[str, TopicPart] = {each.name: each for each in part.topics}
    known = [*topics, *(each.name for each in part.frames)]
    for derived in part.derived:
        for source in derived.sources:
            if source.text and source.text not in known:
                yield _unknown_stream(source, known)
            elif (topic := topics.get(source.text)) is not None and derived.spec is not None:
                yield from _unfit(derived.spec, topic, source.place)
        known.append(derived.name)


def _unknown_stream(source: Written, known: list[str]) -> Problem:
    listed = f"properties, signals, frames and entries above this one: {', '.join(known) or 'none'}"
    return source.place.problem(f"unknown property `{source.text}`", suggestion(source.text, known, listed))


def _unfit(spec: Spec, topic: TopicPart, place: Place) -> Iterator[Problem]:
    if topic.each is not None and spec.operator not in _EVENTS:
        yield place.problem(
            f"`{topic.name}` is one property for each element, but `{spec.operator}` needs a single one",
            f"use one of {', '.join(sorted(_EVENTS))}, or a property without `each`",
        )
    needed = spec.place + 1
    if OPERATORS[spec.operator].valued and topic.fields is not None:
        count = sum(field.count for field in topic.fields)
        if count < needed:
            yield place.problem(f"`{topic.name}` has {count} values, not {needed}", "write a smaller `value`")
