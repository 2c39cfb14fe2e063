"""Control statements written as the internal actions that they are in Jason: ``.foreach(F, { steps })`` and the like."""

from typing import Final

from jacaros.asl import nodes

CONTROL: Final = frozenset({".if_then_else", ".foreach", ".loop", ".fork", ".join"})
"""The internal actions of Jason that are statements here, and what waits for their branches."""


def control_statement(action: nodes.InternalAction) -> nodes.Step | None:
    """The statement that an internal action means; None when it is none of these.

    ``.if_then_else(F, {..}[, {..}])``, ``.foreach(F, {..})``, ``.loop(F, {..})``, ``.fork(and, {..}, {..})``.
    """
    first, *rest = action.arguments or (None,)
    bodies = [term.body for term in rest if isinstance(term, nodes.BodyTerm)]
    if first is None or not bodies or len(bodies) != len(rest):
        return None
    span = action.span
    match action.name, bodies:
        case ".if_then_else", [then]:
            return nodes.If(first, then, span=span)
        case ".if_then_else", [then, otherwise]:
            return nodes.If(first, then, otherwise, span=span)
        case ".foreach", [body]:
            return nodes.For(first, body, span=span)
        case ".loop", [body]:
            return nodes.While(first, body, span=span)
        case ".fork", [_, _, *_] if isinstance(first, nodes.Literal) and first.functor in ("and", "or"):
            return nodes.Fork(first.functor, tuple(bodies), span=span)
    return None
