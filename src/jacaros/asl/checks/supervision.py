"""Check annotations of goals and labels that supervise: deadlines, attempts, periods and guard conditions.

>>> from jacaros.asl.loader import parse_plans
>>> [each.message for each in wrong_supervision((), ByKind(parse_plans("+!go <- !move[within(0)]")))]
['invalid `within`']
"""

from collections.abc import Callable, Iterator, Sequence
from typing import Final

from jacaros.asl import nodes
from jacaros.asl.checks.formulas import annotations_of, contradiction, labelled
from jacaros.asl.diagnostics import Diagnostic, problem
from jacaros.asl.walk import ByKind

_Check = Callable[[tuple[nodes.Term, ...]], bool]
_HELP: Final = {
    "within": "write a number of milliseconds, such as `within(5000)`",
    "hard_deadline": "write a number of milliseconds, such as `hard_deadline(5000)`",
    "every": "write a number of milliseconds, such as `every(1000)`",
    "retry": "write the number of retries and a delay in milliseconds, such as `retry(3)` or `retry(3, 500)`",
    "while": "write one condition, such as `while(battery(B) & B > 20)`",
    "cleanup": "write one goal, such as `cleanup(park)`",
}


def _number(term: nodes.Term, least: float) -> bool:
    """Return whether a term may be a number, at least *least*; computed values are known only at run time."""
    if isinstance(term, nodes.Number):
        return term.value >= least
    return isinstance(term, nodes.Variable | nodes.Arithmetic | nodes.FunctionCall)


def _is_time(arguments: tuple[nodes.Term, ...]) -> bool:
    """Return whether there is one positive number of milliseconds."""
    return len(arguments) == 1 and _number(arguments[0], 1e-9)


def _is_retry(arguments: tuple[nodes.Term, ...]) -> bool:
    """Return whether there is a number of retries, and optionally a delay."""
    if not 1 <= len(arguments) <= 2 or not _number(arguments[0], 1):
        return False
    count = arguments[0]
    whole = not isinstance(count, nodes.Number) or float(count.value).is_integer()
    return whole and (len(arguments) == 1 or _number(arguments[1], 0))


def _is_goal(arguments: tuple[nodes.Term, ...]) -> bool:
    return len(arguments) == 1 and isinstance(arguments[0], nodes.Literal | nodes.Variable)


_CHECKS: Final[dict[str, _Check]] = {
    **dict.fromkeys(("within", "hard_deadline", "every"), _is_time),
    "retry": _is_retry,
    "while": lambda arguments: len(arguments) == 1,
    "cleanup": _is_goal,
}
_OF_GOALS: Final = ("within", "hard_deadline", "every", "retry")
_OF_LABELS: Final = ("within", "while", "cleanup")
_MISPLACED: Final = {
    "goals": (("while",), "write it in the label of a plan: `@p[while(ready)] +!g <- ...`"),
    "test goals": (("within", "every", "retry"), "write it at a goal that asks: `!ask[within(5000)]`"),
    "plans": (("every", "retry", "hard_deadline"), "write it at the goal: `!g[{}]`"),
}
"""Annotations that have no effect on these, and where they belong."""


def wrong_supervision(goals: Sequence[nodes.Literal], found: ByKind) -> Iterator[Diagnostic]:
    """Warn of supervising annotations of goals and labels that have no effect."""
    for goal in (*goals, *(step.goal for step in found.of(nodes.Achieve))):
        yield from _wrong_of(annotations_of(goal), _OF_GOALS, "goals")
    for test in found.of(nodes.Test):
        yield from _wrong_of(annotations_of(test.formula), (), "test goals")
    for plan in found.of(nodes.Plan):
        yield from _wrong_of(labelled(plan), _OF_LABELS, "plans")


def _wrong_of(items: Sequence[nodes.Literal], valid: Sequence[str], where: str) -> Iterator[Diagnostic]:
    misplaced, help = _MISPLACED[where]
    for item in items:
        word = item.functor
        if word in valid and not _CHECKS[word](item.arguments):
            yield problem("wrong-supervision", f"invalid `{word}`", item.span, _HELP[word])
        elif word in valid and word == "while":
            yield from _never_true(item)
        elif word in misplaced and item.arguments:
            message = f"`{word}` has no effect on {where}"
            yield problem("wrong-supervision", message, item.span, help.format(_example(word)))


def _never_true(item: nodes.Literal) -> Iterator[Diagnostic]:
    why = contradiction(item.arguments[0])
    if why is not None:
        yield problem("context-never-true", f"this plan always fails: {why}", item.span)


def _example(word: str) -> str:
    return _HELP[word].rpartition("such as ")[2].partition(" or ")[0].strip("`")
