"""Check for goals without a plan, and for actions that are unknown or called wrongly.

>>> from jacaros.agents.language.loader import load_program
>>> program, _ = load_program("robot.asl", "!strat. +!start.")
>>> [each.help for each in goals_without_plan(program, ByKind(program.plans), KnownActions({}))]
['did you mean `!start`?']
"""

import re
from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import dataclass, replace
from functools import cache
from itertools import chain
from pathlib import Path
from typing import Final

from jacaros.agents.checks.formulas import CONDITIONED, conditions, indicator_of, labelled
from jacaros.agents.language import nodes
from jacaros.agents.language.cursor import MOST_ASKED, is_slip_of
from jacaros.agents.language.diagnostics import Diagnostic, Span, fix, problem
from jacaros.agents.language.nodes import UNDECLARED, ByKind, Declaration, parts_of
from jacaros.agents.language.term_parser import PERFORMATIVES
from jacaros.agents.terms.functions import ARITIES
from jacaros.runtime.files.texts import close_matches, did_you_mean, suggestion

# Check internal actions: names, numbers of arguments, and where they are used.


@dataclass(frozen=True)
class KnownActions:
    """The internal actions that a program may use.

    Attributes:
        declared: by name; those of the language have a leading dot.
        help: suggested fix for an unknown name, if there is one.
        is_unseen: whether a name may become known when the project's Python code runs.
    """

    declared: Mapping[str, Declaration]
    help: Callable[[str], str | None] = lambda _: None
    is_unseen: Callable[[str], bool] = lambda _: False

    def of(self, call: nodes.InternalAction) -> Declaration:
        """Return the declaration of the called action."""
        return self.declared.get(call.name, UNDECLARED)


def unknown_actions(program: nodes.Program, found: ByKind, known: KnownActions) -> Iterator[Diagnostic]:
    """Warn of unknown internal actions."""
    own = {name for function in program.functions for name in (function.implementation, function.name)}
    hints: dict[str, str | None] = {}
    for node in found.of(nodes.InternalAction):
        name = node.name
        if name in known.declared or name in own:
            continue
        if name in ARITIES:
            least, most = ARITIES[name]
            yield _arguments_message(node, least, None if most == float("inf") else int(most), "function")
            continue
        is_atom = not name.startswith(".") and not node.arguments  # such as the name of a class
        if is_atom or known.is_unseen(name):
            continue
        if name not in hints:
            hints[name] = _meant_action(node, found, known) or None if len(hints) < MOST_ASKED else None
        yield problem("unknown-internal-action", f"unknown internal action `{name}`", node.span, hints[name])


def _meant_action(call: nodes.InternalAction, found: ByKind, known: KnownActions) -> str:
    goal = "!", (call.name.removeprefix("."), len(call.arguments))
    for trigger in found.of(nodes.Trigger):
        if (trigger.kind, indicator_of(trigger.literal)) == goal:
            return did_you_mean([f"!{goal[1][0]}"])
    return known.help(call.name) or suggestion(call.name, known.declared)


ON_GOALS: Final = frozenset(
    {".desire", ".drop_desire", ".drop_event", ".drop_future_intention", ".drop_intention", ".fail_goal"}
    | {".intend", ".resume", ".succeed_goal", ".suspend", ".suspended"}
)
"""Internal actions whose first argument is a goal."""


def wrong_arguments(found: ByKind, known: KnownActions) -> Iterator[Diagnostic]:
    """Warn of internal actions with too few or too many arguments, and of texts for goals."""
    for node in found.of(nodes.InternalAction):
        action = known.declared.get(node.name)
        count = len(node.arguments)
        first = node.arguments[0] if node.arguments else None
        if node.name in ON_GOALS and isinstance(first, nodes.String):
            message = f'`{node.name}` expects a goal, found the string `"{first.value}"`'
            yield problem("wrong-arguments", message, first.span, f"write `{first.value}` without quotes")
        if action is not None and not action.takes(count):
            wrong = _arguments_message(node, action.minimum, action.maximum, "internal action")
            if action.maximum is not None and count == action.maximum + 1 and action.result_hint:
                wrong = replace(wrong, help=action.result_hint)
            yield wrong


def _arguments_message(node: nodes.InternalAction, least: int, most: int | None, what: str) -> Diagnostic:
    if most is None:
        wanted = f"at least {_arguments(least)}"
    elif least == most:
        wanted = _arguments(least)
    else:
        wanted = f"{least} to {most} arguments"
    return problem(
        "wrong-arguments",
        f"{what} `{node.name}` expects {wanted}, found {len(node.arguments) or 'none'}",
        node.span,
    )


def _arguments(count: int) -> str:
    return f"{count or 'no'} argument{'' if count == 1 else 's'}"


def acting_conditions(found: ByKind, known: KnownActions) -> Iterator[Diagnostic]:
    """Warn of internal actions that act or wait and are used as conditions."""
    for node in found.of(*CONDITIONED):
        for formula in conditions(node):
            for part in parts_of(formula):
                if isinstance(part, nodes.InternalAction) and known.of(part).suspends:
                    message = f"`{part.name}` acts or takes time and never holds as a condition"
                    yield problem("acting-condition", message, part.span, "make it a step of the body")


PRINTING: Final = frozenset({".print", ".println", ".printf"})
"""Internal actions that only print."""
_SHORT: Final = 10
"""Milliseconds: a shorter `.wait` was probably meant in seconds."""


def doubtful_values(found: ByKind) -> Iterator[Diagnostic]:
    """Note waits that are probably meant in seconds, and atoms that are probably meant as texts."""
    for node in found.of(nodes.InternalAction):
        first = node.arguments[0] if node.arguments else None
        if node.name == ".wait" and isinstance(first, nodes.Number) and 0 < first.value < _SHORT:
            time = f"{first.value:g}"
            help = f"for {time} s write `.wait({first.value * 1000:g})`"
            yield problem("short-wait", f"`.wait({time})` waits for {time} ms", first.span, help)
        for word in node.arguments if node.name in PRINTING else ():
            if isinstance(word, nodes.Literal) and word.functor.startswith("'") and not word.arguments:
                text = word.functor.strip("'")
                message = f"`{word.functor}` is an atom, which is printed with its quotes"
                yield problem("quoted-atom", message, word.span, f'write a text as `"{text}"`')


def unknown_performatives(found: ByKind, known: KnownActions) -> Iterator[Diagnostic]:
    """Warn of misspelt performatives; a word that is not similar to one may be the program's own."""
    for node in found.of(nodes.InternalAction):
        place = known.of(node).performative
        if place is None or len(node.arguments) <= place:
            continue
        word = node.arguments[place]
        if not isinstance(word, nodes.Literal) or word.arguments or word.functor in PERFORMATIVES:
            continue
        meant = [each for each in PERFORMATIVES if is_slip_of(word.functor.lower(), each.lower())]
        meant += [each for each in PERFORMATIVES if word.functor.lower() == each.lower()]
        if meant:
            message = f"unknown performative `{word.functor}`"
            yield problem("unknown-performative", message, word.span, did_you_mean(meant[:1]))


Signature = tuple[str | nodes.Variable | None, str, int]
"""Namespace, name and number of arguments."""


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
    signatures = [signature(trigger.literal) for trigger in triggers]
    handled = {each for each in signatures if not isinstance(each[0], nodes.Variable)}
    everywhere = {each[1:] for each in signatures if isinstance(each[0], nodes.Variable)}
    posted: list[nodes.Node] = [*program.goals, *program.offered_goals]
    posted += [step.goal for step in found.of(nodes.Achieve)]
    marks = list(chain.from_iterable(map(labelled, found.of(nodes.Plan))))
    posted += [mark.arguments[0] for mark in marks if mark.functor == "cleanup" and mark.arguments]
    if any(mark.functor == "test" for plan in program.plans for mark in labelled(plan)):
        everywhere |= _goals_of_tests()
    with_plan = {signature(each.literal) for each in triggers if each.operator != "-"}
    # With a plan of that name for other arguments, one that only handles its failure is not enough.
    handled -= {each for each in handled - with_plan if any(each[:2] == other[:2] for other in with_plan)}
    reported: set[Signature] = set()
    for goal in posted:
        if not isinstance(goal, nodes.Literal) or isinstance(goal.namespace, nodes.Variable):
            continue
        wanted = signature(goal)
        if wanted in handled or wanted in reported or wanted[1:] in everywhere:
            continue
        reported.add(wanted)
        help = _meant_goal(goal, with_plan & handled) if len(reported) <= MOST_ASKED else None
        yield problem("unknown-goal", f"no plan for `{_goal_text(wanted)}`", goal.span, help)


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


def signature(literal: nodes.Node) -> Signature:
    """Return the signature of a literal, with ``~`` if it is negated; no name for other nodes."""
    if not isinstance(literal, nodes.Literal):
        return None, "", 0
    functor = f"~{literal.functor}" if literal.negated else literal.functor
    return (literal.namespace, functor, len(literal.arguments))


def _goal_text(signature: Signature) -> str:
    namespace, functor, arity = signature
    written = "" if namespace is None else f"{str(namespace).partition('#')[0]}::"
    return f"!{written}{functor}/{arity}"


def _meant_goal(goal: nodes.Literal, handled: Iterable[Signature]) -> str:
    """Return the goal with a plan that is most similar to *goal*: of the same or of a similar name."""
    wanted = signature(goal)
    within = [
        each
        for each in handled
        if _is_reachable(each[0], wanted[0]) and _goal_text(each) != _goal_text(wanted)
    ]
    texts = sorted(_goal_text(signature) for signature in within)
    same_name = [_goal_text(signature) for signature in within if signature[1] == wanted[1]]
    close = sorted(same_name) or close_matches(_goal_text(wanted), texts)
    if not close:
        return _new_plan(goal)
    name, _, arity = close[0].rpartition("/")
    return did_you_mean([name if arity == str(wanted[2]) else close[0]])


def _new_plan(goal: nodes.Literal) -> str:
    """Return the help for a goal without a plan: a plan that does nothing, at the end of the file."""
    name = _goal_text(signature(goal)).rpartition("/")[0]
    help = f"write a plan for it: `+{name}`"
    if goal.span is None:
        return help
    arguments = f"({', '.join('_' for _ in goal.arguments)})" if goal.arguments else ""
    lines = goal.span.file.lines
    end = Span(goal.span.file, len(lines), len(lines[-1]) + 1, len(lines), len(lines[-1]) + 1)
    return fix(help, f"\n+{name}{arguments}.\n", end)


def _is_reachable(namespace: str | nodes.Variable | None, own: str | nodes.Variable | None) -> bool:
    """Return whether a program can write the namespace: names of local ones have a '#', which cannot be written."""
    return not isinstance(namespace, str) or "#" not in namespace or namespace == own
