"""Check annotations ``needs(..)`` of labels and goals: needs that can never be met, and unknown policies."""

import re
from collections import Counter
from collections.abc import Iterator, Sequence

from jacaros.asl import nodes
from jacaros.asl.diagnostics import Diagnostic
from jacaros.suggestions import suggestion

_POLICIES = ("wait", "refuse", "take")
_NAME = re.compile(r"[A-Za-z_/][A-Za-z0-9_/]*")


def wrong_needs(found: Sequence[nodes.Node]) -> Iterator[Diagnostic]:
    """Warn of needs that no run can meet."""
    for items in _annotated(found):
        needs = [item for item in items if item.functor == "needs"]
        for need in needs:
            yield from _never_met(need)
        if needs:
            yield from _wrong_policies(items)


def needs_of(found: Sequence[nodes.Node]) -> Iterator[tuple[str, nodes.Literal]]:
    """Yield the names of resources that plans and goals need, each with its annotation."""
    for items in _annotated(found):
        for item in items:
            if item.functor == "needs":
                for argument in item.arguments:
                    name, _ = _read(argument)
                    if name is not None:
                        yield name, item


def _annotated(found: Sequence[nodes.Node]) -> Iterator[list[nodes.Literal]]:
    """Yield the annotations of labels and of goals."""
    for node in found:
        if isinstance(node, nodes.Plan):
            owner: object = node.label
        elif isinstance(node, nodes.Achieve):
            owner = node.goal
        else:
            continue
        if isinstance(owner, nodes.Literal) and owner.annotations is not None:
            yield [item for item in owner.annotations.items if isinstance(item, nodes.Literal)]


def _never_met(need: nodes.Literal) -> Iterator[Diagnostic]:
    units: Counter[str] = Counter()
    capacities: dict[str, int] = {}
    for argument in need.arguments:
        name, capacity = _read(argument)
        if name is None or (capacity is not None and capacity < 1):
            yield _wrong(
                need,
                "expected a resource",
                "write a name, `lift(2)` for a resource that two may use, or `map(shared)`",
            )
            return
        units[name] += 1
        if capacity is not None:
            capacities[name] = min(capacity, capacities.get(name, capacity))
    for name, wanted in units.items():
        there = capacities.get(name, 1)
        if wanted > there:
            are = "is 1" if there == 1 else f"are {there}"
            yield _wrong(
                need,
                f"needs that can never be met: {wanted} units of `{name}`, of which there {are}",
                f"name `{name}` once, or give its capacity: `{name}({wanted})`",
            )


def _read(argument: nodes.Node) -> tuple[str | None, int | None]:
    """Return the name and capacity of a resource; None for a name that is invalid or a capacity that is not given."""
    if isinstance(argument, nodes.String):
        return (argument.value if _NAME.fullmatch(argument.value) else None), None
    if not isinstance(argument, nodes.Literal) or argument.negated:
        return None, None
    if not argument.arguments:
        return argument.functor, None
    inner = argument.arguments[0]
    if len(argument.arguments) == 1 and isinstance(inner, nodes.Number) and float(inner.value).is_integer():
        return argument.functor, int(inner.value)
    if len(argument.arguments) == 1 and isinstance(inner, nodes.Literal) and inner.functor == "shared":
        return argument.functor, 1_000_000
    return None, None


def _wrong_policies(items: Sequence[nodes.Literal]) -> Iterator[Diagnostic]:
    for item in items:
        if item.functor != "policy":
            continue
        given = item.arguments[0] if len(item.arguments) == 1 else None
        name = given.functor if isinstance(given, nodes.Literal) and not given.arguments else ""
        if name not in _POLICIES:
            yield _wrong(
                item,
                f"unknown policy `{name}`",
                suggestion(name, _POLICIES, f"write {', '.join(_POLICIES)}"),
            )


def _wrong(item: nodes.Literal, message: str, help: str) -> Diagnostic:
    return Diagnostic("warning", message, item.span, help, "wrong-needs")
