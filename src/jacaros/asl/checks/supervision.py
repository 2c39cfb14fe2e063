"""Check annotations of goals and labels that supervise: deadlines, attempts, periods and guard conditions."""

from collections.abc import Callable, Iterable, Iterator, Sequence
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


_TEST_HELP: Final = "write it at a goal that asks: `!ask[within(5000)]`"
_GOAL_HELP: Final = "write it in the label of a plan: `@p[while(ready)] +!g <- ...`"


def wrong_supervision(goals: Sequence[nodes.Literal], found: Sequence[nodes.Node]) -> Iterator[Diagnostic]:
    """Warn of supervising annotations of goals and labels that have no effect."""
    for goal in (*goals, *(node.goal for node in found if isinstance(node, nodes.Achieve))):
        yield from _wrong(_annotations(goal), "goals", _OF_GOALS, {"while": _GOAL_HELP})
    for node in found:
        if isinstance(node, nodes.Test):
            others: dict[str, str] = dict.fromkeys(("within", "every", "retry"), _TEST_HELP)
            yield from _wrong(_annotations(node.formula), "test goals", {}, others)
        elif isinstance(node, nodes.Plan):
            others = {word: _example(word) for word in _OF_GOALS if word not in _OF_LABELS}
            yield from _wrong(labelled(node), "plans", _OF_LABELS, others)


def _wrong(
    annotations: Iterable[nodes.Literal], where: str, checks: dict[str, _Check], others: dict[str, str]
) -> Iterator[Diagnostic]:
    """Warn of annotations with invalid arguments, and of *others* that have no effect there, with their help."""
    for item in annotations:
        word, code = item.functor, "wrong-supervision"
        if word in checks and not checks[word](item.arguments):
            yield Diagnostic("warning", f"invalid `{word}`", item.span, _HELP[word], code)
        elif word in others and (item.arguments or word == "while"):
            yield Diagnostic("warning", f"`{word}` has no effect on {where}", item.span, others[word], code)
        elif word == "while" and word in checks and (why := contradiction(item.arguments[0])) is not None:
            told = f"this plan always fails: {why}"
            yield Diagnostic("warning", told, item.span, None, "context-never-true")


def _annotations(goal: nodes.Node) -> Iterator[nodes.Literal]:
    annotations = goal.annotations if isinstance(goal, nodes.Literal | nodes.Variable) else None
    for item in () if annotations is None else annotations.items:
        if isinstance(item, nodes.Literal):
            yield item


def _example(word: str) -> str:
    """Return where to write an annotation of goals, with an example."""
    example = _HELP[word].rpartition("such as ")[2].partition(" or ")[0].strip("`")
    return f"write it at the goal: `!g[{example}]`"
