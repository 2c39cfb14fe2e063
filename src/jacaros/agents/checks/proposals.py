"""Check plans that a stranger proposes, such as a language model, before an agent adds them.

What is not permitted is an error: other operations and goals, internal actions that use files, send messages, or change
plans, goals or agents, and goals that outlive the one they serve.

>>> permitted = Permitted(goals=["tour/0", "go/1"], operations=["dock/0"])
>>> check_plans("+!tour <- !go(lab); dock.", permitted)
['+!tour <- !go(lab); dock.']
>>> check_plans("+!tour <- .create_agent(eve).", permitted)
Traceback (most recent call last):
    ...
jacaros.agents.language.diagnostics.AslError: plans:1:11: error: internal action `.create_agent` is not permitted...
"""

from collections.abc import Collection, Iterator, Sequence
from dataclasses import dataclass
from typing import Final

from jacaros.agents.language import nodes
from jacaros.agents.language.diagnostics import AslError, Diagnostic, Span
from jacaros.agents.language.loader import load_program
from jacaros.runtime.files.texts import suggestion

LONGEST = 4_000
"""Maximum number of characters of a proposal."""
MOST_NODES = 1_000
"""Maximum size of a proposal, in nodes of its syntax tree."""
_NAMES = """
    accept atom belief concat count date desire difference empty fail findall ground intend intersection length list
    literal max member min my_name nth number print progress random refuse reverse setof sort string structure sublist
    substring time union wait
"""
HARMLESS: Final = frozenset(f".{name}" for name in _NAMES.split())
"""Internal actions that proposed plans may use: they compute, print, wait, or end the plan."""

_CHOOSING: Final = frozenset({"artifact_id", "aid", "artifact_name", "art", "wid", "wsp"})


@dataclass(frozen=True)
class Permitted:
    """What proposed plans may do.

    Attributes:
        goals: goals that they may handle and post, such as ``go/1``.
        operations: operations that they may use, such as ``dock/0``.
        beliefs: beliefs that they may change, such as ``seen/1``.
        actions: internal actions that they may use.
    """

    goals: Collection[str]
    operations: Collection[str] = ()
    beliefs: Collection[str] = ()
    actions: Collection[str] = HARMLESS


def check_plans(text: str, permitted: Permitted) -> list[str]:
    """Return each plan in a text, for `.add_plan`.

    Args:
        text: plans in AgentSpeak.
        permitted: what they may do.

    Raises:
        AslError: with everything in them that is wrong or not permitted.
    """
    if len(text) > LONGEST:
        raise AslError(
            [Diagnostic("error", f"the plans have {len(text)} characters; the limit is {LONGEST}")]
        )
    program, _ = load_program("plans", text)
    found = list(_problems(program, permitted))
    if found:
        raise AslError(found)
    lines = text.splitlines()
    return [f"{_between(lines, plan.span)}." for plan in program.plans if plan.span is not None]


def _between(lines: Sequence[str], span: Span) -> str:
    first, last = span.line - 1, span.end_line - 1
    if first == last:
        return lines[first][span.column - 1 : span.end_column - 1]
    return "\n".join(
        [lines[first][span.column - 1 :], *lines[first + 1 : last], lines[last][: span.end_column - 1]]
    )


def _problems(program: nodes.Program, permitted: Permitted) -> Iterator[Diagnostic]:
    for part in (*program.beliefs, *program.goals, *program.functions, *program.offers):
        yield _error("only plans can be proposed", part.span)
    if not program.plans:
        yield _error("there is no plan", None)
    for number, node in enumerate(nodes.walk(program.plans)):
        if number == MOST_NODES:
            yield _error("the plans are too large", node.span, f"propose plans of at most {MOST_NODES} nodes")
            return
        yield from _problems_of(node, permitted)


def _problems_of(node: nodes.Node, permitted: Permitted) -> Iterator[Diagnostic]:
    match node:
        case nodes.Plan(label, nodes.Trigger(operator, kind, literal)):
            if label is not None:
                yield _error("labels and annotations of plans are not permitted", label.span, "leave it out")
            if kind != "!" or operator not in "+-":
                yield _error("only plans for goals are permitted", node.trigger.span, "write `+!goal <- …`")
            yield from _unknown("goal", literal, permitted.goals)
        case nodes.Achieve(goal, separate):
            if separate:
                yield _error(
                    "`!!` is not permitted: its goal would outlive this plan", node.span, "write `!`"
                )
            yield from _unknown("goal", goal, permitted.goals)
        case nodes.ExternalAction(action):
            if isinstance(action, nodes.Literal) and _chooses_artifact(action.annotations):
                yield _error("an annotation that chooses an artifact is not permitted", node.span)
            yield from _unknown("operation", action, permitted.operations)
        case nodes.BeliefChange(_, operand):
            yield from _unknown("change of the belief", operand, permitted.beliefs)
        case nodes.InternalAction(name) if name not in permitted.actions:
            yield _error(
                f"internal action `{name}` is not permitted", node.span, _known(name, permitted.actions)
            )
        case nodes.FunctionCall(name) if "." in name and not name.startswith("math."):
            yield _error(f"function `{name}` is not permitted", node.span)
        case nodes.PlanTerm() | nodes.RuleTerm() | nodes.BodyTerm():
            yield _error("plans as values are not permitted", node.span)
        case _:
            pass


def _chooses_artifact(annotations: nodes.Annotations | None) -> bool:
    """Return whether an operation may be that of another artifact than a permitted one."""
    if annotations is None:
        return False
    names = {each.functor for each in annotations.items if isinstance(each, nodes.Literal)}
    return annotations.tail is not None or not names.isdisjoint(_CHOOSING)


def _unknown(what: str, node: nodes.Node, known: Collection[str]) -> Iterator[Diagnostic]:
    if not isinstance(node, nodes.Literal) or node.namespace is not None:
        yield _error(f"{what}: a variable or a namespace is not permitted", node.span, "write its name")
        return
    key = f"{node.functor}/{len(node.arguments)}"
    if node.negated or key not in known:
        yield _error(f"{what} `{'~' * node.negated}{key}` is not permitted", node.span, _known(key, known))


def _known(name: str, known: Collection[str]) -> str:
    return suggestion(name, known, f"permitted: {', '.join(sorted(known)) or 'none'}")


def _error(message: str, span: Span | None, help: str | None = None) -> Diagnostic:
    return Diagnostic("error", message, span, help)
