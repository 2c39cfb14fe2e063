"""Goals that are posted and that no plan is for."""

from collections.abc import Iterable, Iterator, Sequence
from typing import Final

from jacaros.asl import nodes
from jacaros.asl.diagnostics import Diagnostic
from jacaros.asl.spelling import close_matches

_ADDING_PLANS: Final = frozenset({".add_plan", ".include"})
_Signature = tuple[str | nodes.Variable | None, str, int]


def goals_without_plan(program: nodes.Program, found: Sequence[nodes.Node]) -> Iterator[Diagnostic]:
    """Goals that are posted and that no plan (nor ``-!`` handler) is for.

    Programs with plans for any goal (``+!G``) and programs that add plans are left alone.
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
        elif isinstance(node, nodes.InternalAction) and node.name in _ADDING_PLANS:
            return
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
            f"no plan for {_goal_text(signature)}",
            goal.span,
            _meant_goal(signature, handled),
            "unknown-goal",
        )


def _signature(literal: nodes.Literal) -> _Signature:
    functor = f"~{literal.functor}" if literal.negated else literal.functor
    return (literal.namespace, functor, len(literal.arguments))


def _goal_text(signature: _Signature) -> str:
    namespace, functor, arity = signature
    written = "" if namespace is None else f"{str(namespace).partition('#')[0]}::"
    return f"!{written}{functor}/{arity}"


def _meant_goal(wanted: _Signature, handled: Iterable[_Signature]) -> str:
    """The goal with a plan that is most like *wanted*: of the same name or of a like one."""
    within = [signature for signature in handled if _is_reachable(signature[0], wanted[0])]
    texts = sorted(_goal_text(signature) for signature in within)
    same_name = [_goal_text(signature) for signature in within if signature[1] == wanted[1]]
    close = sorted(same_name) or close_matches(_goal_text(wanted), texts)
    if not close:
        return f"write a plan for it: +{_goal_text(wanted).rpartition('/')[0]}"
    name, _, arity = close[0].rpartition("/")
    return f"did you mean {name if arity == str(wanted[2]) else close[0]}?"


def _is_reachable(namespace: str | nodes.Variable | None, own: str | nodes.Variable | None) -> bool:
    """Whether a program can write the namespace: local ones have a name with '#' that no other file can."""
    return not isinstance(namespace, str) or "#" not in namespace or namespace == own
