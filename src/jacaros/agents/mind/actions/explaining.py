"""The internal action ``.why``: an agent's question about its own run, answered as terms."""

import re
from collections.abc import Mapping
from typing import Any

from jacaros.agents.mind.actions.internal_action import ActionError, internal_action
from jacaros.agents.mind.rules.context import Context
from jacaros.agents.terms.text import text
from jacaros.agents.terms.values import (
    Functor,
    String,
    Term,
    arguments_of,
    atom,
    functor_of,
    make_list,
    structure,
)
from jacaros.errors import UsageError

NEVER = atom("never")
"""The time of something that never happened or has no time."""


@internal_action(".why", arity=2)
def why(ctx: Context, question: Term, answer: Term) -> bool:
    """``.why(Q, A)``: A is ``explanation(Text, Time, Facts, Causes)``.

    Raises:
        ActionError: the question is invalid.
    """
    try:
        found = ctx.agent.architecture.explain(written_question(question))
    except UsageError as refused:
        raise ActionError(str(refused).partition("\n")[0].removeprefix("error: ")) from None
    return ctx.unify(answer, _explanation(found))


def written_question(question: Term) -> str:
    """Return the question that a term asks, such as ``stopped``, ``"+alarm(_)"``, ``{ +alarm(_) }`` or ``plan(low)``."""
    if question.__class__ is String:
        return str(question)
    kind, arguments = functor_of(question), arguments_of(question)
    if kind is not None and len(arguments) == 1 and kind.name in ("belief", "plan", "command", "operation"):
        about = arguments[0]
        named = str(about) if about.__class__ is String else _text(about)
        return f"{kind.name} {'@' if kind.name == 'plan' and about.__class__ is Functor else ''}{named}"
    return _text(question).strip("{} ")


def _text(term: Term) -> str:
    """Return a term as text, without the numbers of its unnamed variables."""
    return re.sub(r"\b_\d+\b", "_", text(term))


def _explanation(found: Mapping[str, Any]) -> Term:
    facts, causes = (make_list(list(map(_fact, found[name]))) for name in ("facts", "because"))
    return structure("explanation", String(found["answer"]), _time(found["t"]), facts, causes)


def _fact(fact: Mapping[str, Any]) -> Term:
    place = structure("place", String(fact["file"]), float(fact["line"]))
    told = atom(fact["kind"]), _time(fact["t"]), String(fact["agent"]), String(fact["text"])
    return structure("fact", *told, place)


def _time(t: float | None) -> Term:
    return NEVER if t is None else float(t)
