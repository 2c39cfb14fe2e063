"""Checks of arguments, shared by the internal actions."""

from jacaros.bdi.actions.internal_action import WrongArguments
from jacaros.terms.collections import QueueValue, SetValue
from jacaros.terms.operators import to_int
from jacaros.terms.text import text
from jacaros.terms.values import String, Term, is_list, list_items


def number(term: Term, what: str) -> float:
    """The value of a number.

    Raises:
        WrongArguments: when the term is none, or an expression of unbound variables; the message begins with
            *what*, such as ``the first argument``.
    """
    if term.__class__ is float:
        return float(term)
    raise WrongArguments(f"{what} must be a number, not {text(term)}")


def whole(term: Term, what: str) -> int:
    """A number without its fraction, cut to 32 bits as in Jason.

    Raises:
        WrongArguments: when the term is no number.
    """
    return to_int(number(term, what))


def string(term: Term, what: str) -> str:
    """The characters of a string.

    Raises:
        WrongArguments: when the term is none.
    """
    if term.__class__ is String:
        return str(term)
    raise WrongArguments(f"{what} must be a string, not {text(term)}")


def elements(term: Term, what: str) -> list[Term]:
    """The elements of a list; an open end is passed over.

    Raises:
        WrongArguments: when the term is no list.
    """
    if is_list(term):
        return list(list_items(term))
    raise WrongArguments(f"{what} must be a list, not {text(term)}")


def members(term: Term, what: str) -> list[Term]:
    """The elements of a list, set or queue.

    Raises:
        WrongArguments: when the term is none of them.
    """
    if isinstance(term, (SetValue, QueueValue)):
        return list(term)
    if is_list(term):
        return list(list_items(term))
    raise WrongArguments(f"{what} must be a list, a set or a queue, not {text(term)}")


def characters(term: Term) -> str:
    """A string bare, any other term as it is written."""
    return str(term) if term.__class__ is String else text(term)
