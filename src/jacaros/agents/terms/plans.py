"""Plans, bodies, triggers and rules as terms, so that programs can pass them around and unify them.

>>> from jacaros.agents.terms.text import text
>>> body = make_body([step("!", atom("lift")), step("", atom("beep"))])
>>> text(body)
'!lift; beep'
>>> [step_parts(each)[0] for each in body_steps(body)]
['!', '']

================  ===============================================================
plan              ``(PLAN, label, trigger, context, body)``
trigger           ``(TRIGGER, operator atom, literal)``
rule              ``(RULE, head, body)``
body              ``(BODY_SEQUENCE, step, rest)`` ending in `BODY_END`, with `BODY_TERM` when in braces
step              ``(functor(operator, n, kind=PLAN), operand, ...)``
================  ===============================================================

Step operators are those of the source (``!``, ``!!``, ``?``, ``+`` …), the empty string for an action or a
formula, and ``if``, ``while``, ``for``, ``|&|``, ``|||``.

A body or trigger that belongs to a plan differs from one in braces only in how it is printed (see `TWINS`).
"""

from collections.abc import Iterable, Iterator

from jacaros.agents.terms.values import PLAN as KIND
from jacaros.agents.terms.values import Functor, Term, atom, deref, functor

PLAN = functor("plan", 4, kind=KIND)
TRIGGER = functor("trigger", 2, kind=KIND)
RULE = functor("rule", 2, kind=KIND)
PLAN_TRIGGER = functor("plan_trigger", 2, kind=KIND)
"""A trigger that was taken out of its plan."""
BODY_SEQUENCE = functor(";", 2, kind=KIND)
"""A body that belongs to a plan or to a control statement."""
BODY_TERM = functor("{;}", 2, kind=KIND)
"""A body in braces."""
BODIES = frozenset({BODY_SEQUENCE, BODY_TERM})
TRIGGERS = frozenset({TRIGGER, PLAN_TRIGGER})
TWINS = {
    BODY_SEQUENCE: BODY_TERM,
    BODY_TERM: BODY_SEQUENCE,
    TRIGGER: PLAN_TRIGGER,
    PLAN_TRIGGER: TRIGGER,
}
"""Functors that unify although they are printed in different ways."""
BODY_END = functor("", 0, kind=KIND)
NO_LABEL = atom("nolabel")


def make_body(steps: Iterable[Term], rest: Term = BODY_END, symbol: Functor = BODY_SEQUENCE) -> Term:
    """Return the body of these step terms, followed by *rest*; *symbol* is `BODY_TERM` for one in braces."""
    body: Term = rest
    for step in reversed(list(steps)):
        body = (symbol, step, body)
    return body


def step(operator: str, *operands: Term) -> Term:
    """The term of one body step."""
    return (functor(operator, len(operands), kind=KIND), *operands)


def trigger(operator: str, literal: Term) -> Term:
    """The term of a trigger; *operator* is ``+``, ``-!``, ``+?`` …"""
    return (TRIGGER, atom(operator), literal)


def body_steps(body: Term) -> Iterator[Term]:
    """Yield the steps of a body term; a variable or other term at the end counts as a step."""
    body = deref(body)
    while body.__class__ is tuple and body[0] in BODIES:
        yield deref(body[1])
        body = deref(body[2])
    if body is not BODY_END:
        yield body


_NO_STEPS = TRIGGERS | {PLAN, RULE}


def step_parts(step_term: Term) -> tuple[str, tuple[Term, ...]]:
    """Return operator and operands of a step; any other term is an action."""
    if step_term.__class__ is tuple:
        symbol = step_term[0]
        if symbol.kind == KIND and symbol not in _NO_STEPS:
            return symbol.name, step_term[1:]
    return "", (step_term,)


def trigger_parts(term: Term) -> tuple[str, Term]:
    """Return operator text and literal of a trigger term."""
    return deref(term[1]).name, deref(term[2])


def plan_text_parts(term: Term) -> tuple[Term, str, Term, Term, Term]:
    """Return label, trigger operator, trigger literal, context and body of a plan term."""
    operator, literal = trigger_parts(deref(term[2]))
    return term[1], operator, literal, deref(term[3]), deref(term[4])


def is_body(term: Term) -> bool:
    """Return whether a term is a plan body."""
    return term is BODY_END or (term.__class__ is tuple and term[0] in BODIES)
