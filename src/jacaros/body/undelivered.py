"""Actions that reach no artifact, and what CArtAgO's bridge to Jason tells of them.

============================================  ================================================================
what is wrong                                 ``env_failure_reason``
============================================  ================================================================
no artifact offers the operation              ``env_failure(action_failed(fly,op(default,"( fly 3 x )")))``
the annotations direct it to where it         ``env_failure(action_failed(fly,generic_error))``
cannot go
an annotation is none of those that direct    ``action_failed(fly(3)[heigth(2)],unknown_annotation)``
============================================  ================================================================

A plan that wants to know more finds it in another annotation, which is ours: ``env_failure_detail(D)``, where D is
``unknown_operation("fly/2")``, ``workspace_not_joined("attic")``, ``unknown_annotation("heigth(2)")``...
"""

from jacaros.bdi.state.act import Act
from jacaros.body.values import unquoted
from jacaros.env.errors import OperationFailed
from jacaros.env.values import Atom, Structure
from jacaros.terms.text import text
from jacaros.terms.values import Annotated, Functor, String, Term, atom, deref, functor

_ENV_FAILURE = functor("env_failure", 1)
_ACTION_FAILED = functor("action_failed", 2)
_OP = functor("op", 2)
_GENERIC_ERROR, _UNKNOWN_ANNOTATION = atom("generic_error"), atom("unknown_annotation")


class Undelivered(OperationFailed):
    """An action that reached no artifact.

    Attributes:
        term: what ``env_failure_reason`` holds.
        reason: what ``env_failure_detail`` holds.
    """

    def __init__(self, message: str, term: Term, reason: Structure | Atom | None) -> None:
        super().__init__(message, reason)
        self.term = term


def nobody_offers(act: Act, message: str) -> Undelivered:
    """No artifact that could be meant has the operation."""
    symbol = act.functor
    name = unquoted(symbol.name)
    namespace = atom(symbol.namespace or "default")
    words = " ".join(("(", name, *map(_words, act.arguments), ")"))
    reason = Structure("unknown_operation", (f"{name}/{symbol.arity}",))
    return Undelivered(message, _action_failed(symbol, (_OP, namespace, String(words))), reason)


def _words(term: Term) -> str:
    term = deref(term)
    return str(term) if term.__class__ is String else text(term)


def unreachable(act: Act, failure: OperationFailed) -> Undelivered:
    """An annotation directs the action to where the agent cannot act."""
    return Undelivered(failure.message, _action_failed(act.functor, _GENERIC_ERROR), failure.reason)


def unknown_annotation(act: Act, annotation: Term, message: str) -> Undelivered:
    """An annotation says nothing to the environment."""
    symbol = act.functor
    action = Annotated((symbol, *act.arguments) if act.arguments else symbol, act.annotations)
    reason = Structure("unknown_annotation", (text(annotation),))
    return Undelivered(message, (_ACTION_FAILED, action, _UNKNOWN_ANNOTATION), reason)


def _action_failed(symbol: Functor, why: Term) -> Term:
    return (_ENV_FAILURE, (_ACTION_FAILED, atom(symbol.name), why))
