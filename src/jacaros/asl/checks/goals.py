"""Check for goals without a plan."""

import re
from collections.abc import Iterable, Iterator, Sequence
from functools import cache
from pathlib import Path
from typing import Final

from jacaros.asl import nodes
from jacaros.asl.checks.actions import KnownActions
from jacaros.asl.checks.formulas import labelled
from jacaros.asl.diagnostics import Diagnostic
from jacaros.asl.slips import MOST_ASKED
from jacaros.suggestions import close_matches, did_you_mean

_Signature = tuple[str | nodes.Variable | None, str, int]


def goals_without_plan(
    program: nodes.Program, found: Sequence[nodes.Node], known: KnownActions
) -> Iterator[Diagnostic]:
    """Warn of posted goals without a plan or ``-!`` handler.

    Programs with a plan for any goal (``+!G``) and programs that add plans are skipped; those with tests need no plans
    for assertions.
    """
    handled: set[_Signature] = set()
    everywhere: set[tuple[str, int]] = set()
    posted: list[nodes.Literal] = list(program.goals)
    for node in found:
        if isinstance(node, nodes.Trigger) and node.kind == "!":
            if isinstance(node.literal, nodes.Variable):
                return
            signature = _signature(node.literal)
            if isinstance(node.literal.namespace, nodes.Variable):
                everywhere.add(signature[1:])
            else:
                handled.add(signature)
        elif isinstance(node, nodes.Achieve) and isinstance(node.goal, nodes.Literal):
            posted.append(node.goal)
        elif isinstance(node, nodes.Plan):
            posted += _cleanups(node)
        elif isinstance(node, nodes.InternalAction):
            action = known.of(node)
            if action.brings_in and action.changes_plans:
                return
    if any(map(_is_test, program.plans)):
        everywhere |= _goals_of_tests()
    reported: set[_Signature] = set()
    for goal in posted:
        signature = _signature(goal)
        if signature in handled or signature in reported or isinstance(goal.namespace, nodes.Variable):
            continue
        if signature[1:] in everywhere:
            continue
        reported.add(signature)
        yield Diagnostic(
            "warning",
            f"no plan for `{_goal_text(signature)}`",
            goal.span,
            _meant_goal(signature, handled) if len(reported) <= MOST_ASKED else None,
            "unknown-goal",
        )


def _cleanups(plan: nodes.Plan) -> list[nodes.Literal]:
    """Return the clean-up goals of a plan: ``cleanup(Goal)`` in its label."""
    found = [each.arguments[0] for each in labelled(plan) if each.functor == "cleanup" and each.arguments]
    return [goal for goal in found if isinstance(goal, nodes.Literal)]


def _is_test(plan: nodes.Plan) -> bool:
    annotations = plan.label.annotations if isinstance(plan.label, nodes.Literal) else None
    items = annotations.items if annotations is not None else ()
    return any(isinstance(each, nodes.Literal) and each.functor == "test" for each in items)


_LIBRARY: Final = Path(__file__).parent.parent / "library"
_HEAD: Final = re.compile(r"^[+]!(\w+)(?:\(([^)]*)\))?", re.MULTILINE)


@cache
def _goals_of_tests() -> frozenset[tuple[str, int]]:
    """Return names and numbers of arguments of the goals that `jacaros test` gives to every agent."""
    texts = [
        (_LIBRARY / f"{name}.asl").read_text(encoding="utf-8") for name in ("test_assert", "test_performance")
    ]
    heads = [head for text in texts for head in _HEAD.findall(text)]
    return frozenset((name, arguments.count(",") + 1 if arguments else 0) for name, arguments in heads)


def _signature(literal: nodes.Literal) -> _Signature:
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
