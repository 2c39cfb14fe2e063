"""Internal actions that draw by chance, with the agent's own generator: a run with a seed repeats itself."""

from collections.abc import Iterator
from itertools import count

from jacaros.bdi.actions.arguments import elements, whole
from jacaros.bdi.actions.internal_action import WrongArguments, internal_action
from jacaros.bdi.rules.context import Context
from jacaros.terms.text import text
from jacaros.terms.values import Term, Var, is_list


@internal_action(".random", arity=(1, 3), backtracks=True)
def random(ctx: Context, first: Term, second: Term = 1.0, third: Term = 1.0) -> Iterator[None]:
    """``.random(X[, N])``: *X* is a number from 0 (inclusive) to 1 (exclusive).

    ``.random(L, X[, N])``: *X* is an element of the list *L*; fails for an empty list.

    There are *N* answers (default 1), endlessly many when it is 0.

    Raises:
        WrongArguments: *X* has a value already, *N* is no number.
    """
    generator = ctx.architecture.random
    choices = elements(first, "the list of .random") if is_list(first) else None
    result, amount = (first, second) if choices is None else (second, third)
    if result.__class__ is not Var:
        raise WrongArguments(
            f".random needs a list or a variable, and a variable behind a list, not {text(result)}"
        )
    draws = 1 if amount == 1.0 else whole(amount, "the number of answers of .random")
    if choices == []:
        return
    for _ in range(draws) if draws else count():
        if ctx.unify(result, generator.random() if choices is None else generator.choice(choices)):
            yield


@internal_action(".set_random_seed", arity=1)
def set_random_seed(ctx: Context, seed: Term) -> None:
    """``.set_random_seed(N)``: the agent's draws from now on follow from *N*.

    Raises:
        WrongArguments: *N* is no number.
    """
    ctx.architecture.random.seed(whole(seed, "the argument of .set_random_seed"))
