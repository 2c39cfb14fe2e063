"""Warnings about programs that can be run but probably do not do what is meant."""

import re
from collections import Counter
from collections.abc import Callable, Collection, Iterable, Iterator
from difflib import get_close_matches
from typing import Final

from jacaros.asl import nodes
from jacaros.asl.diagnostics import Diagnostic
from jacaros.asl.walk import walk

_WORD: Final = re.compile(r"\b[A-Z]\w*")
_ADDING_PLANS: Final = frozenset({".add_plan", ".include"})
_Clause = nodes.Plan | nodes.Rule


def check(program: nodes.Program, known_internal_actions: Collection[str]) -> list[Diagnostic]:
    """Warnings about *program*, in the order of the text.

    They are about unknown internal actions, goals for which there is no plan, and variables that occur once.
    *known_internal_actions* are names with their dots, as ``.print``.
    """
    singletons = (warning for clause in _clauses(program) for warning in _singletons(clause))
    return sorted([*check_names(program, known_internal_actions), *singletons], key=_place)


def check_names(
    program: nodes.Program,
    known_internal_actions: Collection[str],
    hint: Callable[[str], str | None] | None = None,
) -> list[Diagnostic]:
    """The warnings of `check` that are nearly always mistakes: names of actions and goals that lead nowhere.

    *hint* may know more of an internal action that is not there than that another one has nearly its name.
    """
    unknown = _unknown_internal_actions(program, known_internal_actions, hint)
    found = [*unknown, *_goals_without_plan(program)]
    return sorted(found, key=_place)


def _place(diagnostic: Diagnostic) -> tuple[str, int, int]:
    span = diagnostic.span
    return ("", 0, 0) if span is None else (span.file.name, span.line, span.column)


def _clauses(program: nodes.Program) -> Iterator[_Clause]:
    yield from program.plans
    for belief in program.beliefs:
        if isinstance(belief, nodes.Rule):
            yield belief


# internal actions


def _unknown_internal_actions(
    program: nodes.Program, known: Collection[str], hint: Callable[[str], str | None] | None
) -> Iterator[Diagnostic]:
    functions = {function.implementation for function in program.functions}
    for node in walk(program.beliefs, program.plans):
        if not isinstance(node, nodes.InternalAction) or node.name in known or node.name in functions:
            continue
        if not node.name.startswith(".") and not node.arguments:
            # An atom with a dot, such as a class name.
            continue
        close = get_close_matches(node.name, known, 1)
        yield Diagnostic(
            "warning",
            f"there is no internal action {node.name}",
            node.span,
            (hint(node.name) if hint is not None else None)
            or (f"did you mean {close[0]}?" if close else None),
        )


# goals


def _goals_without_plan(program: nodes.Program) -> Iterator[Diagnostic]:
    """Goals that are posted and that no plan (nor ``-!`` handler) is for.

    Programs with plans for any goal (``+!G``) and programs that add plans are left alone.
    """
    handled: set[tuple[object, str, int]] = set()
    posted: list[nodes.Literal] = list(program.goals)
    for node in walk(program.beliefs, program.plans):
        if isinstance(node, nodes.Trigger) and node.kind == "!":
            if isinstance(node.literal, nodes.Variable):
                return
            handled.add(_signature(node.literal))
        elif isinstance(node, nodes.Achieve) and isinstance(node.goal, nodes.Literal):
            posted.append(node.goal)
        elif isinstance(node, nodes.InternalAction) and node.name in _ADDING_PLANS:
            return
    reported: set[tuple[object, str, int]] = set()
    for goal in posted:
        signature = _signature(goal)
        if signature in handled or signature in reported or isinstance(goal.namespace, nodes.Variable):
            continue
        reported.add(signature)
        yield Diagnostic(
            "warning", f"no plan for {_goal_text(signature)}", goal.span, _meant_goal(signature, handled)
        )


def _signature(literal: nodes.Literal) -> tuple[object, str, int]:
    functor = f"~{literal.functor}" if literal.negated else literal.functor
    return (literal.namespace, functor, len(literal.arguments))


def _goal_text(signature: tuple[object, str, int]) -> str:
    namespace, functor, arity = signature
    return f"!{f'{namespace}::' if namespace is not None else ''}{functor}/{arity}"


def _meant_goal(wanted: tuple[object, str, int], handled: Iterable[tuple[object, str, int]]) -> str | None:
    """The goal with a plan that is most like *wanted*: of the same name or of a like one."""
    texts = sorted(_goal_text(signature) for signature in handled)
    same_name = [_goal_text(signature) for signature in handled if signature[1] == wanted[1]]
    close = sorted(same_name) or get_close_matches(_goal_text(wanted), texts, 1)
    if not close:
        return None
    name, _, arity = close[0].rpartition("/")
    return f"did you mean {name if arity == str(wanted[2]) else close[0]}?"


# variables


def _singletons(clause: _Clause) -> Iterator[Diagnostic]:
    """Variables that occur once in *clause*.

    One that stands in a trigger (or in the head of a rule) may be there for the reader only: such a variable
    is no reason for a warning, but may be what was meant by another one.
    """
    occurrences: Counter[str] = Counter()
    first: dict[str, nodes.Variable] = {}
    in_texts: set[str] = set()
    for node in walk(clause):
        if isinstance(node, nodes.Variable) and not node.unnamed and not node.name.startswith("_"):
            occurrences[node.name] += 1
            first.setdefault(node.name, node)
        elif isinstance(node, nodes.String):
            # .puts and .term2string find variables in their texts.
            in_texts.update(_WORD.findall(node.value))
    triggers = [node for node in walk(clause) if isinstance(node, nodes.Trigger)]
    heads = triggers if isinstance(clause, nodes.Plan) else [clause.head]
    in_head = {node.name for node in walk(*heads) if isinstance(node, nodes.Variable)}
    once = [name for name, count in occurrences.items() if count == 1 and name not in in_texts]
    what = "plan" if isinstance(clause, nodes.Plan) else "rule"
    for name in once:
        if name in in_head:
            continue
        close = get_close_matches(name, (other for other in occurrences if other != name), 1, 0.7)
        hint = (
            f"did you mean {close[0]}? Otherwise write _{name}"
            if close
            else f"if that is meant write _{name}"
        )
        yield Diagnostic(
            "warning", f"the variable {name} occurs only once in this {what}", first[name].span, hint
        )
