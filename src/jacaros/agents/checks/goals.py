"""Check for goals without a plan.

>>> from jacaros.agents.language.loader import load_program
>>> program, _ = load_program("robot.asl", "!strat. +!start.")
>>> [each.help for each in goals_without_plan(program, ByKind(program.plans), KnownActions({}))]
['did you mean `!start`?']
"""

import re
from collections.abc import Iterable, Iterator
from functools import cache
from itertools import chain
from pathlib import Path
from typing import Final

from jacaros.agents.checks.actions import KnownActions
from jacaros.agents.checks.formulas import labelled
from jacaros.agents.language import nodes
from jacaros.agents.language.cursor import MOST_ASKED
from jacaros.agents.language.diagnostics import Diagnostic, problem
from jacaros.agents.language.nodes import ByKind
from jacaros.files.texts import close_matches, did_you_mean

_Signature = tuple[str | nodes.Variable | None, str, int]


def goals_without_plan(program: nodes.Program, found: ByKind, known: KnownActions) -> Iterator[Diagnostic]:
    """Warn of posted goals without a plan or ``-!`` handler.

    Programs with a plan for any goal (``+!G``) and programs that add plans are skipped; those with tests need no plans
    for assertions.
    """
    triggers = [trigger for trigger in found.of(nodes.Trigger) if trigger.kind == "!"]
    if any(isinstance(trigger.literal, nodes.Variable) for trigger in triggers) or any(
        known.of(call).brings_in and known.of(call).changes_plans for call in found.of(nodes.InternalAction)
    ):
        return
    signatures = [_signature(trigger.literal) for trigger in triggers]
    handled = {each for each in signatures if not isinstance(each[0], nodes.Variable)}
    everywhere = {each[1:] for each in signatures if isinstance(each[0], nodes.Variable)}
    posted: list[nodes.Node] = [*program.goals, *(step.goal for step in found.of(nodes.Achieve))]
    marks = list(chain.from_iterable(map(labelled, found.of(nodes.Plan))))
    posted += [mark.arguments[0] for mark in marks if mark.functor == "cleanup" and mark.arguments]
    if any(mark.functor == "test" for plan in program.plans for mark in labelled(plan)):
        everywhere |= _goals_of_tests()
    reported: set[_Signature] = set()
    for goal in posted:
        if not isinstance(goal, nodes.Literal) or isinstance(goal.namespace, nodes.Variable):
            continue
        signature = _signature(goal)
        if signature in handled or signature in reported or signature[1:] in everywhere:
            continue
        reported.add(signature)
        yield problem(
            "unknown-goal",
            f"no plan for `{_goal_text(signature)}`",
            goal.span,
            _meant_goal(signature, handled) if len(reported) <= MOST_ASKED else None,
        )


_LIBRARY: Final = Path(__file__).parent.parent / "language" / "library"
_HEAD: Final = re.compile(r"^[+]!(\w+)(?:\(([^)]*)\))?", re.MULTILINE)


@cache
def _goals_of_tests() -> frozenset[tuple[str, int]]:
    """Return names and numbers of arguments of the goals that `jacaros test` gives to every agent."""
    texts = [
        (_LIBRARY / f"{name}.asl").read_text(encoding="utf-8") for name in ("test_assert", "test_performance")
    ]
    heads = [head for text in texts for head in _HEAD.findall(text)]
    return frozenset((name, arguments.count(",") + 1 if arguments else 0) for name, arguments in heads)


def _signature(literal: nodes.Literal | nodes.Variable) -> _Signature:
    assert isinstance(literal, nodes.Literal)
    functor = f"~{literal.functor}" if literal.negated else literal.functor
    return (literal.namespace, functor, len(literal.arguments))


def _goal_text(signature: _Signature) -> str:
    namespace, functor, arity = signature
    written = "" if namespace is None else f"{str(namespace).partition('#')[0]}::"
    return f"!{written}{functor}/{arity}"


def _meant_goal(wanted: _Signature, handled: Iterable[_Signature]) -> str:
    """Return the goal with a plan that is most similar to *wanted*: of the same or of a similar name."""
    within = [
        each
        for each in handled
        if _is_reachable(each[0], wanted[0]) and _goal_text(each) != _goal_text(wanted)
    ]
    texts = sorted(_goal_text(signature) for signature in within)
    same_name = [_goal_text(signature) for signature in within if signature[1] == wanted[1]]
    close = sorted(same_name) or close_matches(_goal_text(wanted), texts)
    if not close:
        return f"write a plan for it: `+{_goal_text(wanted).rpartition('/')[0]}`"
    name, _, arity = close[0].rpartition("/")
    return did_you_mean([name if arity == str(wanted[2]) else close[0]])


def _is_reachable(namespace: str | nodes.Variable | None, own: str | nodes.Variable | None) -> bool:
    """Return whether a program can write the namespace: names of local ones have a '#', which cannot be written."""
    return not isinstance(namespace, str) or "#" not in namespace or namespace == own
