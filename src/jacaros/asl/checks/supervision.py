"""Check annotations of goals and labels that supervise: deadlines, attempts, periods and guard conditions."""

from collections.abc import Callable, Iterator, Sequence
from typing import Final

from jacaros.asl import nodes
from jacaros.asl.checks.formulas import contradiction, labelled
from jacaros.asl.diagnostics import Diagnostic

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


def _is_single(arguments: tuple[nodes.Term, ...]) -> bool:
    return len(arguments) == 1


def _is_goal(arguments: tuple[nodes.Term, ...]) -> bool:
    return len(arguments) == 1 and isinstance(arguments[0], nodes.Literal | nodes.Variable)


_OF_GOALS: Final[dict[str, _Check]] = {
    "within": _is_time,
    "hard_deadline": _is_time,
    "every": _is_time,
    "retry": _is_retry,
}
_OF_LABELS: Final[dict[str, _Check]] = {"within": _is_time, "while": _is_single, "cleanup": _is_goal}


def wrong_supervision(goals: Sequence[nodes.Literal], found: Sequence[nodes.Node]) -> Iterator[Diagnostic]:
    """Warn of supervising annotations of goals and labels that have no effect."""
    for goal in goals:
        yield from _of_goal(goal)
    for node in found:
        if isinstance(node, nodes.Achieve):
            yield from _of_goal(node.goal)
        elif isinstance(node, nodes.Test):
            yield from _of_test(node.formula)
        elif isinstance(node, nodes.Plan):
            yield from _of_label(node)


def _of_goal(goal: nodes.Term) -> Iterator[Diagnostic]:
    for item in _annotations(goal):
        if item.functor in _OF_GOALS:
            if not _OF_GOALS[item.functor](item.arguments):
                yield _invalid(item)
        elif item.functor == "while":
            yield _misplaced(item, "goals", "write it in the label of a plan: `@p[while(ready)] +!g <- ...`")


def _of_test(formula: nodes.Term) -> Iterator[Diagnostic]:
    for item in _annotations(formula):
        if item.functor in ("within", "every", "retry") and item.arguments:
            yield _misplaced(item, "test goals", "write it at a goal that asks: `!ask[within(5000)]`")


def _of_label(plan: nodes.Plan) -> Iterator[Diagnostic]:
    for item in labelled(plan):
        if item.functor in _OF_LABELS:
            if not _OF_LABELS[item.functor](item.arguments):
                yield _invalid(item)
            elif item.functor == "while":
                yield from _never_true(item)
        elif item.functor in ("every", "retry", "hard_deadline") and item.arguments:
            yield _misplaced(item, "plans", f"write it at the goal: `!g[{_example(item.functor)}]`")


def _never_true(item: nodes.Literal) -> Iterator[Diagnostic]:
    why = contradiction(item.arguments[0])
    if why is not None:
        yield Diagnostic("warning", f"this plan always fails: {why}", item.span, None, "context-never-true")


def _annotations(goal: nodes.Term) -> Iterator[nodes.Literal]:
    annotations = goal.annotations if isinstance(goal, nodes.Literal | nodes.Variable) else None
    for item in () if annotations is None else annotations.items:
        if isinstance(item, nodes.Literal):
            yield item


def _example(word: str) -> str:
    return _HELP[word].rpartition("such as ")[2].partition(" or ")[0].strip("`")


def _invalid(item: nodes.Literal) -> Diagnostic:
    return Diagnostic(
        "warning", f"invalid `{item.functor}`", item.span, _HELP[item.functor], "wrong-supervision"
    )


def _misplaced(item: nodes.Literal, where: str, help: str) -> Diagnostic:
    return Diagnostic(
        "warning", f"`{item.functor}` has no effect on {where}", item.span, help, "wrong-supervision"
    )
