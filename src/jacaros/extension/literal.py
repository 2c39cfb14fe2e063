"""Beliefs and goals as Python code sees them."""

from dataclasses import dataclass

from jacaros.asl.loader import parse_literal
from jacaros.asl.lowering import fresh_names, lower
from jacaros.body.values import UNKEPT, Outputs, symbol_name, to_term, to_value
from jacaros.env.values import Atom, Structure
from jacaros.terms.order import annotation_set
from jacaros.terms.substitution import resolve
from jacaros.terms.text import text
from jacaros.terms.values import Annotated, Term, annotations_of, arguments_of, functor, functor_of


@dataclass(frozen=True, slots=True)
class Literal:
    """A literal such as ``~ns::position(3, kitchen)[source(bob)]``.

    Attributes:
        functor: the name.
        arguments: Python values, see the table in ``docs/reference/python_extension.md``.
        annotations: Python values; structures such as ``source(bob)`` are `Structure` objects.
        negated: whether it begins with ``~``.
        namespace: its namespace; None for the default one.
    """

    __record__ = False

    functor: str
    arguments: tuple[object, ...] = ()
    annotations: tuple[object, ...] = ()
    negated: bool = False
    namespace: str | None = None

    @classmethod
    def parse(cls, written: str) -> "Literal":
        """Parse a literal; its variables become unset `Out` objects.

        Raises:
            AslError: the text is not a literal.
        """
        return literal_of(resolve(lower(parse_literal(written), fresh_names())))

    @property
    def arity(self) -> int:
        """The number of arguments."""
        return len(self.arguments)

    @property
    def sources(self) -> tuple[str, ...]:
        """Its sources: ``self``, ``percept`` and names of agents."""
        return tuple(
            str(annotation.arguments[0])
            for annotation in self.annotations
            if isinstance(annotation, Structure) and annotation.functor == "source" and annotation.arguments
        )

    def __str__(self) -> str:
        return text(term_of(self))


def literal_of(term: Term, outputs: Outputs | None = None) -> Literal:
    """Convert a term to a literal for Python code; *outputs* collects its unbound variables.

    Raises:
        ValueError: the term is not a literal.
    """
    symbol = functor_of(term)
    if symbol is None:
        raise ValueError(f"not a literal: {text(term)}")
    plain = functor(symbol.name, 0)
    return Literal(
        symbol_name(plain),
        tuple(to_value(resolve(argument), outputs) for argument in arguments_of(term)),
        tuple(to_value(resolve(annotation), outputs) for annotation in annotations_of(term)),
        symbol.negated,
        symbol.namespace,
    )


def term_of(value: object) -> Term:
    """Convert a Python value to a term; a `Literal` keeps its annotations."""
    if not isinstance(value, Literal):
        return to_term(value, UNKEPT)
    name = f"~{value.functor}" if value.negated else value.functor
    if value.namespace is not None:
        name = f"{value.namespace}::{name}"
    plain = term_of(Structure(name, value.arguments) if value.arguments else Atom(name))
    if not value.annotations:
        return plain
    return Annotated(plain, annotation_set(tuple(map(term_of, value.annotations))))


def literal_term(value: object) -> Term:
    """Convert a literal from Python code to a term: a `Literal`, `Structure`, `Atom`, or a text.

    Raises:
        AslError: the text is not a literal.
        ValueError: the value has another type.
    """
    if isinstance(value, (Literal, Structure, Atom)):
        return term_of(value)
    if isinstance(value, str):
        return resolve(lower(parse_literal(value), fresh_names()))
    raise ValueError(f"not a literal: {value!r}; give a text such as 'position(3, kitchen)', or a Literal")
