"""Check the annotations of goals and labels that act: urgency, needs, deadlines, retries, periods and conditions.

>>> from jacaros.agents.language.loader import load_program
>>> program, _ = load_program("robot.asl", "@bump[urgent(10)] +bumped.")
>>> [each.help for each in wrong_labels(program, ByKind(program.plans))]
['did you mean `urgency(10)`?']
"""

import re
from collections.abc import Callable, Iterator, Mapping, Sequence
from itertools import chain
from typing import Final

from jacaros.agents.checks.formulas import annotations_of, contradiction, labelled
from jacaros.agents.language import nodes
from jacaros.agents.language.cursor import is_slip_of
from jacaros.agents.language.diagnostics import Diagnostic, problem
from jacaros.agents.language.lowering import format_term
from jacaros.agents.language.nodes import ByKind, replace
from jacaros.runtime.files.texts import did_you_mean, suggestion

_OF_PLANS: Final = ("atomic", "breakpoint", "all_unifs", "urgency", "needs", "policy")
"""Annotations that have a meaning in labels, besides those that supervise."""
_MEANT: Final = {
    other: word
    for word, others in {
        "atomic": "exclusive synchronized uninterruptible",
        "urgency": "urgent prio",
        "needs": "need require requires resource resources",
        "within": "deadline timeout time_out time_limit",
        "every": "period periodic interval",
        "retry": "retries attempts tries",
        "cleanup": "finally on_exit",
        "achieves": "achieve postcondition",
    }.items()
    for other in others.split()
}
"""Words that say what an annotation means, and the annotation."""
_OF_EVENTS: Final = {
    "sender": "source",
    "from": "source",
    "failure_reason": "env_failure_reason",
    "reason": "env_failure_reason",
    "error_message": "error_msg",
    "message": "error_msg",
}
_OF_ACTIONS: Final = {"artifact": "artifact_name", "workspace": "wsp"}
"""Other words for annotations of triggers and of actions."""
_ELSEWHERE: Final = {
    "label": "write it at the goal: `!g[{}]`",
    "goal": "write it in the label of a plan: `@p[{}] +!g <- ...`",
}
"""Where an annotation belongs that has no effect here."""
_READERS: Final = frozenset({".relevant_plans", ".list_plans", ".plan_label"})
"""Internal actions by which a program may read the annotations of its labels."""


def wrong_labels(program: nodes.Program, found: ByKind) -> Iterator[Diagnostic]:
    """Warn of annotations of labels and goals that have another name, and of an ``urgency`` that is not a number.

    An annotation that the program reads may have any name.
    """
    of_plans = [labelled(plan) for plan in found.of(nodes.Plan)]
    labels = list(chain.from_iterable(of_plans))
    tests = {
        id(item) for items in of_plans if any(each.functor == "test" for each in items) for item in items
    }
    goals = [*program.goals, *(step.goal for step in found.of(nodes.Achieve))]
    asked = list(chain.from_iterable(map(annotations_of, goals)))
    unlike = [
        *(_unlike(item, "label", (*_OF_PLANS, *_OF_LABELS)) for item in labels if id(item) not in tests),
        *(_unlike(item, "goal", (*_OF_GOALS, "needs", "policy")) for item in asked if item.arguments),
    ]
    events = [item for each in found.of(nodes.Trigger) for item in annotations_of(each.literal)]
    acts = [item for each in found.of(nodes.ExternalAction) for item in annotations_of(each.action)]
    others = [
        *(_other_word(item, "event", _OF_EVENTS) for item in events),
        *(_other_word(item, "action", _OF_ACTIONS) for item in acts),
    ]
    for found_here, written in ((unlike, [*labels, *asked]), (others, [*events, *acts])):
        reported = [each for each in found_here if each is not None]
        data = _read_by_program(found, written) if reported else set()
        if found_here is others:
            data |= {item.functor for item in asked}
        yield from (warning for item, warning in reported if item.functor not in data)
    for item in labels:
        if item.functor == "urgency" and not _is_urgency(item):
            yield problem(
                "wrong-urgency",
                "urgency must be a non-negative integer; this one has no effect",
                item.span,
                "write a number, such as `urgency(10)`; the greatest goes first",
            )


def _unlike(item: nodes.Literal, what: str, words: Sequence[str]) -> tuple[nodes.Literal, Diagnostic] | None:
    """Return a warning if an annotation is nearly one of *words*, or another word for one of them."""
    name = item.functor
    meant = _MEANT.get(name) if item.arguments else None
    word = next((each for each in words if is_slip_of(name, each)), meant)
    if word is None or name in words:
        return None
    written = format_term(replace(item, functor=word))
    help = did_you_mean([written]) if word in words else _ELSEWHERE[what].format(written)
    message = f"{what} annotation `{name}` has no meaning"
    return item, problem("misspelt-annotation", message, item.span, help)


def _other_word(
    item: nodes.Literal, what: str, words: Mapping[str, str]
) -> tuple[nodes.Literal, Diagnostic] | None:
    if item.functor not in words or len(item.arguments) != 1:
        return None
    meant = format_term(replace(item, functor=words[item.functor]))
    message = f"no {what} has the annotation `{item.functor}`"
    return item, problem("misspelt-annotation", message, item.span, did_you_mean([meant]))


def _read_by_program(found: ByKind, annotations: Sequence[nodes.Literal]) -> set[str]:
    """Return the names of annotations that a program may read: those that appear in it in other places."""
    written = set(map(id, annotations))
    if any(call.name in _READERS for call in found.of(nodes.InternalAction)) or any(
        rule.head.functor == "select__option" for rule in found.of(nodes.Rule)
    ):
        return {item.functor for item in annotations}
    return {each.functor for each in found.of(nodes.Literal) if id(each) not in written}


def _is_urgency(item: nodes.Literal) -> bool:
    if len(item.arguments) != 1:
        return False
    argument = item.arguments[0]
    if isinstance(argument, nodes.Number):
        return argument.value >= 0 and float(argument.value).is_integer()
    # Its value is known only at run time.
    return isinstance(argument, nodes.Arithmetic)


# Check annotations of goals and labels that supervise: deadlines, attempts, periods and conditions.


_Check = Callable[[tuple[nodes.Term, ...]], bool]
_HELP: Final = {
    "within": "write a number of milliseconds, such as `within(5000)`",
    "hard_deadline": "write a number of milliseconds, such as `hard_deadline(5000)`",
    "every": "write a number of milliseconds, such as `every(1000)`",
    "retry": "write the number of retries and a delay in milliseconds, such as `retry(3)` or `retry(3, 500)`",
    "while": "write one condition, such as `while(battery(B) & B > 20)`",
    "cleanup": "write one goal, such as `cleanup(park)`",
    "achieves": "write a condition and a time in milliseconds, such as `achieves(docked(true))` or "
    "`achieves(docked(true), 2000)`",
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


def _is_achieved(arguments: tuple[nodes.Term, ...]) -> bool:
    """Return whether there is a condition, and optionally a time."""
    value = nodes.Number | nodes.String | nodes.ListTerm
    return (
        1 <= len(arguments) <= 2
        and not isinstance(arguments[0], value)
        and all(_number(time, 0) for time in arguments[1:])
    )


_CHECKS: Final[dict[str, _Check]] = {
    **dict.fromkeys(("within", "hard_deadline", "every"), _is_time),
    "retry": _is_retry,
    "while": lambda arguments: len(arguments) == 1,
    "cleanup": _is_goal,
    "achieves": _is_achieved,
}
_OF_GOALS: Final = ("within", "hard_deadline", "every", "retry", "achieves")
_OF_LABELS: Final = ("within", "while", "cleanup", "achieves")
_MISPLACED: Final = {
    "goals": (("while", "cleanup"), _ELSEWHERE["goal"]),
    "test goals": (
        ("within", "every", "retry", "achieves"),
        "write it at a goal that asks: `!ask[within(5000)]`",
    ),
    "plans": (("every", "retry", "hard_deadline"), _ELSEWHERE["label"]),
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
        elif word in valid and word in ("while", "achieves"):
            yield from _never_true(item, where)
        elif word in misplaced and item.arguments:
            message = f"`{word}` has no effect on {where}"
            yield problem("wrong-supervision", message, item.span, help.format(format_term(item)))


def _never_true(item: nodes.Literal, where: str) -> Iterator[Diagnostic]:
    why = contradiction(item.arguments[0])
    if why is not None:
        yield problem("context-never-true", f"this {where[:-1]} always fails: {why}", item.span)


# Check annotations ``needs(..)`` of labels and goals: needs that can never be met, and unknown policies.


_POLICIES = ("wait", "refuse")
_NAME = re.compile(r"[A-Za-z_/][A-Za-z0-9_/]*")


def wrong_needs(found: ByKind) -> Iterator[Diagnostic]:
    """Warn of needs that no run can meet."""
    for items in _annotated(found):
        needs = [item for item in items if item.functor == "needs"]
        for need in needs:
            if None in map(_resource, need.arguments):
                help = "write names, such as `wheels`"
                yield problem("wrong-needs", "expected a resource", need.span, help)
        if needs:
            yield from _wrong_policies(items)


def needs_of(found: ByKind) -> Iterator[tuple[str, nodes.Literal]]:
    """Yield the names of resources that plans and goals need, each with its annotation."""
    for item in chain.from_iterable(_annotated(found)):
        for argument in item.arguments if item.functor == "needs" else ():
            name = _resource(argument)
            if name is not None:
                yield name, item


def _annotated(found: ByKind) -> Iterator[list[nodes.Literal]]:
    yield from map(labelled, found.of(nodes.Plan))
    yield from (annotations_of(goal.goal) for goal in found.of(nodes.Achieve))


def _resource(argument: nodes.Node) -> str | None:
    """Return the name of a resource; None if the argument is not one."""
    if isinstance(argument, nodes.String):
        return argument.value if _NAME.fullmatch(argument.value) else None
    if isinstance(argument, nodes.Literal) and not argument.negated and not argument.arguments:
        return argument.functor
    return None


def _wrong_policies(items: Sequence[nodes.Literal]) -> Iterator[Diagnostic]:
    for item in items:
        if item.functor != "policy":
            continue
        given = item.arguments[0] if len(item.arguments) == 1 else None
        name = given.functor if isinstance(given, nodes.Literal) and not given.arguments else ""
        if name not in _POLICIES:
            help = suggestion(name, _POLICIES, f"write {', '.join(_POLICIES)}")
            yield problem("wrong-needs", f"unknown policy `{name}`", item.span, help)
