"""Check annotations ``needs(..)`` of labels and goals: needs that can never be met, and unknown policies.

>>> from jacaros.asl.loader import parse_plans
>>> plans = parse_plans("@go[needs(arm, arm)] +!go")
>>> [each.help for each in wrong_needs(ByKind(plans))]
['name `arm` once, or give its capacity: `arm(2)`']
"""

import re
from collections import Counter
from collections.abc import Iterator, Sequence
from itertools import chain

from jacaros.asl import nodes
from jacaros.asl.checks.formulas import annotations_of, labelled
from jacaros.asl.diagnostics import Diagnostic, problem
from jacaros.asl.walk import ByKind
from jacaros.suggestions import suggestion

_POLICIES = ("wait", "refuse", "take")
_NAME = re.compile(r"[A-Za-z_/][A-Za-z0-9_/]*")


def wrong_needs(found: ByKind) -> Iterator[Diagnostic]:
    """Warn of needs that no run can meet."""
    for items in _annotated(found):
        needs = [item for item in items if item.functor == "needs"]
        for need in needs:
            yield from _never_met(need)
        if needs:
            yield from _wrong_policies(items)


def needs_of(found: ByKind) -> Iterator[tuple[str, nodes.Literal]]:
    """Yield the names of resources that plans and goals need, each with its annotation."""
    for item in chain.from_iterable(_annotated(found)):
        for argument in item.arguments if item.functor == "needs" else ():
            name, _ = _read(argument)
            if name is not None:
                yield name, item


def _annotated(found: ByKind) -> Iterator[list[nodes.Literal]]:
    """Yield the annotations of labels and of goals."""
    yield from map(labelled, found.of(nodes.Plan))
    yield from (annotations_of(goal.goal) for goal in found.of(nodes.Achieve))


def _never_met(need: nodes.Literal) -> Iterator[Diagnostic]:
    units: Counter[str] = Counter()
    capacities: dict[str, int] = {}
    for argument in need.arguments:
        name, capacity = _read(argument)
        if name is None or (capacity is not None and capacity < 1):
            help = "write a name, `lift(2)` for a resource that two may use, or `map(shared)`"
            yield problem("wrong-needs", "expected a resource", need.span, help)
            return
        units[name] += 1
        if capacity is not None:
            capacities[name] = min(capacity, capacities.get(name, capacity))
    for name, wanted in units.items():
        there = capacities.get(name, 1)
        if wanted > there:
            are = "is 1" if there == 1 else f"are {there}"
            yield problem(
                "wrong-needs",
                f"needs that can never be met: {wanted} units of `{name}`, of which there {are}",
                need.span,
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
            help = suggestion(name, _POLICIES, f"write {', '.join(_POLICIES)}")
            yield problem("wrong-needs", f"unknown policy `{name}`", item.span, help)
