"""Internal actions for output, and for explanations."""

import re
from collections.abc import Mapping
from dataclasses import replace
from typing import Any

from jacaros.agents.mind.actions.internal_action import (
    ActionError,
    WrongArguments,
    characters,
    internal_action,
    string,
    whole,
)
from jacaros.agents.mind.rules.context import Context
from jacaros.agents.mind.state.intention import PLAN
from jacaros.agents.terms.substitution import resolve
from jacaros.agents.terms.text import display, text
from jacaros.agents.terms.values import (
    FALSE,
    NUMBERS,
    TRUE,
    Functor,
    String,
    Term,
    Var,
    arguments_of,
    atom,
    functor_of,
    make_list,
    structure,
)
from jacaros.errors import JacarosError, UsageError

_LEVELS = {"severe": "error", "warning": "warning", "fine": "debug", "finer": "debug", "finest": "debug"}
_EXPRESSION = re.compile(r"#\{([^{}]+)\}")


@internal_action(".print", prints=True)
@internal_action(".println", prints=True)
def print_(ctx: Context, *arguments: Term) -> None:
    """``.print(A, ...)`` and ``.println(A, ...)`` print their arguments joined without separators.

    Strings are printed without quotes, strings inside other terms with quotes, unbound variables as ``X<no-value>``.
    Line breaks in strings are kept.
    """
    ctx.architecture.print("".join(map(display, arguments)))


@internal_action(".printf", arity=(1, None), prints=True)
def printf(ctx: Context, template: Term, *arguments: Term) -> None:
    """``.printf(Format, A, ...)`` prints a text made with a Java format such as ``%8.2f``.

    Numbers are doubles: use ``%.0f`` instead of ``%d``. See `java_format` for the supported conversions.

    Raises:
        ActionError: the format is invalid or does not fit the arguments.
    """
    from jacaros.agents.mind.actions.java_format import (
        java_format,  # imported here: few programs use it, and it needs decimal
    )

    pattern = string(template, "the first argument of .printf")
    try:
        shown = java_format(pattern, [_value(argument) for argument in arguments])
    except ValueError as error:
        raise ActionError(f".printf: {error}") from None
    ctx.architecture.print(shown)


def _value(term: Term) -> float | str | bool:
    if term is TRUE or term is FALSE:
        return term is TRUE
    return term if term.__class__ in NUMBERS else display(term)


@internal_action(".puts", arity=(1, 2), prints=True, by_name=True)
def puts(ctx: Context, template: Term, result: Term = None) -> bool:
    """``.puts(Text[, Result])`` prints a text in which every ``#{expression}`` is replaced by its value.

    Expressions that do not parse as terms are left as they are. With an unbound *result*, nothing is printed: the text
    becomes its value. If *result* is a string, it is appended to the text.
    """
    filled = _fill(ctx, string(template, "the first argument of .puts"))
    if result.__class__ is Var:
        return ctx.unify(String(filled), result)
    if result.__class__ is String:
        filled += _fill(ctx, result)
    ctx.architecture.print(filled)
    return True


def _fill(ctx: Context, template: str) -> str:
    def value(match: re.Match[str]) -> str:
        try:
            return characters(resolve(ctx.parse_term(match.group(1))))
        except JacarosError:
            return match.group()

    return _EXPRESSION.sub(value, template)


@internal_action(".log", arity=(1, None), prints=True)
def log(ctx: Context, level: Term, *arguments: Term) -> None:
    """``.log(Level, A, ...)`` logs a message, separate from the program's output.

    *level* is ``severe``, ``warning``, ``info``, ``fine``, ``finer``, ``finest``; other atoms mean ``info``.
    """
    if not isinstance(level, Functor):
        raise WrongArguments(f"the first argument of .log must be a level such as info, not {text(level)}")
    ctx.architecture.log(_LEVELS.get(level.name, "info"), "".join(map(display, arguments)))


@internal_action(".verbose", arity=1)
def verbose(ctx: Context, level: Term) -> None:
    """``.verbose(N)`` sets how much is logged about the agent from now on: 0 only problems, 1 the default, 2 details as
    well.
    """
    wanted = whole(level, "the argument of .verbose")
    if not 0 <= wanted <= 2:
        raise WrongArguments(f"the argument of .verbose must be 0, 1 or 2, not {text(level)}")
    ctx.agent.options = replace(ctx.agent.options, verbose=wanted)


@internal_action(".print_unifier", arity=0, by_name=True)
def print_unifier(ctx: Context) -> None:
    """``.print_unifier`` prints the bound variables of the plan, one per line, and ``done``."""
    if ctx.intention is not None:
        frame = ctx.intention.frames[-1]
        for name, slot in frame[PLAN].slots.items():
            value = resolve(frame[slot])
            if value is not None and value.__class__ is not Var:
                ctx.architecture.print(f"{name}={text(value)}")
    ctx.architecture.print("done")


# The internal action ``.why``: an agent's question about its own run, answered as terms.


NEVER = atom("never")
"""The time of something that never happened or has no time."""


@internal_action(".why", arity=2)
def why(ctx: Context, question: Term, answer: Term) -> bool:
    """``.why(Q, A)``: A is ``explanation(Text, Time, Facts, Causes)``.

    Raises:
        ActionError: the question is invalid.
    """
    try:
        found = ctx.architecture.system.explain(written_question(question), ctx.agent.name)
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
