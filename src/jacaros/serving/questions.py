"""Questions to a mind that change nothing, whatever they call, and take little time."""

from collections.abc import Callable, Mapping, Sequence
from itertools import islice
from typing import TypeVar

from jacaros.agents.language.diagnostics import AslError
from jacaros.agents.language.offers import Offer
from jacaros.agents.mind.actions.internal_action import ActionError
from jacaros.agents.mind.mind import Mind
from jacaros.agents.mind.rules.context import Impure, ReadOnly, reading
from jacaros.agents.mind.state.budget import SearchLimit
from jacaros.agents.mind.state.plan import Failure
from jacaros.agents.terms.substitution import resolve
from jacaros.agents.terms.text import excerpt, text
from jacaros.agents.terms.unifier import unify
from jacaros.agents.terms.values import Term, Var
from jacaros.runtime.mas.embedding.running_agent import question
from jacaros.runtime.time_limit import within
from jacaros.serving.arguments import Data, data_of, literal_of
from jacaros.serving.callers import LONGEST, RequestError, check_text

T = TypeVar("T")
NO_VALUES: Mapping[str, Term] = {}
SHOWN, MOST = 20, 1_000
"""Maximum number of answers as text, and as data."""
STEPS, SECONDS = 10_000, 0.1
"""Limits of a question: steps (see `jacaros.agents.mind.rules.context.reading`), and seconds."""


def answers_of(
    mind: Mind, offer: Offer, arguments: Sequence[Term], asked: Mapping[str, Term]
) -> list[dict[str, Data]]:
    """Return the values that are asked for in each answer of an offered question, or in each offered belief.

    Args:
        mind: the agent.
        offer: what it offers.
        arguments: its arguments, with variables.
        asked: the variables by name; those that begin with ``_`` are left out.

    Raises:
        RequestError: it cannot be answered.
    """
    shown = {name: value for name, value in asked.items() if name[0] != "_"}
    formula = literal_of(offer, arguments)

    def answer(view: ReadOnly) -> list[dict[str, Data]]:
        return [
            {name: data_of(value) for name, value in shown.items()}
            for _ in islice(view.answers(formula), MOST)
        ]

    return _asked(mind, answer)


def ask(mind: Mind, formula: str, values: Mapping[str, Term] = NO_VALUES) -> str:
    """Return the answers of a formula, one per line: ``X = 3, Y = kitchen``; ``yes`` or ``no`` without variables.

    Args:
        mind: the agent.
        formula: the formula.
        values: variables that have a value.

    Raises:
        RequestError: it cannot be answered.
    """
    try:
        term, names = question(check_text(formula))
    except AslError as error:
        raise RequestError("invalid_arguments", first_line(error)) from None
    shown = {name: value for name, value in names.items() if name[0] != "_" and name not in values}

    def answer(view: ReadOnly) -> str:
        for name in names.keys() & values.keys():
            unify(names[name], values[name], view.trail)
        lines = [_values(shown) or "yes" for _ in islice(view.answers(term), SHOWN + 1)]
        if not shown:
            lines = lines[:1]
        return "\n".join([*lines[:SHOWN], *(["..."] if len(lines) > SHOWN else [])]) or "no"

    return _asked(mind, answer)


def _asked(mind: Mind, answer: Callable[[ReadOnly], T]) -> T:
    if mind.running:
        raise RequestError("unanswerable", "the agent is in the middle of a step: ask again")
    try:
        with reading(mind, STEPS) as view:
            found = within(SECONDS, lambda: answer(view))
    except (Impure, SearchLimit, ActionError, Failure, RecursionError) as error:
        raise RequestError("unanswerable", str(error)) from None
    if found is None:
        raise RequestError("unanswerable", f"the question takes longer than {SECONDS} s; ask a simpler one")
    return found


def first_line(error: AslError) -> str:
    """Return the first of the messages of an error."""
    return error.diagnostics[0].message if error.diagnostics else str(error)


def _values(shown: Mapping[str, Term]) -> str:
    """Return the bound variables: ``X = 3, Y = kitchen``."""
    found = ((name, resolve(excerpt(value, LONGEST))) for name, value in shown.items())
    return ", ".join(f"{name} = {text(value)}" for name, value in found if value.__class__ is not Var)
