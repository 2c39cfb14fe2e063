"""The generated code of a program as readable text: each piece below the lines of the program that it comes from."""

import re
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

from jacaros.asl import nodes
from jacaros.bdi.actions.internal_action import InternalAction
from jacaros.bdi.fast.generated.building import functor_of_literal
from jacaros.bdi.fast.generated.predicates import compile_search
from jacaros.bdi.fast.generated.unit import CodeUnit, write_select
from jacaros.bdi.fast.generated.writer import Writer
from jacaros.bdi.state.plan import Plan
from jacaros.bdi.state.triggers import Trigger, trigger
from jacaros.terms.text import text as text_of
from jacaros.terms.values import Functor, functor

_ANYTHING = functor("anything", 0)
"""Stands for the literal of an event where a plan is a candidate for all of them."""
_CONSTANT = re.compile(r"\bK_\w+")


@dataclass(frozen=True)
class Piece:
    """The code of one event kind, or of the rules of one predicate; it has not been executed.

    Attributes:
        title: what it is for.
        unit: holds it.
        plans: those that it chooses among.
    """

    title: str
    unit: CodeUnit
    plans: Sequence[Plan] = field(default_factory=list)


def pieces(
    plans: Sequence[Plan], rules: Iterable[nodes.Rule], actions: Mapping[str, InternalAction]
) -> Iterator[Piece]:
    """All code that is made of a program, in the order of the program; of a predicate, what answers when nothing is given.

    An agent makes each piece when it first needs it.
    """
    by_predicate: dict[Functor, list[nodes.Rule]] = {}
    for rule in rules:
        by_predicate.setdefault(functor_of_literal(rule.head), []).append(rule)
    for symbol, own in by_predicate.items():
        span = own[0].span
        unit = CodeUnit("<run time>" if span is None else span.file.name, actions)
        compile_search(unit, symbol, 0, (), own, False)
        yield Piece(f"the rules of {symbol!r}", unit)
    yield from _of_plans(plans, actions, None)


def _of_plans(
    plans: Sequence[Plan], actions: Mapping[str, InternalAction], outer: Plan | None
) -> Iterator[Piece]:
    for kind in dict.fromkeys(_kind_of(plan) for plan in plans):
        own = [plan for plan in plans if _kind_of(plan) is kind or _is_candidate_too(plan, kind)]
        if all(plan.has_variable_trigger() for plan in own) and kind.functor is not _ANYTHING:
            continue
        title = f"the plans for {_name(kind)}" + ("" if outer is None else f" in {text_of(outer.label)}")
        yield Piece(title, write_select(kind, own, actions, outer).unit, own)
        for plan in own:
            if plan.subplans and _kind_of(plan) is kind:
                yield from _of_plans(plan.subplans, actions, plan)


def _kind_of(plan: Plan) -> Trigger:
    head = plan.node.trigger
    return trigger(head.operator, head.kind, plan.trigger_functor() or _ANYTHING)


def _is_candidate_too(plan: Plan, kind: Trigger) -> bool:
    head = plan.node.trigger
    return plan.has_variable_trigger() and (head.operator, head.kind) == (kind.operator, kind.kind)


def _name(kind: Trigger) -> str:
    return f"{kind.operator}{kind.kind}" + (
        "any literal" if kind.functor is _ANYTHING else repr(kind.functor)
    )


def listing(piece: Piece, only: Plan | None = None) -> str:
    """The text of a piece.

    Args:
        piece: what to show.
        only: leave out the steps of all other plans.
    """
    shown = [writer for writer in piece.unit.writers if only is None or _concerns(writer, piece, only)]
    text = "\n".join("\n".join(_beside(writer)) + "\n" for writer in shown)
    names = dict.fromkeys(_CONSTANT.findall(text))
    constants = "".join(f"# {name}: {_described(piece.unit.globals[name])}\n" for name in names)
    return f"# ---- {piece.title} ----\n{constants}\n{text}"


def _described(value: Any) -> str:
    """Describe a constant without memory addresses, so that two listings of a program are equal."""
    if isinstance(value, Plan):
        return f"the plan {text_of(value.label)}"
    if isinstance(value, (Functor, Trigger)):
        return repr(value)
    if isinstance(value, InternalAction):
        return f"the internal action {value.name}"
    if callable(value):
        return f"{value.__module__}.{value.__qualname__}"
    if value.__class__ is tuple and not (value and isinstance(value[0], Functor)):
        return repr(value)  # places of arguments, by which an index finds rows
    return text_of(value)


def _beside(writer: Writer) -> Iterator[str]:
    """The lines of a function, each below the line of the program that it comes from, where that is another one."""
    last = None
    for line, file, number in zip(writer.lines, writer.files, writer.origins, strict=True):
        if file is not None and last != (file, number):
            last = (file, number)
            indentation = line[: len(line) - len(line.lstrip())]
            yield f"{indentation}# {file.name}:{number}: {file.lines[number - 1].strip()}"
        yield line


def _concerns(writer: Writer, piece: Piece, plan: Plan) -> bool:
    """Whether a function belongs to a plan, or chooses among all plans of its piece."""
    span = plan.node.span
    if writer is piece.unit.writers[-1] or writer.lines[0].startswith("def select") or span is None:
        return True
    return writer.files[0] == span.file and span.line <= writer.origins[0] <= span.end_line
